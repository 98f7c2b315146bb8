// Torrance and Sparrow's model: mirrors in all directions about n, with exact Fresnel reflectance and Smith's masking, over a
// diffuse floor. roughness.x: m, for which the slopes of Beckmann's distribution, or the angles of the Gaussian one, have
// exp(-(x/m)^2). Reciprocal. Local frame; arguments: as model_response() and its companions have them.
#ifndef LIMN_TORRANCE_SPARROW_GLSL
#define LIMN_TORRANCE_SPARROW_GLSL
#include "glsl/materials/microfacet.glsl"
LIMN_BEGIN

LIMN_FN vec2 torrance_sparrow_alpha(MaterialModel m) { return vec2(model_alpha(m).x); }

LIMN_FN vec3 torrance_sparrow_response(MaterialModel m, vec3 v, vec3 l) {
  vec2 alpha = torrance_sparrow_alpha(m);
  vec3 h = microfacet_half(v, l);
  float d = (m.options & model_option_gaussian) != 0u ? gaussian_angle_distribution(h, alpha.x)
                                                      : gaussian_slope_distribution(h, alpha);
  return microfacet_response(m, alpha, v, l, h, d);
}

LIMN_FN vec3 torrance_sparrow_sample(MaterialModel m, vec3 v, vec3 u) {
  return microfacet_sample(m, torrance_sparrow_alpha(m), v, u);
}

LIMN_FN float torrance_sparrow_pdf(MaterialModel m, vec3 v, vec3 l) {
  return microfacet_pdf(m, torrance_sparrow_alpha(m), v, l);
}

LIMN_FN vec3 torrance_sparrow_albedo(MaterialModel m) { return microfacet_albedo(m, torrance_sparrow_alpha(m)); }

LIMN_END
#endif  // LIMN_TORRANCE_SPARROW_GLSL
