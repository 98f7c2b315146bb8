// Light of the environment on surfaces that it enters through a smooth boundary, coated (glsl/materials/coated.glsl) and
// translucent ones (glsl/materials/entry.glsl), whichever maps it is looked up in.
#ifndef LIMN_COATED_ENVIRONMENT_GLSL
#define LIMN_COATED_ENVIRONMENT_GLSL
#include "glsl/materials/coated.glsl"
#include "glsl/numeric/geometry.glsl"
#include "glsl/surface/reflected_parts.glsl"
LIMN_BEGIN

// Irradiance that enters a boundary, int (1 - F) L cos, given all of it and the part that grazes: that of light weighted by
// schlick_weight(n.l), 1 / 21 of the irradiance where light is uniform. F is replaced by F(1) + b (1 - n.l)^5, where b makes the
// mean of F, `mean`, exact: one map serves all indices.
LIMN_FN vec3 entering_irradiance(MaterialModel m, vec3 mean, vec3 irradiance, vec3 grazing) {
  vec3 facing = fresnel(1.0f, m.eta, m.k);
  return max((vec3(1.0f) - facing) * irradiance - 21.0f * (mean - facing) * grazing, vec3(0.0f));
}

// Light of the base, by the same two.
LIMN_FN vec3 coated_environment_base(MaterialModel m, float n_dot_v, vec3 irradiance, vec3 grazing) {
  vec3 light = m.kd * inverse_pi * irradiance;
  if ((m.options & (model_option_blend | model_option_physical)) == 0u) return light;
  vec3 passing = vec3(1.0f) - coated_mirror(m, n_dot_v);
  if ((m.options & model_option_physical) == 0u) return passing * light;
  vec3 mean = dielectric_mean_reflectance(m.eta);
  vec3 entering = entering_irradiance(m, mean_reflectance(m.eta, m.k), irradiance, grazing);
  return passing * m.kd * inverse_pi * entering * coated_escape(m, mean) / (vec3(1.0f) - mean);
}

// Light of base and coat; mirrored: radiance from the mirror direction, which lies behind surfaces whose normal is turned away.
LIMN_FN ReflectedParts coated_environment(MaterialModel m, float n_dot_v, vec3 irradiance, vec3 grazing, vec3 mirrored) {
  ReflectedParts light;
  light.diffuse = coated_environment_base(m, n_dot_v, irradiance, grazing);
  light.lobe = n_dot_v > 0.0f ? coated_mirror(m, n_dot_v) * mirrored : vec3(0.0f);
  return light;
}

// The same of a surface with the geometric normal ng, from below whose plane nothing is mirrored.
LIMN_FN ReflectedParts coated_environment(MaterialModel m, vec3 n, vec3 ng, vec3 v, vec3 irradiance, vec3 grazing,
                                          vec3 mirrored) {
  bool above = dot(ng, mirror_direction(n, v)) > 0.0f;
  return coated_environment(m, dot(n, v), irradiance, grazing, above ? mirrored : vec3(0.0f));
}

LIMN_END
#endif  // LIMN_COATED_ENVIRONMENT_GLSL
