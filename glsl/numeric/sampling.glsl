// Sample points in the unit square and cube.
#ifndef LIMN_SAMPLING_GLSL
#define LIMN_SAMPLING_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Additive recurrences on the generalised golden ratio (Roberts 2018, The Unreasonable Effectiveness of Quasirandom
// Sequences), in fixed point so that they stay exact for all i: multiples of 2^32 / g^k.
LIMN_CONST uvec2 r2_step = uvec2(3242174889u, 2447445414u);
LIMN_FN vec2 r2_sequence(uint i) {
  return vec2(float((i * r2_step.x) >> 8), float((i * r2_step.y) >> 8)) * 5.9604644775390625e-8f;
}
LIMN_FN vec3 r3_sequence(uint i) {
  return vec3(float((i * 3518319155u) >> 8), float((i * 2882110345u) >> 8), float((i * 2360945575u) >> 8)) *
         5.9604644775390625e-8f;
}

// Points of these one after the other, for loops that add steps: numbers in fixed point, of which 2^32 stand for 1.
LIMN_CONST uint r3_step_z = 2360945575u;
LIMN_FN uint fixed_point(float x) { return uint(x * 16777216.0f) << 8u; }
LIMN_FN float fixed_point_value(uint x) { return float(int(x >> 8u)) * 5.9604644775390625e-8f; }

// Point i of a set of `count` that follow each other in the R2 sequence, moved so that the set lies alike on all sides of the
// square's middle, which a single point is. The mean of the first points of the sequence lies aside of it, of 16 by 0.1: what they
// stand for, as a light, would seem to lie there.
LIMN_FN vec2 r2_point(uint i, uint count) {
  // Half of the square less (count - 1) / 2 steps.
  uvec2 first = uvec2(0x80000000u) - (count >> 1u) * r2_step;
  if ((count & 1u) == 0u) first += r2_step >> 1u;
  uvec2 at = first + i * r2_step;
  return vec2(fixed_point_value(at.x), fixed_point_value(at.y));
}

// Centres of the cells of a regular grid of side x side.
LIMN_FN vec2 grid_point(int i, int side) {
  return vec2((float(i % side) + 0.5f) / float(side), (float(i / side) + 0.5f) / float(side));
}

// Three numbers of 32 bits from three (Jarzynski and Olano 2020, Hash Functions for GPU Rendering).
LIMN_FN uvec3 pcg3d(uvec3 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return v;
}

// Three independent numbers in [0, 1) for a pixel.
LIMN_FN vec3 pixel_noise(uint x, uint y, uint seed) {
  uvec3 v = pcg3d(uvec3(x, y, seed));
  return vec3(float(v.x >> 8), float(v.y >> 8), float(v.z >> 8)) * 5.9604644775390625e-8f;
}

LIMN_END
#endif  // LIMN_SAMPLING_GLSL
