// The model of Banks (1994, Illumination in Diverse Codimensions) of surfaces covered with fibres or scratches along the
// tangent t: the shading normal n' is the light's direction without its part along t.
//   f = kd n'.l + ks (n'.h)^p as printed,
//   f = kd sqrt(1 - (l.t)^2) + ks (sqrt(1 - (l.t)^2) sqrt(1 - (v.t)^2) - (l.t) (v.t))^p after Stalling, Zoeckler and Hege (1997,
// Fast Display of Illuminated Field Lines), where the lobe is the largest r.v over the normals of a fibre and so a function
// of l.t and v.t alone; n'.l is the same root. kd and ks are coefficients (1/sr), not albedos. Not reciprocal. Local frame;
// arguments: as model_response() and its companions have them.
#ifndef LIMN_BANKS_GLSL
#define LIMN_BANKS_GLSL
#include "glsl/materials/material_model.glsl"
#include "glsl/materials/power_lobe.glsl"
#include "glsl/numeric/geometry.glsl"
LIMN_BEGIN

// int cos(l) sqrt(1 - (l.t)^2) over the hemisphere.
LIMN_CONST float banks_diffuse_integral = 2.66666667f;

// Sine of the angle to t: sqrt(1 - (w.t)^2).
LIMN_FN float banks_sine(vec3 w) { return length(vec2(w.y, w.z)); }

// The lobe of Stalling et al., cos^p of the angle between l and the cone of the mirrored v.
LIMN_FN float banks_cone_lobe(float p, vec3 v, vec3 l) {
  vec2 apart = vec2(banks_sine(l) - banks_sine(v), l.x + v.x);
  return power_of_cosine(dot(apart, apart), p);
}

// (n'.h)^p.
LIMN_FN float banks_printed_lobe(float p, vec3 v, vec3 l) {
  vec3 sum = v + l;
  vec3 apart = vec3(0.0f, l.y, l.z) / max(banks_sine(l), 1e-20f) - sum / max(length(sum), 1e-20f);
  return power_of_cosine(dot(apart, apart), p);
}

LIMN_FN vec3 banks_response(MaterialModel m, vec3 v, vec3 l) {
  float lobe = (m.options & model_option_printed) != 0u ? banks_printed_lobe(m.exponent, v, l)
                                                        : banks_cone_lobe(m.exponent, v, l);
  return (m.kd * banks_sine(l) + m.ks * lobe) * l.z;
}

// int cos^p over the angles from -pi/2 to pi/2, sqrt(pi) Gamma((p + 1) / 2) / Gamma(p / 2 + 1), by the asymptotic series at
// p + 4, within 1e-5.
LIMN_FN float cosine_power_integral(float p) {
  float q = p + 4.5f;
  float above = sqrt(2.0f * pi / (q + 1.0f / (8.0f * q + 4.5f / q)));
  return above * (p + 4.0f) * (p + 2.0f) / ((p + 3.0f) * (p + 1.0f));
}

// The most that the lobe reflects per unit of ks.
LIMN_FN float banks_lobe_integral(MaterialModel m) {
  return min(2.0f * sqrt(2.0f * pi / max(m.exponent, 1e-6f)), pi);
}

// The most light that is reflected, over what arrives, in the channel that reflects most: kd and ks are to be divided by it where
// it is above 1.
LIMN_FN float banks_excess(MaterialModel m) {
  return largest_channel(banks_diffuse_integral * m.kd + banks_lobe_integral(m) * m.ks);
}

// The exponent with which the cone is sampled: n'.h has half the angle to it.
LIMN_FN float banks_sampled_exponent(MaterialModel m) {
  return (m.options & model_option_printed) != 0u ? 0.25f * m.exponent : m.exponent;
}

LIMN_FN float banks_share(MaterialModel m) {
  return min(model_lobe_share(banks_lobe_integral(m) * largest_channel(m.ks),
                              banks_diffuse_integral * largest_channel(m.kd)),
             0.9f);
}

// The cone's latitude about t is turned by an angle d with density cos^p d, which is how the directions of a power lobe lie about
// any axis across its own; the longitude has the density sin / 2, most of it above the surface.
LIMN_FN vec3 banks_sample(MaterialModel m, vec3 v, vec3 u) {
  float share = banks_share(m);
  if (u.z >= share) return sample_cosine(vec2(u));
  vec3 lobe = sample_power_lobe(banks_sampled_exponent(m), vec2(u));
  vec2 turn = vec2(lobe.x, lobe.z) / max(length(vec2(lobe.x, lobe.z)), 1e-20f);  // sine, cosine of d
  float sine_v = banks_sine(v);
  float along = sine_v * turn.x - v.x * turn.y;
  float across = sine_v * turn.y + v.x * turn.x;
  float y = 1.0f - 2.0f * u.z / share;
  return normalize(vec3(along, across * y, across * sqrt(max(1.0f - y * y, 0.0f))));
}

LIMN_FN float banks_pdf(MaterialModel m, vec3 v, vec3 l) {
  float share = banks_share(m);
  float p = banks_sampled_exponent(m);
  float sine = banks_sine(l);
  float cone = banks_cone_lobe(p, v, l) * l.z / (2.0f * cosine_power_integral(p) * max(sine * sine, 1e-30f));
  return (1.0f - share) * cosine_pdf(l.z) + share * cone;
}

// Hemispherical reflectance of kd alone.
LIMN_FN vec3 banks_diffuse_albedo(MaterialModel m) { return min(banks_diffuse_integral * m.kd, vec3(1.0f)); }

// Hemispherical reflectance. A narrow lobe of Stalling et al. reflects twice its integral times 1 - (v.t)^2, of which the mean is
// 3/4. The printed one is narrow both ways, and its reflectance is a fit, within 3 %.
LIMN_FN vec3 banks_albedo(MaterialModel m) {
  float lobe = (m.options & model_option_printed) != 0u
                   ? pi / (1.0f + 0.2125f * m.exponent)
                   : min(1.5f * cosine_power_integral(m.exponent), banks_lobe_integral(m));
  return min(banks_diffuse_integral * m.kd + lobe * m.ks, vec3(1.0f));
}

LIMN_END
#endif  // LIMN_BANKS_GLSL
