// What texels of a height map see of lights and of each other: tables of relief_maps::ReliefMapService.
#ifndef BUMP_TEXELS_GLSL
#define BUMP_TEXELS_GLSL
#include "glsl/relief/bounce_paths.glsl"
#include "glsl/relief/relief_maps.glsl"

layout(std430) readonly buffer BounceFields { ReliefField bounce_fields[]; };
layout(std430) readonly buffer BounceWords { uint bounce_words[]; };
uniform int paths;

struct BumpTexels {
  uint ellipses;  // first word
  uint bounces;   // first word
  uint count;     // of texels
};

BumpTexels bump_texels(int height) {
  ReliefField field = relief_fields[height];
  BumpTexels t;
  t.ellipses = field.first;
  t.bounces = bounce_fields[height].first;
  t.count = uint(field.size.x * field.size.y);
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

ReliefEllipse bump_ellipse(BumpTexels t, uint texel) { return relief_stored_ellipse(t.ellipses, int(texel)); }

// Irradiance on a texel over that across the light's direction l, a unit vector of the field's frame.
float bump_irradiance(vec3 normal, ReliefEllipse ellipse, vec3 l) {
  float cosine = dot(normal, l);
  return cosine > 0.0 && ellipse_lit(ellipse, l) ? cosine : 0.0;
}

#endif  // BUMP_TEXELS_GLSL
