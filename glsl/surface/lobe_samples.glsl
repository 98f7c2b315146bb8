// Samples of the glossy part of glsl/surface/brdf.glsl, drawn from the normals that are visible from the viewer (Heitz 2018,
// Sampling the GGX Distribution of Visible Normals).
#ifndef LIMN_LOBE_SAMPLES_GLSL
#define LIMN_LOBE_SAMPLES_GLSL
#include "glsl/numeric/geometry.glsl"
#include "glsl/numeric/halton.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/surface/brdf.glsl"
LIMN_BEGIN

// Point i of `count` in the unit cube: a rank-1 lattice of the golden ratio, and a third coordinate that is even over any run of
// points.
LIMN_FN vec3 lobe_point(int i, int count) {
  return vec3(fract(0.61803399f * float(i)), (float(i) + 0.5f) / float(count), radical_inverse(2u, uint(i)));
}

// Solid angle that one of `count` samples stands for where their density is `density` (1/sr): at most the sphere.
LIMN_FN float sample_spread(float density, int count) { return 1.0f / max(float(count) * density, 0.25f * inverse_pi); }

struct LobeSample {
  vec3 direction;  // unit, in the frame of n = +z
  float schlick;   // weight of f90, of which f0 has the rest
  float weight;    // f cos over the density where the Fresnel term is 1, in [0, 1]: 0 below the horizon
  float spread;    // sample_spread(), sr
};

// v: unit, in the frame of n = +z; where it is not above the horizon, what is seen next to it is sampled.
LIMN_FN LobeSample lobe_sample(float alpha, vec3 v, vec2 u, int count) {
  if (v.z < brdf_min_cosine) v = normalize(vec3(v.x, v.y, brdf_min_cosine));
  vec3 h = sample_visible_normal(v, vec2(alpha), u);
  float v_dot_h = dot(v, h);
  float masking = ggx_masking(v.z, alpha);
  LobeSample s;
  s.direction = 2.0f * v_dot_h * h - v;
  s.schlick = schlick_weight(v_dot_h);
  float n_dot_l = s.direction.z;
  s.weight = n_dot_l > 0.0f ? min(4.0f * n_dot_l * v.z * ggx_visibility(v.z, n_dot_l, alpha) / masking, 1.0f) : 0.0f;
  float density = masking * ggx_distribution(h.z, h.x * h.x + h.y * h.y, alpha) / (4.0f * v.z);
  s.spread = sample_spread(density, count);
  return s;
}

LIMN_END
#endif  // LIMN_LOBE_SAMPLES_GLSL
