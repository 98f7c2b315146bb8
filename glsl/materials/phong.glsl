// Phong's lobe about the mirror direction r, f cos(l) = ks (p + 1) / (2 pi) (r.l)^p, over a diffuse floor. ks is the albedo of
// the whole lobe, of which what lies below the horizon is lost: at n.v = 0 half of it. At most kd + ks is reflected. f itself
// grows without bound towards n.l = 0 and is not reciprocal. Local frame; arguments: as model_response() and its companions
// have them.
#ifndef LIMN_PHONG_GLSL
#define LIMN_PHONG_GLSL
#include "glsl/materials/material_model.glsl"
#include "glsl/materials/power_lobe.glsl"
#include "glsl/numeric/geometry.glsl"
LIMN_BEGIN

LIMN_FN vec3 phong_mirror(vec3 v) { return vec3(-v.x, -v.y, v.z); }

// Density of the lobe, 1/sr.
LIMN_FN float phong_lobe(float p, vec3 v, vec3 l) {
  vec3 apart = l - phong_mirror(v);
  return (p + 1.0f) * (0.5f * inverse_pi) * power_of_cosine(dot(apart, apart), p);
}

LIMN_FN vec3 phong_response(MaterialModel m, vec3 v, vec3 l) {
  return m.kd * (inverse_pi * l.z) + m.ks * phong_lobe(m.exponent, v, l);
}

LIMN_FN float phong_share(MaterialModel m) { return model_lobe_share(largest_channel(m.ks), largest_channel(m.kd)); }

LIMN_FN vec3 phong_sample(MaterialModel m, vec3 v, vec3 u) {
  if (u.z >= phong_share(m)) return sample_cosine(vec2(u));
  return normalize(from_local(frame_around(phong_mirror(v)), sample_power_lobe(m.exponent, vec2(u))));
}

LIMN_FN float phong_pdf(MaterialModel m, vec3 v, vec3 l) {
  float share = phong_share(m);
  return (1.0f - share) * cosine_pdf(l.z) + share * phong_lobe(m.exponent, v, l);
}

// Hemispherical reflectance: of the lobe 1 / (2 p + 4) is lost below the horizon, which is exact at p = 1 and for large p.
LIMN_FN vec3 phong_albedo(MaterialModel m) {
  return min(m.kd + m.ks * (1.0f - 0.5f / (m.exponent + 2.0f)), vec3(1.0f));
}

LIMN_END
#endif  // LIMN_PHONG_GLSL
