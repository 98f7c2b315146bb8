// Light that enters a translucent surface through its smooth boundary, as the response of a surface that lights are added up
// on: F_t(n.l) / pi in every direction of v, so that pi times the radiance is the irradiance that enters, E. Local frame.
#ifndef LIMN_ENTRY_GLSL
#define LIMN_ENTRY_GLSL
#include "glsl/materials/fresnel.glsl"
#include "glsl/materials/material_model.glsl"
LIMN_BEGIN

// ior: of the body, held in [1, 3] as in diffusion_boundary(). kd is the share of diffuse light that enters, 1 - F_de.
LIMN_FN MaterialModel entry_model(float ior) {
  MaterialModel m;
  float eta = clamp(ior, 1.0f, 3.0f);
  m.eta = vec3(eta);
  m.kind = model_entry;
  m.k = vec3(0.0f);
  m.exponent = 0.0f;
  m.kd = vec3(1.0f - dielectric_mean_reflectance(eta));
  m.options = 0u;
  m.ks = vec3(0.0f);
  m.material = 0u;
  m.roughness = vec2(0.0f);
  m.table = 0u;
  m.nodes = 0u;
  return m;
}

// F_t at the cosine n.l, 0 or more.
LIMN_FN float entry_share(MaterialModel m, float cosine) { return 1.0f - fresnel(cosine, m.eta.x, m.k.x); }

LIMN_FN vec3 entry_response(MaterialModel m, vec3 l) { return vec3(inverse_pi * l.z * entry_share(m, l.z)); }

LIMN_END
#endif  // LIMN_ENTRY_GLSL
