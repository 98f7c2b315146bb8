// Ward's elliptical Gaussian distribution of slopes (Ward 1992, Measuring and Modeling Anisotropic Reflection) with exact
// Fresnel reflectance and the masking of Smith that belongs to it, over a diffuse floor. roughness: along the tangent and
// across it. Reciprocal. Local frame; arguments: as model_response() and its companions have them.
#ifndef LIMN_WARD_GLSL
#define LIMN_WARD_GLSL
#include "glsl/materials/microfacet.glsl"
LIMN_BEGIN

LIMN_FN vec3 ward_response(MaterialModel m, vec3 v, vec3 l) {
  vec2 alpha = model_alpha(m);
  vec3 h = microfacet_half(v, l);
  return microfacet_response(m, alpha, v, l, h, gaussian_slope_distribution(h, alpha));
}

LIMN_FN vec3 ward_sample(MaterialModel m, vec3 v, vec3 u) { return microfacet_sample(m, model_alpha(m), v, u); }

LIMN_FN float ward_pdf(MaterialModel m, vec3 v, vec3 l) { return microfacet_pdf(m, model_alpha(m), v, l); }

LIMN_FN vec3 ward_albedo(MaterialModel m) { return microfacet_albedo(m, model_alpha(m)); }

LIMN_END
#endif  // LIMN_WARD_GLSL
