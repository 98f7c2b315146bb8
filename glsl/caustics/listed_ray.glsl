// The list of rays as shaders read it that draw one kind of them.
#ifndef LIMN_LISTED_RAY_GLSL
#define LIMN_LISTED_RAY_GLSL
#include "glsl/caustics/ray_runs.glsl"

layout(std430) readonly buffer RayIndices { uint ray_indices[]; };
layout(std430) readonly buffer RayDraws {
  RayDraw draws[ray_kinds];
  uint first_places[ray_kinds];
};

// Index of the n-th ray of a kind in the caustic-ray buffer.
int listed_ray(uint kind, int n) { return int(ray_indices[first_places[kind] + uint(n)]); }

#endif  // LIMN_LISTED_RAY_GLSL
