// The unshadowed light of the environment by samples of each pixel's lobe, and by the irradiance map for the diffuse part. Coats
// mirror, as in reflected_environment.glsl.
#ifndef LIMN_BRDF_SAMPLES_GLSL
#define LIMN_BRDF_SAMPLES_GLSL
#include "glsl/light/reflected_environment.glsl"
#include "glsl/shadow/sampled_pixel.glsl"
#include "techniques/subtractive_shadows/lobe_light.glsl"

ReflectedParts sampled_environment(SampledPixel p) {
  vec3 n = p.surface.normal, g = p.surface.geometric_normal, v = p.to_viewer;
  if (is_coated(p)) return reflected_environment(p.material, n, g, v);
  vec3 irradiance = environment_irradiance_towards(n, frame.environment_rotation, frame.environment_scale);
#if MATERIAL_MODELS
  if (has_model(p.material)) return sampled_model(p.material, n, g, v, irradiance);
#endif
  SurfaceBrdf s = p.material.brdf;
  LtcTerms terms = ltc_lookup(dot(n, v), s.alpha);
  LobeLight light = LobeLight(vec3(0.0), vec3(0.0));
  if (!brdf_is_lambertian(s))
    light = sampled_lobe(s.alpha, n, g, v, samples_of_lobe(ltc_specular_reflectance(s, terms)));
  return reflected_lobe(s, terms, irradiance, light);
}

#endif  // LIMN_BRDF_SAMPLES_GLSL
