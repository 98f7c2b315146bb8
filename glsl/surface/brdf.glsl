// The one BRDF: glTF 2.0 metallic-roughness (specification, appendix B) with KHR_materials_ior and
// KHR_materials_specular. GGX distribution, height-correlated Smith shadowing, Schlick's Fresnel, Lambert
// diffuse weighted by what the dielectric's Fresnel term leaves.
//
// Directions v (to the viewer) and l (to the light) are unit and point away from the surface. A surface with
// metallic 0 and specularFactor 0 is Lambertian whatever its roughness.
//
// Energy in a uniform environment: the specular part alone never exceeds 1 (and loses what single scattering
// loses, 69 % at alpha = 1). The whole model inherits appendix B's imbalance: diffuse and specular are mixed by
// the Fresnel term at the half vector, so a white dielectric returns at most 1.01 at n.v >= 0.8, but up to 1.88
// where a smooth one is seen at grazing angles.
#ifndef LIMN_BRDF_GLSL
#define LIMN_BRDF_GLSL
#include "glsl/numeric/geometry.glsl"
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// alpha = roughness^2 is clamped here: single precision resolves the peak of D, and a highlight stays wider
// than the spacing of octahedral 16-bit normals. Reached at roughness 0.0316.
LIMN_CONST float brdf_min_alpha = 1e-3f;
// n.v is clamped here: shading normals may turn away from the viewer.
LIMN_CONST float brdf_min_cosine = 1e-4f;

struct SurfaceBrdf {
  vec3 diffuse;         // albedo of the Lambertian part: base colour * (1 - metallic)
  float alpha;          // GGX width
  vec3 f0;              // specular reflectance at normal incidence
  float f90;            // and at grazing incidence
  float dielectric_f0;  // the dielectric layer's own, largest channel: what weights the diffuse part
  float dielectric_f90;
};

// Parameters as glTF has them: linear base colour, metallic, perceptual roughness, specularFactor,
// specularColorFactor, index of refraction.
LIMN_FN SurfaceBrdf surface_brdf(vec3 base_colour, float metallic, float roughness, float specular_factor,
                                 vec3 specular_colour, float ior) {
  float ratio = (ior - 1.0f) / (ior + 1.0f);
  vec3 dielectric = min(ratio * ratio * specular_colour, vec3(1.0f)) * specular_factor;
  SurfaceBrdf s;
  s.diffuse = base_colour * (1.0f - metallic);
  s.alpha = max(roughness * roughness, brdf_min_alpha);
  s.f0 = mix(dielectric, base_colour, metallic);
  s.f90 = mix(specular_factor, 1.0f, metallic);
  s.dielectric_f0 = max(dielectric.x, max(dielectric.y, dielectric.z));
  s.dielectric_f90 = specular_factor;
  return s;
}

// Whether the surface has no specular part at all.
LIMN_FN bool brdf_is_lambertian(SurfaceBrdf s) {
  return s.f90 == 0.0f && s.f0 == vec3(0.0f);
}

// Schlick's weight (1 - cosine)^5.
LIMN_FN float schlick_weight(float cosine) {
  float m = clamp(1.0f - cosine, 0.0f, 1.0f);
  float m2 = m * m;
  return m2 * m2 * m;
}

// GGX distribution of normals (1/sr) from the cosine and the squared sine of the angle to n (both, since
// either alone loses precision somewhere). Walter et al. 2007, equation 33.
LIMN_FN float ggx_distribution(float cosine, float sine2, float alpha) {
  float a2 = alpha * alpha;
  float q = a2 * cosine * cosine + sine2;
  return cosine > 0.0f ? a2 / (pi * q * q) : 0.0f;
}

// Height-correlated Smith masking-shadowing over 4 n.l n.v (Heitz 2014, equation 99).
LIMN_FN float ggx_visibility(float n_dot_v, float n_dot_l, float alpha) {
  float a2 = alpha * alpha;
  float from_v = n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0f - a2) + a2);
  float from_l = n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0f - a2) + a2);
  return 0.5f / max(from_v + from_l, 1e-20f);
}

// Smith masking of one direction, G1 in [0, 1].
LIMN_FN float ggx_masking(float cosine, float alpha) {
  float a2 = alpha * alpha;
  return 2.0f * cosine / (cosine + sqrt(cosine * cosine * (1.0f - a2) + a2));
}

// Half vector of v and l and what depends on it.
struct HalfVector {
  vec3 h;         // unit
  float n_dot_h;  // not negative
  float sine2;    // squared sine of the angle between n and h
  float v_dot_h;
};

LIMN_FN HalfVector half_vector(vec3 n, vec3 v, vec3 l) {
  HalfVector r;
  vec3 sum = v + l;
  float size = length(sum);
  r.h = size > 1e-6f ? sum / size : n;
  r.n_dot_h = max(dot(n, r.h), 0.0f);
  vec3 across = cross(n, r.h);
  r.sine2 = dot(across, across);
  r.v_dot_h = clamp(dot(v, r.h), 0.0f, 1.0f);
  return r;
}

// Diffuse part over 1/pi and albedo: what Fresnel leaves, in [0, 1].
LIMN_FN float brdf_diffuse_weight(SurfaceBrdf s, float v_dot_h) {
  return 1.0f - mix(s.dielectric_f0, s.dielectric_f90, schlick_weight(v_dot_h));
}

// f(v, l) in 1/sr, in its parts.
struct BrdfParts {
  float diffuse;  // per unit of the diffuse albedo
  vec3 specular;
};

LIMN_FN BrdfParts brdf_parts(SurfaceBrdf s, vec3 n, vec3 v, vec3 l) {
  BrdfParts parts;
  float n_dot_l = dot(n, l);
  float n_dot_v = max(dot(n, v), brdf_min_cosine);
  HalfVector half_way = half_vector(n, v, l);
  vec3 fresnel = mix(s.f0, vec3(s.f90), schlick_weight(half_way.v_dot_h));
  float lobe =
      ggx_distribution(half_way.n_dot_h, half_way.sine2, s.alpha) * ggx_visibility(n_dot_v, n_dot_l, s.alpha);
  parts.diffuse = inverse_pi * brdf_diffuse_weight(s, half_way.v_dot_h);
  parts.specular = fresnel * lobe;
  return parts;
}

// f(v, l) in 1/sr, without the cosine; 0 where n.l <= 0. Reciprocal where both directions are above the
// surface.
LIMN_FN vec3 brdf(SurfaceBrdf s, vec3 n, vec3 v, vec3 l) {
  if (!(dot(n, l) > 0.0f)) return vec3(0.0f);
  if (brdf_is_lambertian(s)) return s.diffuse * inverse_pi;
  BrdfParts parts = brdf_parts(s, n, v, l);
  return s.diffuse * parts.diffuse + parts.specular;
}

// Probability of choosing the specular lobe: its share of the reflectance at n.v, 0 or 1 where one part is
// absent (and 0 where v lies below the horizon of n, from where no normals are visible).
LIMN_FN float brdf_specular_probability(SurfaceBrdf s, float n_dot_v) {
  if (brdf_is_lambertian(s) || n_dot_v < brdf_min_cosine) return 0.0f;
  float weight = schlick_weight(n_dot_v);
  vec3 fresnel = mix(s.f0, vec3(s.f90), weight);
  float specular = max(fresnel.x, max(fresnel.y, fresnel.z));
  float diffuse = max(s.diffuse.x, max(s.diffuse.y, s.diffuse.z));
  if (diffuse == 0.0f) return 1.0f;
  return clamp(specular / (specular + diffuse), 0.1f, 0.9f);
}

// Density (1/sr) with which brdf_sample chooses l.
LIMN_FN float brdf_pdf(SurfaceBrdf s, vec3 n, vec3 v, vec3 l) {
  float n_dot_l = dot(n, l);
  if (!(n_dot_l > 0.0f)) return 0.0f;
  float n_dot_v = dot(n, v);
  float probability = brdf_specular_probability(s, n_dot_v);
  float pdf = (1.0f - probability) * cosine_pdf(n_dot_l);
  if (probability > 0.0f) {
    HalfVector half_way = half_vector(n, v, l);
    // The Jacobian of reflection 1 / (4 v.h) cancels the v.h of the density of visible normals.
    pdf += probability * ggx_masking(n_dot_v, s.alpha) *
           ggx_distribution(half_way.n_dot_h, half_way.sine2, s.alpha) / (4.0f * n_dot_v);
  }
  return pdf;
}

// A direction l with density brdf_pdf, from u in [0, 1)^3. It may lie below the horizon (density 0: such a
// sample carries nothing).
LIMN_FN vec3 brdf_sample(SurfaceBrdf s, vec3 n, vec3 v, vec3 u) {
  Frame frame = frame_around(n);
  vec3 local = to_local(frame, v);
  if (u.z >= brdf_specular_probability(s, local.z)) return from_local(frame, sample_cosine(vec2(u.x, u.y)));
  vec3 h = sample_visible_normal(local, vec2(s.alpha), vec2(u.x, u.y));
  return normalize(from_local(frame, 2.0f * dot(local, h) * h - local));
}

LIMN_END
#endif  // LIMN_BRDF_GLSL
