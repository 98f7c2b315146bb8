// Light of the environment that the surface of a pixel reflects, unoccluded (V = 1). Where the material has a model, it is that of
// the metallic-roughness surface next to it, but coats mirror, and what enters translucent surfaces is what passes their
// boundaries. ShadingMapService::readReflected() declares what it looks up.
#ifndef LIMN_REFLECTED_ENVIRONMENT_GLSL
#define LIMN_REFLECTED_ENVIRONMENT_GLSL
#include "glsl/light/environment.glsl"
#include "glsl/surface/surface_response.glsl"
#if (MATERIAL_MODELS & 160) != 0
#include "glsl/light/coated_environment.glsl"

uniform sampler2D environment_grazing;  // as environment_irradiance, of light weighted by schlick_weight(n.l)

vec3 grazing_light(vec3 n) {
  vec2 place = environment_irradiance_place(n, frame.environment_rotation);
  return frame.environment_scale * textureLod(environment_grazing, place, 0.0).rgb;
}
#endif

// n, ng: shading and geometric normal: lobes have no light from below the horizon of the latter; v: unit, towards the viewer.
ReflectedParts reflected_environment(SurfaceMaterial own, vec3 n, vec3 ng, vec3 v) {
#if (MATERIAL_MODELS & 128) != 0
  vec3 irradiance = environment_irradiance_towards(n, frame.environment_rotation, frame.environment_scale);
  vec3 entering = entering_irradiance(own.model, vec3(1.0) - own.model.kd, irradiance, grazing_light(n));
  return ReflectedParts(inverse_pi * entering, vec3(0.0));
#else
  SurfaceBrdf material = own.brdf;
#if (MATERIAL_MODELS & 32) != 0
  if (own.model.kind == model_coated) {
    vec3 irradiance = environment_irradiance_towards(n, frame.environment_rotation, frame.environment_scale);
    vec3 mirror = environment_lookup_direction(mirror_direction(n, v), frame.environment_rotation);
    vec3 mirrored = frame.environment_scale * environment_filtered_level(mirror, 0);
    return coated_environment(own.model, n, ng, v, irradiance, grazing_light(n), mirrored);
  }
#endif
#if MATERIAL_MODELS
  if (has_model(own)) material = nearest_brdf(own);
#endif
  return environment_light(material, n, ng, v, frame.environment_rotation, frame.environment_scale);
#endif
}

#endif  // LIMN_REFLECTED_ENVIRONMENT_GLSL
