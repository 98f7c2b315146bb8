// What the passes of implicit visibility share: leaves, their links, the space of the bins, and the radiance that elements
// send: GLOSSY 0: the same in all directions; else: into the 6 x GLOSSY x GLOSSY bins of directions.
#ifndef LIMN_IMPLICIT_VISIBILITY_ELEMENTS_GLSL
#define LIMN_IMPLICIT_VISIBILITY_ELEMENTS_GLSL
#include "glsl/numeric/work_items.glsl"
#include "glsl/surface/brdf.glsl"
#include "glsl/indirect/direction_bins.glsl"
#include "glsl/indirect/surface_leaf.glsl"

const uint bin_count = 6u * BINS * BINS;

#if GLOSSY
const uint sent_count = 6u * uint(GLOSSY) * uint(GLOSSY);
#else
const uint sent_count = 1u;
#endif

// Rows of the rotation from world space to that of the bins.
uniform vec4 bins_x;
uniform vec4 bins_y;
uniform vec4 bins_z;

vec3 to_bins(vec3 world) { return vec3(dot(bins_x.xyz, world), dot(bins_y.xyz, world), dot(bins_z.xyz, world)); }
vec3 from_bins(vec3 d) { return d.x * bins_x.xyz + d.y * bins_y.xyz + d.z * bins_z.xyz; }

// Where the radiance is that an element sends towards a direction (in the space of the bins).
uint sent_index(uint element, vec3 direction) {
#if GLOSSY
  return element * sent_count + bin_of(direction, uint(GLOSSY));
#else
  return element;
#endif
}

// Unit, in the space of the bins: the middle of an element's sent-th bin of directions.
vec3 sent_direction(uint sent) {
#if GLOSSY
  return normalize(bin_direction(sent, uint(GLOSSY)));
#else
  return vec3(0.0);
#endif
}

// Lobes are no narrower than the coarser of the bins that light comes from and is sent into.
SurfaceBrdf binned_brdf(SurfaceBrdf s) {
#if GLOSSY
  s.alpha = binned_alpha(s.alpha, min(BINS, uint(GLOSSY)));
#endif
  return s;
}

#endif
