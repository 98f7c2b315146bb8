// Adds the light of the environment on every surface to the radiance, unoccluded (V = 1). Where the material has a model, it
// is that of the metallic-roughness surface next to it, but coats mirror, and what enters translucent surfaces is what passes
// their boundaries. MEDIUM 1: times the medium's transmittance along the
// normal.
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/light/environment.glsl"
#include "glsl/media/medium_input.glsl"
#include "glsl/surface/surface_response.glsl"
#if (MATERIAL_MODELS & 160) != 0
#include "glsl/light/coated_environment.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;

#if (MATERIAL_MODELS & 160) != 0
uniform sampler2D environment_grazing;  // as environment_irradiance, of light weighted by schlick_weight(n.l)

vec3 grazing_light(vec3 n) {
  vec2 place = environment_irradiance_place(n, frame.environment_rotation);
  return frame.environment_scale * textureLod(environment_grazing, place, 0.0).rgb;
}
#endif

#if (MATERIAL_MODELS & 32) != 0
vec3 coated_reflection(MaterialModel m, vec3 n, vec3 v) {
  float n_dot_v = dot(n, v);
  vec3 irradiance = environment_irradiance_towards(n, frame.environment_rotation, frame.environment_scale);
  vec3 mirror = environment_lookup_direction(2.0 * n_dot_v * n - v, frame.environment_rotation);
  vec3 mirrored = frame.environment_scale * environment_filtered_level(mirror, 0);
  return coated_environment(m, n_dot_v, irradiance, grazing_light(n), mirrored);
}
#endif

vec3 reflected_environment(SurfaceMaterial own, vec3 n, vec3 v) {
#if (MATERIAL_MODELS & 128) != 0
  vec3 irradiance = environment_irradiance_towards(n, frame.environment_rotation, frame.environment_scale);
  return inverse_pi * entering_irradiance(own.model, vec3(1.0) - own.model.kd, irradiance, grazing_light(n));
#else
  SurfaceBrdf material = own.brdf;
#if (MATERIAL_MODELS & 32) != 0
  if (own.model.kind == model_coated) return coated_reflection(own.model, n, v);
#endif
#if MATERIAL_MODELS
  if (has_model(own)) material = nearest_brdf(own);
#endif
  return environment_light(material, n, v, frame.environment_rotation, frame.environment_scale);
#endif
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  float depth = pixel_depth(pixel);
  if (depth == 0.0) return;
  GBufferSurface surface = pixel_surface(pixel);
  if ((surface.flags & gbuffer_flag_specular) != 0u) return;
  vec3 v = -normalize(pixel_ray(pixel));
  vec3 light = reflected_environment(pixel_material(pixel, surface), surface.normal, v);
#if MEDIUM
  Medium medium = scene_medium();
  light *= medium_transmittance(medium, medium_length(medium, pixel_position(pixel, depth), surface.normal, 3.0e38));
#endif
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
}
