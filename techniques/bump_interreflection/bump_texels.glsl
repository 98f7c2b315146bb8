// What texels of a height map see of lights and of each other: tables of relief_maps::ReliefMapService.
// RELIEF_AZIMUTHS: lights are looked up in horizon maps with as many; undefined: in moment ellipses.
#ifndef BUMP_TEXELS_GLSL
#define BUMP_TEXELS_GLSL
#include "glsl/relief/bounce_paths.glsl"
#include "glsl/relief/relief_maps.glsl"

layout(std430) readonly buffer BounceFields { ReliefField bounce_fields[]; };
layout(std430) readonly buffer BounceWords { uint bounce_words[]; };
uniform int paths;

struct BumpTexels {
  ReliefField field;
  uint bounces;  // first word
  uint count;    // of texels
};

BumpTexels bump_texels(int height) {
  BumpTexels t;
  t.field = relief_fields[height];
  t.bounces = bounce_fields[height].first;
  t.count = uint(t.field.size.x * t.field.size.y);
  return t;
}

uint bounce_word(BumpTexels t, int plane, uint texel) { return bounce_words[t.bounces + uint(plane) * t.count + texel]; }

// Path i to a texel. The weights of all its paths have the mean 1.
BouncePath bounce_path(BumpTexels t, uint texel, int i) {
  BouncePath path = bounce_path_unpack(bounce_word(t, bounce_path_plane + i, texel));
  path.weight *= uintBitsToFloat(bounce_word(t, bounce_scale_plane, texel));
  return path;
}

vec3 bump_normal(BumpTexels t, uint texel) {
  return normalize(vec3(-unpackHalf2x16(bounce_word(t, bounce_slope_plane, texel)), 1.0));
}

#ifdef RELIEF_AZIMUTHS
#define BumpLight HorizonPlace  // what a light's direction is looked up by
BumpLight bump_light(vec3 l) { return horizon_place(l, RELIEF_AZIMUTHS); }

bool bump_lit(BumpTexels t, uint texel, vec3 l, BumpLight light) {
  float first = relief_stored_tangent(t.field, int(texel), light.first);
  float second = relief_stored_tangent(t.field, int(texel), light.second);
  return horizon_lit(l, first + light.weight * (second - first));
}
#else
#define BumpLight bool
BumpLight bump_light(vec3 l) { return true; }

bool bump_lit(BumpTexels t, uint texel, vec3 l, BumpLight light) {
  return ellipse_lit(relief_stored_ellipse(t.field.first, int(texel)), l);
}
#endif

// Irradiance on a texel over that across a light's direction l, a unit vector of the field's frame.
float bump_irradiance(BumpTexels t, uint texel, vec3 normal, vec3 l, BumpLight light) {
  float cosine = dot(normal, l);
  return cosine > 0.0 && bump_lit(t, texel, l, light) ? cosine : 0.0;
}

#endif  // BUMP_TEXELS_GLSL
