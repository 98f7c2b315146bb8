// A Lambertian base of albedo kd under a smooth coat with the indices eta and k. What the coat mirrors, coated_mirror() of the
// light from one direction, is no function of two directions and not part of the response here: whoever holds the light from
// the mirror direction adds it (of the environment: glsl/light/coated_environment.glsl). The base answers in one of three ways:
//   sum       kd / pi: with the mirror it gains energy, F(v);
//   blend     (1 - F(v)) kd / pi: exact only for kd = 1, and not reciprocal;
//   physical  (1 - F(v)) (1 - F(l)) kd / (pi eta^2 (1 - kd Fi)): light is refracted into the coat and out of it, and Fi of what
//             leaves the base is reflected back to it. Reciprocal; with kd = 1 and the mirror all light comes back.
// Local frame; arguments: as model_response() and its companions have them.
#ifndef LIMN_COATED_GLSL
#define LIMN_COATED_GLSL
#include "glsl/materials/fresnel.glsl"
#include "glsl/materials/material_model.glsl"
LIMN_BEGIN

// Share of light from the mirror direction that the coat reflects; cosine: n.v.
LIMN_FN vec3 coated_mirror(MaterialModel m, float cosine) { return fresnel(cosine, m.eta, m.k); }

// (1 - Fi) / (1 - kd Fi) for light that is refracted into the coat, where 1 - Fi = (1 - mean F) / eta^2 by reciprocity.
LIMN_FN vec3 coated_escape(MaterialModel m, vec3 mean) {
  vec3 eta = max(m.eta, vec3(1.0f));
  vec3 escape = (vec3(1.0f) - mean) / (eta * eta);
  return escape / (vec3(1.0f) - m.kd + m.kd * escape);
}

LIMN_FN vec3 coated_response(MaterialModel m, vec3 v, vec3 l) {
  vec3 response = m.kd * (inverse_pi * l.z);
  if ((m.options & (model_option_blend | model_option_physical)) == 0u) return response;
  response *= vec3(1.0f) - coated_mirror(m, v.z);
  if ((m.options & model_option_physical) == 0u) return response;
  vec3 mean = dielectric_mean_reflectance(m.eta);
  return response * (vec3(1.0f) - coated_mirror(m, l.z)) * coated_escape(m, mean) / (vec3(1.0f) - mean);
}

// What the base alone reflects of light that comes evenly from all directions; leaving: the share of light towards the viewer
// that the coat does not reflect.
LIMN_FN vec3 coated_base(MaterialModel m, vec3 leaving) {
  if ((m.options & (model_option_blend | model_option_physical)) == 0u) return m.kd;
  if ((m.options & model_option_physical) == 0u) return m.kd * leaving;
  vec3 entering = vec3(1.0f) - mean_reflectance(m.eta, m.k);
  vec3 mean = dielectric_mean_reflectance(m.eta);
  return m.kd * leaving * entering * coated_escape(m, mean) / (vec3(1.0f) - mean);
}

// Hemispherical reflectance of the base alone.
LIMN_FN vec3 coated_albedo(MaterialModel m) { return coated_base(m, vec3(1.0f) - mean_reflectance(m.eta, m.k)); }

LIMN_END
#endif  // LIMN_COATED_GLSL
