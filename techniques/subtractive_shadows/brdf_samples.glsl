// The unshadowed light of the environment by samples of the surface's lobe, each of which looks up the mean over what it stands
// for (glsl/light/radiance_levels.glsl), and by the irradiance map for the diffuse part. Coats mirror, and what enters translucent
// surfaces is as in reflected_environment.glsl: neither has a lobe to sample.
//
// All pixels take the same points, in the plane of normal and view: with 32 of them the error is less, and smoother, than with
// points that each pixel shifts by itself.
#ifndef LIMN_BRDF_SAMPLES_GLSL
#define LIMN_BRDF_SAMPLES_GLSL
#include "glsl/light/radiance_levels.glsl"
#include "glsl/light/reflected_environment.glsl"
#include "glsl/shadow/sampled_pixel.glsl"
#include "glsl/surface/lobe_samples.glsl"

uniform int brdf_samples;

vec3 radiance_of_sample(vec3 direction, float spread) {
  return radiance_around(direction, spread, frame.environment_rotation, frame.environment_scale);
}

// The light's mean over the samples, by their weights, times the lobe's reflectance: exact where light is uniform.
vec3 sampled_lobe(SurfaceBrdf s, vec3 reflectance, vec3 n, vec3 v) {
  Frame around = frame_towards(n, v);
  vec3 local = to_local(around, v);
  vec3 sum = vec3(0.0), weights = vec3(0.0);
  for (int i = 0; i < brdf_samples; ++i) {
    LobeSample l = lobe_sample(s.alpha, local, lobe_point(i, brdf_samples).xy, brdf_samples);
    if (!(l.weight > 0.0)) continue;
    vec3 weight = l.weight * mix(s.f0, vec3(s.f90), l.schlick);
    weights += weight;
    sum += weight * radiance_of_sample(from_local(around, l.direction), l.spread);
  }
  return reflectance * mix(vec3(0.0), sum / max(weights, vec3(1e-30)), greaterThan(weights, vec3(0.0)));
}

#if (MATERIAL_MODELS & 127) != 0
// Where all but the lobe is kd's, the samples are the lobe's alone; not under a response that is another technique's, which may
// reflect light where the exact lobe has no samples.
ReflectedParts sampled_model(SurfaceMaterial own, vec3 n, vec3 v, vec3 irradiance) {
  MaterialModel drawn = own.model;
  bool floor_apart = drawn.kind == model_torrance_sparrow || drawn.kind == model_ward || drawn.kind == model_phong;
#ifndef SURFACE_ANSWER
  if (floor_apart) drawn.kd = vec3(0.0);
#endif
  if (!model_anisotropic(drawn)) own.frame = frame_towards(n, v);
  vec3 local = to_local(own.frame, v);
  ReflectedParts sum = ReflectedParts(vec3(0.0), vec3(0.0));
  for (int i = 0; i < brdf_samples; ++i) {
    vec3 l = model_sample(drawn, local, lobe_point(i, brdf_samples));
    float density = model_pdf(drawn, local, l);
    if (!(density > 0.0)) continue;
    vec3 towards = from_local(own.frame, l);
    vec3 radiance = radiance_of_sample(towards, sample_spread(density, brdf_samples));
    add_parts(sum, scaled_parts(surface_response_parts(own, n, v, towards), radiance / density));
  }
  sum = scaled_parts(sum, vec3(1.0 / float(brdf_samples)));
  if (floor_apart) sum.diffuse = own.model.kd * (inverse_pi * irradiance);
  return sum;
}
#endif

ReflectedParts sampled_environment(SampledPixel p) {
  vec3 n = p.surface.normal, v = p.to_viewer;
#if (MATERIAL_MODELS & 128) != 0
  return reflected_environment(p.material, n, v);
#else
  if (is_coated(p)) return reflected_environment(p.material, n, v);
  vec3 irradiance = environment_irradiance_towards(n, frame.environment_rotation, frame.environment_scale);
#if MATERIAL_MODELS
  if (has_model(p.material)) return sampled_model(p.material, n, v, irradiance);
#endif
  SurfaceBrdf s = p.material.brdf;
  LtcTerms terms = ltc_lookup(dot(n, v), s.alpha);
  ReflectedParts light = environment_reflection(s, terms, irradiance, vec3(0.0));
  if (!brdf_is_lambertian(s)) light.lobe = sampled_lobe(s, ltc_specular_reflectance(s, terms), n, v);
  return light;
#endif
}

#endif  // LIMN_BRDF_SAMPLES_GLSL
