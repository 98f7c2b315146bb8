// The unshadowed light of the environment from the radiance cache, and from the irradiance map for the diffuse part. What is not in
// the cache is as in reflected_environment.glsl.
#ifndef LIMN_CACHED_ENVIRONMENT_GLSL
#define LIMN_CACHED_ENVIRONMENT_GLSL
#include "glsl/light/reflected_environment.glsl"
#include "glsl/shadow/sampled_pixel.glsl"
#include "techniques/subtractive_shadows/cache_view.glsl"
#include "techniques/subtractive_shadows/lobe_light.glsl"

uniform sampler2DArray radiance_cache;
layout(std430) readonly buffer CachePlaces { uint cache_places[]; };  // of each material; no_instance: it has none
#if (MATERIAL_MODELS & 127) == 0
layout(std430) readonly buffer Instances { Instance instances[]; };
#endif

ReflectedParts cached_environment(ivec2 pixel, SampledPixel p) {
  vec3 n = p.surface.normal, g = p.surface.geometric_normal, v = p.to_viewer;
  uint instance = pixel_instance(pixel);
  uint place = instance == no_instance ? no_instance : cache_places[instances[instance].material];
  if (place == no_instance) return reflected_environment(p.material, n, g, v);
  vec3 at = vec3(cache_place(n, cache_view(), cache_view_reach()), float(2u * place));
  LobeLight light = LobeLight(textureLod(radiance_cache, at, 0.0).rgb,
                              textureLod(radiance_cache, at + vec3(0.0, 0.0, 1.0), 0.0).rgb);
  vec3 irradiance = environment_irradiance_towards(n, frame.environment_rotation, frame.environment_scale);
  SurfaceBrdf s = p.material.brdf;
  LtcTerms terms = ltc_lookup(dot(n, v), s.alpha);
  // The cache has one normal for both; of models the share is that of the surface next to them.
  float share = environment_lobe_share(terms, n, g, v, s.alpha);
  light.facing *= share;
#if MATERIAL_MODELS
  MaterialModel m = p.material.model;
  if (has_model(p.material))
    return ReflectedParts(has_lambertian_floor(m) ? m.kd * (inverse_pi * irradiance) : light.grazing, light.facing);
#endif
  light.grazing *= share;
  return reflected_lobe(s, terms, irradiance, light);
}

#endif  // LIMN_CACHED_ENVIRONMENT_GLSL
