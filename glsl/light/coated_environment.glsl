// Light of the environment on coated surfaces (glsl/materials/coated.glsl), whichever maps it is looked up in.
#ifndef LIMN_COATED_ENVIRONMENT_GLSL
#define LIMN_COATED_ENVIRONMENT_GLSL
#include "glsl/materials/coated.glsl"
LIMN_BEGIN

// Light of the base, given the irradiance and the part of it that grazes: that of light weighted by schlick_weight(n.l), 1 / 21
// of the irradiance where light is uniform. The irradiance that enters the coat, int (1 - F) L cos, follows from both with F
// replaced by F(1) + b (1 - n.l)^5, where b makes the mean of F exact: one map serves all indices.
LIMN_FN vec3 coated_environment_base(MaterialModel m, float n_dot_v, vec3 irradiance, vec3 grazing) {
  vec3 light = m.kd * inverse_pi * irradiance;
  if ((m.options & (model_option_blend | model_option_physical)) == 0u) return light;
  vec3 passing = vec3(1.0f) - coated_mirror(m, n_dot_v);
  if ((m.options & model_option_physical) == 0u) return passing * light;
  vec3 mean = dielectric_mean_reflectance(m.eta);
  vec3 facing = fresnel(1.0f, m.eta, m.k);
  vec3 entering = (vec3(1.0f) - facing) * irradiance - 21.0f * (mean - facing) * grazing;
  return passing * m.kd * inverse_pi * max(entering, vec3(0.0f)) * coated_escape(m, mean) / (vec3(1.0f) - mean);
}

// Light of coat and base; mirrored: radiance from the mirror direction.
LIMN_FN vec3 coated_environment(MaterialModel m, float n_dot_v, vec3 irradiance, vec3 grazing, vec3 mirrored) {
  return coated_environment_base(m, n_dot_v, irradiance, grazing) + coated_mirror(m, n_dot_v) * mirrored;
}

LIMN_END
#endif  // LIMN_COATED_ENVIRONMENT_GLSL
