// Procedural smoke: how dense it is at a place and a time. One definition for the GPU's volume and the reference's.
//
// Four octaves of gradient noise (Perlin 2002) that rise and that another noise carries about (domain warping; Ebert et al.
// 1994, Texturing and Modeling, chapter on turbulence), within a box at whose faces they fade to nothing. No simulation: the
// density at any time follows from nothing but its parameters.
#ifndef LIMN_SMOKE_GLSL
#define LIMN_SMOKE_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/numeric/sampling.glsl"
LIMN_BEGIN

LIMN_UNIFORM_BLOCK(SmokeBlock)
vec3 low;      // corner of the box, m
float risen;   // metres so far
vec3 high;     // opposite corner, m
float whirl;   // size of the largest, m
uvec3 voxels;  // of the grid that it is looked up in
uint seed;
LIMN_END_UNIFORM_BLOCK(smoke)

// Gradient at a point of the lattice, in [-1, 1]^3, times the way from there.
LIMN_FN float smoke_slope(ivec3 point, vec3 away, uint seed) {
  uvec3 bits = pcg3d(uvec3(point) + uvec3(seed));
  vec3 gradient = vec3(bits >> 8u) * (2.0f / 16777215.0f) - 1.0f;
  return dot(gradient, away);
}

// Gradient noise: mean 0, about within [-0.8, 0.8], smooth to the second derivative.
LIMN_FN float smoke_noise(vec3 p, uint seed) {
  vec3 whole = floor(p);
  vec3 f = p - whole;
  ivec3 corner = ivec3(whole);
  vec3 w = f * f * f * (f * (f * 6.0f - 15.0f) + 10.0f);
  float sum = 0.0f;
  for (int i = 0; i < 8; ++i) {
    ivec3 step = ivec3(i & 1, (i >> 1) & 1, i >> 2);
    vec3 share = mix(1.0f - w, w, vec3(step));
    sum += share.x * share.y * share.z * smoke_slope(corner + step, f - vec3(step), seed);
  }
  return sum;
}

// Density at p (world, metres), 0 to 1; the rest as in SmokeBlock.
LIMN_FN float smoke_density(vec3 low, vec3 high, float risen, float whirl, uint seed, vec3 p) {
  vec3 unit = (p - low) / (high - low);
  vec3 inside = clamp(min(unit, 1.0f - unit) * 4.0f, vec3(0.0f), vec3(1.0f));
  inside = inside * inside * (3.0f - 2.0f * inside);
  float fade = inside.x * inside.y * inside.z;
  if (!(fade > 0.0f)) return 0.0f;
  vec3 q = (p - vec3(0.0f, risen, 0.0f)) / whirl;
  // What carries the whirls about stays behind when they rise, which turns them.
  vec3 r = 0.6f * (p - vec3(0.0f, 0.4f * risen, 0.0f)) / whirl;
  q += 0.9f * vec3(smoke_noise(r, seed + 11u), smoke_noise(r, seed + 12u), smoke_noise(r, seed + 13u));
  float sum = 0.0f;
  float share = 1.0f;
  for (uint octave = 0u; octave < 4u; ++octave) {
    sum += share * smoke_noise(q, seed + octave);
    q = q * 2.03f;
    share *= 0.55f;
  }
  return fade * clamp(0.42f + 1.7f * sum, 0.0f, 1.0f);
}

LIMN_END
#endif  // LIMN_SMOKE_GLSL
