// What coats mirror of the environment, unoccluded. MEDIUM 1: light is attenuated.
#ifndef LIMN_MIRRORED_ENVIRONMENT_GLSL
#define LIMN_MIRRORED_ENVIRONMENT_GLSL
#include "glsl/shadow/sampled_pixel.glsl"
#include "glsl/numeric/equirectangular.glsl"

#if (MATERIAL_MODELS & 32) != 0
uniform sampler2D environment_map;  // equirectangular radiance

// p: of a coated surface. Black where the mirror direction lies below the horizon of either normal, as in coated_environment.glsl.
vec3 mirrored_environment(SampledPixel p) {
  float n_dot_v = dot(p.surface.normal, p.to_viewer);
  vec3 mirror = mirror_direction(p.surface.normal, p.to_viewer);
  if (!(n_dot_v > 0.0) || dot(p.surface.geometric_normal, mirror) <= 0.0) return vec3(0.0);
  vec2 uv = equirectangular_uv(environment_lookup_direction(mirror, frame.environment_rotation));
  vec3 arriving = frame.environment_scale * textureLod(environment_map, uv, 0.0).rgb;
#if MEDIUM
  Medium medium = scene_medium();
  arriving *= medium_transmittance(medium, medium_length(medium, p.position, mirror, 3.0e38));
#endif
  return coated_mirror(p.material.model, n_dot_v) * arriving;
}
#endif

#endif  // LIMN_MIRRORED_ENVIRONMENT_GLSL
