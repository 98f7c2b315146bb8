// What the passes of implicit visibility share: leaves, their links, and the space of the bins.
#ifndef LIMN_IMPLICIT_VISIBILITY_ELEMENTS_GLSL
#define LIMN_IMPLICIT_VISIBILITY_ELEMENTS_GLSL
#include "glsl/direction_bins.glsl"

// limn::radiosity::Leaf, metres.
struct Leaf {
  vec4 vertex;  // w: 0 where the slot is not in use
  vec4 position;
  vec4 normal;
  vec4 albedo;
};

const uint bin_count = 6u * BINS * BINS;

// Rows of the rotation from world space to that of the bins.
uniform vec4 bins_x;
uniform vec4 bins_y;
uniform vec4 bins_z;

vec3 to_bins(vec3 world) { return vec3(dot(bins_x.xyz, world), dot(bins_y.xyz, world), dot(bins_z.xyz, world)); }

#endif
