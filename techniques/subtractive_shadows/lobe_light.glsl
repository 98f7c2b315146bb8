// Light of the environment that lobes reflect, by samples each of which looks up the mean over what it stands for
// (glsl/light/radiance_levels.glsl). All surfaces take the same points, in the plane of normal and view: with 32 of them the error
// is less, and smoother, than with points that each pixel shifts by itself.
#ifndef LIMN_LOBE_LIGHT_GLSL
#define LIMN_LOBE_LIGHT_GLSL
#include "glsl/light/environment.glsl"
#include "glsl/light/radiance_levels.glsl"
#include "glsl/surface/lobe_samples.glsl"
#include "glsl/surface/surface_response.glsl"

uniform int brdf_samples;
uniform float full_reflectance;

// Black below the horizon of the geometric normal g.
vec3 radiance_of_sample(vec3 direction, float spread, vec3 g) {
  if (!(dot(direction, g) > 0.0)) return vec3(0.0);
  return radiance_around(direction, spread, frame.environment_rotation, frame.environment_scale);
}

// Mean radiance, weighted by the parts of a GGX lobe that f0 and f90 are factors of.
struct LobeLight {
  vec3 facing;
  vec3 grazing;
};

// Returns how many samples a lobe takes that reflects that share of its light. Its squared error goes with the square of what it
// reflects over the number of samples: of a given number for all pixels the errors' sum is least where each pixel's goes with what it
// reflects.
int samples_of_lobe(vec3 reflectance) {
  float most = max(max(reflectance.r, reflectance.g), reflectance.b);
  float share = most < full_reflectance ? most / full_reflectance : 1.0;
  return max(int(ceil(share * float(brdf_samples))), 1);
}

// n: shading normal; g: geometric one.
LobeLight sampled_lobe(float alpha, vec3 n, vec3 g, vec3 v, int samples) {
  Frame around = frame_towards(n, v);
  vec3 local = to_local(around, v);
  LobeLight light = LobeLight(vec3(0.0), vec3(0.0));
  vec2 weights = vec2(0.0);
  for (int i = 0; i < samples; ++i) {
    LobeSample l = lobe_sample(alpha, local, lobe_point(i, samples).xy, samples);
    if (!(l.weight > 0.0)) continue;
    vec2 weight = l.weight * vec2(1.0 - l.schlick, l.schlick);
    vec3 radiance = radiance_of_sample(from_local(around, l.direction), l.spread, g);
    weights += weight;
    light.facing += weight.x * radiance;
    light.grazing += weight.y * radiance;
  }
  if (weights == vec2(0.0)) {
    // All samples lie below the horizon, as the only one of a wide lobe may: the hemisphere stands for the lobe.
    light.facing = light.grazing = radiance_of_sample(n, 2.0 * pi, n);
    return light;
  }
  light.facing /= max(weights.x, 1e-30);
  light.grazing /= max(weights.y, 1e-30);
  return light;
}

// Irradiance for the diffuse part; the lobe's reflectance times its light: exact where light is uniform.
ReflectedParts reflected_lobe(SurfaceBrdf s, LtcTerms terms, vec3 irradiance, LobeLight light) {
  ReflectedParts reflected = environment_reflection(s, terms, irradiance, vec3(0.0));
  reflected.lobe = s.f0 * terms.reflectance.x * light.facing + s.f90 * terms.reflectance.y * light.grazing;
  return reflected;
}

#if (MATERIAL_MODELS & 127) != 0
// Whether all but the lobe is Lambertian.
bool has_lambertian_floor(MaterialModel m) {
  return m.kind == model_torrance_sparrow || m.kind == model_ward || m.kind == model_phong;
}

// A Lambertian floor has its light from the irradiance, and the samples are the lobe's alone; but not under a response that is
// another technique's, which may reflect light where the exact lobe has no samples.
ReflectedParts sampled_model(SurfaceMaterial own, vec3 n, vec3 g, vec3 v, vec3 irradiance) {
  MaterialModel drawn = own.model;
#ifndef SURFACE_ANSWER
  if (has_lambertian_floor(drawn)) drawn.kd = vec3(0.0);
#endif
  if (!model_anisotropic(drawn)) own.frame = frame_towards(n, v);
  vec3 local = to_local(own.frame, v);
  ReflectedParts sum = ReflectedParts(vec3(0.0), vec3(0.0));
  for (int i = 0; i < brdf_samples; ++i) {
    vec3 l = model_sample(drawn, local, lobe_point(i, brdf_samples));
    float density = model_pdf(drawn, local, l);
    if (!(density > 0.0)) continue;
    vec3 towards = from_local(own.frame, l);
    vec3 radiance = radiance_of_sample(towards, sample_spread(density, brdf_samples), g);
    add_parts(sum, scaled_parts(surface_response_parts(own, n, v, towards), radiance / density));
  }
  sum = scaled_parts(sum, vec3(1.0 / float(brdf_samples)));
  if (has_lambertian_floor(own.model)) sum.diffuse = own.model.kd * (inverse_pi * irradiance);
  return sum;
}
#endif

#endif  // LIMN_LOBE_LIGHT_GLSL
