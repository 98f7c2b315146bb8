// Virtual area lights: clusters of virtual point lights that share their shadows (thesis, chapter 6; Dong et al. 2009,
// Interactive Global Illumination Using Clustered Visibility).
#ifndef LIMN_VIRTUAL_AREA_LIGHT_GLSL
#define LIMN_VIRTUAL_AREA_LIGHT_GLSL
#include "glsl/numeric/geometry.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/indirect/virtual_light.glsl"
LIMN_BEGIN

// Centre of a cluster while it is sought, and the light that comes of it. Element of a storage buffer.
struct VirtualAreaLight {
  vec3 position;  // mean, m
  float count;    // of virtual point lights that carry flux; < 0: a cluster that never had any
  vec4 normal;    // mean, unit, 0 where the normals cancel out
  vec2 extent;    // sides of the rectangle around them in the plane of the normal, along the axes of its view, m
  uvec2 unused;
};

// Angle between unit vectors as a share of pi, good where it is small; any to 0: 1/2.
LIMN_FN float cluster_angle(vec3 a, vec3 b) {
  if (dot(b, b) == 0.0f) return 0.5f;
  vec3 chord = a - b;
  return 2.0f * arc_sine(min(0.5f * sqrt(dot(chord, chord)), 1.0f)) * inverse_pi;
}

// Distance of a virtual point light from a cluster (thesis, section 6.4.1): w_x |dx| + w_a angle, |dx| in units of the
// scene's extent and the angle in units of pi, without which the weights mean nothing. per_extent: 1 / extent, 1/m.
LIMN_FN float cluster_distance(VirtualPointLight light, VirtualAreaLight cluster, float per_extent, float weight_position,
                               float weight_angle) {
  vec3 offset = light.position - cluster.position;
  return weight_position * per_extent * length(offset) +
         weight_angle * cluster_angle(light.normal, vec3(cluster.normal));
}

// The light that cluster k of `clusters` starts from: floor(k N / M), the same in every frame.
LIMN_FN uint cluster_start(uint k, uint lights, uint clusters) { return k * lights / clusters; }

// Mean of unit vectors from their sum; 0 where they cancel out.
LIMN_FN vec3 cluster_normal(vec3 sum, float count) {
  float size = length(sum);
  return size > 1e-3f * count ? sum / size : vec3(0.0f);
}

// A side from the reach of n samples of it: n evenly spread samples reach (n - 1) / (n + 1) of it on average.
LIMN_FN float cluster_side(float reach, float n) { return n > 1.0f ? reach * (n + 1.0f) / (n - 1.0f) : 0.0f; }

LIMN_END
#endif  // LIMN_VIRTUAL_AREA_LIGHT_GLSL
