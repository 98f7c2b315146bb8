// What models of microfacets share: distributions of normals D (1/sr, int D cos = 1), Smith's masking and the sampling of
// visible normals. Local frame: n = +z, t = +x. alpha: slopes along t and across it; isotropic where they are equal.
#ifndef LIMN_MICROFACET_GLSL
#define LIMN_MICROFACET_GLSL
#include "glsl/materials/fresnel.glsl"
#include "glsl/materials/material_model.glsl"
#include "glsl/numeric/geometry.glsl"
LIMN_BEGIN

// n.v and n.l are clamped here: masking over n.v has a limit at 0, which it has reached.
LIMN_CONST float microfacet_min_cosine = 1e-7f;

// The half vector; n where l = -v.
LIMN_FN vec3 microfacet_half(vec3 v, vec3 l) {
  vec3 sum = v + l;
  float size = length(sum);
  return size > 1e-6f ? sum / size : vec3(0.0f, 0.0f, 1.0f);
}

// Squared slope of h in units of alpha.
LIMN_FN float microfacet_slope2(vec3 h, vec2 alpha) {
  vec2 slope = vec2(h) / (alpha * max(h.z, 1e-12f));
  return dot(slope, slope);
}

// Beckmann's distribution, or the elliptical Gaussian of Ward (1992): exp(-(hx^2/ax^2 + hy^2/ay^2) / hz^2) / (pi ax ay hz^4).
LIMN_FN float gaussian_slope_distribution(vec3 h, vec2 alpha) {
  float slope2 = microfacet_slope2(h, alpha);
  float z2 = h.z * h.z;
  return h.z > 0.0f && slope2 < 80.0f ? exp(-slope2) / (pi * alpha.x * alpha.y * z2 * z2) : 0.0f;
}

// Dawson's integral exp(-x^2) int_0^x exp(t^2) dt for x in [0, 1], by its series, within 1e-7.
LIMN_FN float dawson(float x) {
  float sum = 1.0f;
  for (int i = 21; i > 1; i -= 2) sum = 1.0f - 2.0f * x * x / float(i) * sum;
  return x * sum;
}

// A Gaussian of the angle d between n and h, exp(-(d/m)^2) / (pi m Daw(m)). Its integral is 1 within 3e-6 for m <= 0.5, and
// 1.018 at m = 1, since the norm counts angles above pi/2.
LIMN_FN float gaussian_angle_distribution(vec3 h, float m) {
  float angle = atan(length(vec2(h)), h.z) / m;
  return h.z > 0.0f ? exp(-angle * angle) / (pi * m * dawson(m)) : 0.0f;
}

// sqrt(ax^2 x^2 + ay^2 y^2): the tangent of the angle to n times n.w times the slope along w's azimuth.
LIMN_FN float microfacet_spread(vec3 w, vec2 alpha) { return length(alpha * vec2(w)); }

// Smith's Lambda of Gaussian slopes, (erf a - 1) / 2 + exp(-a^2) / (2 a sqrt pi) with a = cosine / spread. 1 - erf a is
// exp(-a^2) times a polynomial in 1 / (1 + p a) (Abramowitz and Stegun 7.1.26), within 1.5e-7.
LIMN_FN float smith_lambda(float cosine, float spread) {
  float a = cosine / max(spread, 0.1f * cosine);
  float t = 1.0f / (1.0f + 0.3275911f * a);
  float tail =
      t * (0.254829592f + t * (-0.284496736f + t * (1.421413741f + t * (-1.453152027f + t * 1.061405429f))));
  return max(0.5f * exp(-a * a) * (0.56418958f / a - tail), 0.0f);
}

// G / (4 n.v), the second factor of f cos(l) = F D G / (4 n.v): finite at n.v = 0, where it is sqrt(pi) / (2 m) for l = n. G is
// 1 / (1 + Lambda_v + Lambda_l), or the product of 1 / (1 + Lambda) of both.
LIMN_FN float masking_over_view(vec3 v, vec3 l, vec2 alpha, bool product) {
  float n_dot_v = max(v.z, microfacet_min_cosine);
  float from_v = smith_lambda(n_dot_v, microfacet_spread(v, alpha));
  float from_l = smith_lambda(max(l.z, microfacet_min_cosine), microfacet_spread(l, alpha));
  float both = product ? (1.0f + from_v) * (1.0f + from_l) : 1.0f + from_v + from_l;
  return 0.25f / (n_dot_v * both);
}

// Normals are sampled as GGX has them visible from v (sample_visible_normal()), whichever D is: with equal slopes its tail lies
// above those of the Gaussians, so that D over its density is at most 4 / e.

// Density (1/sr) of the direction that v, v.z > 0, is mirrored to by such a normal h: G1(v) D(h) / (4 n.v) of GGX.
LIMN_FN float visible_normal_pdf(vec3 v, vec3 h, vec2 alpha) {
  vec3 q = vec3(h.x / alpha.x, h.y / alpha.y, h.z);
  float q2 = dot(q, q);
  float spread = microfacet_spread(v, alpha);
  return 0.5f / (pi * alpha.x * alpha.y * q2 * q2 * (v.z + sqrt(v.z * v.z + spread * spread)));
}

// f cos(l) = kd cos(l) / pi + ks F D G / (4 n.v), given d = D(h). With kd = 0 no more than all light is reflected; kd is a
// floor, and adds to what the lobe reflects: next to a grazing view, where F = 1, all of kd is gained.
LIMN_FN vec3 microfacet_response(MaterialModel m, vec2 alpha, vec3 v, vec3 l, vec3 h, float d) {
  float lobe = d * masking_over_view(v, l, alpha, (m.options & model_option_product) != 0u);
  return m.kd * (inverse_pi * l.z) + m.ks * fresnel(dot(l, h), m.eta, m.k) * lobe;
}

// Probability of sampling the lobe; 0 where v is below the horizon, from where no normals are visible.
LIMN_FN float microfacet_share(MaterialModel m, vec3 v) {
  if (!(v.z > 0.0f)) return 0.0f;
  return model_lobe_share(largest_channel(m.ks * fresnel(v.z, m.eta, m.k)), largest_channel(m.kd));
}

// A direction from a lobe of visible normals with probability `share`, else from a cosine; and its density.
LIMN_FN vec3 microfacet_or_cosine_sample(float share, vec2 alpha, vec3 v, vec3 u) {
  if (u.z >= share) return sample_cosine(vec2(u));
  vec3 h = sample_visible_normal(v, alpha, vec2(u));
  return normalize(2.0f * dot(v, h) * h - v);
}
LIMN_FN float microfacet_or_cosine_pdf(float share, vec2 alpha, vec3 v, vec3 l) {
  float pdf = (1.0f - share) * cosine_pdf(l.z);
  if (share > 0.0f) pdf += share * visible_normal_pdf(v, microfacet_half(v, l), alpha);
  return pdf;
}

LIMN_FN vec3 microfacet_sample(MaterialModel m, vec2 alpha, vec3 v, vec3 u) {
  return microfacet_or_cosine_sample(microfacet_share(m, v), alpha, v, u);
}
LIMN_FN float microfacet_pdf(MaterialModel m, vec2 alpha, vec3 v, vec3 l) {
  return microfacet_or_cosine_pdf(microfacet_share(m, v), alpha, v, l);
}

// How much more than all light the lobe of the Gaussian of the angle gives back to grazing views, at the most: Smith's Lambda is
// that of Gaussian slopes, and hides less of these normals than there are. A bound on 0.16 % at m = 0.1, 4.2 % at 0.5 and 8.8 %
// at 0.9 with correlated masking; 0.8 % at 0.6 with the product.
LIMN_FN float gaussian_angle_gain(MaterialModel m) {
  float m2 = model_alpha(m).x * model_alpha(m).x;
  return (m.options & model_option_product) != 0u ? min(0.025f * m2, 0.009f) : min(0.18f * m2, 0.09f);
}

// The most light that is reflected, over what arrives, in the channel that reflects most: the hemispherical mean of floor and
// lobe, which a grazing view exceeds by its floor, or what a lobe alone gives back to that view.
LIMN_FN float microfacet_excess(MaterialModel m) {
  float gain = m.kind == model_torrance_sparrow && (m.options & model_option_gaussian) != 0u ? gaussian_angle_gain(m) : 0.0f;
  vec3 grazing = m.ks * fresnel(0.1f, m.eta, m.k) * (1.0f + gain);
  return largest_channel(max(m.kd + m.ks * mean_reflectance(m.eta, m.k), grazing));
}

// Hemispherical reflectance, about. What light loses that would leave only after several reflections is a polynomial fitted to
// the furnace of the white Beckmann lobe: 0.5 % at m = 0.1, 11 % at 0.5 and 34 % at 1.
LIMN_FN vec3 microfacet_albedo(MaterialModel m, vec2 alpha) {
  float m2 = 0.5f * dot(alpha, alpha);
  float kept = 1.0f - m2 * (0.49f - 0.15f * sqrt(m2));
  return min(m.kd + m.ks * mean_reflectance(m.eta, m.k) * kept, vec3(1.0f));
}

LIMN_END
#endif  // LIMN_MICROFACET_GLSL
