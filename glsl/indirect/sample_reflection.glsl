// How surfaces reflect illumination samples.
#ifndef LIMN_SAMPLE_REFLECTION_GLSL
#define LIMN_SAMPLE_REFLECTION_GLSL
#include "glsl/indirect/illumination_sample.glsl"
#include "glsl/light/ltc.glsl"
#include "glsl/light/unshadowed_light.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/surface/brdf.glsl"
#include "glsl/surface/reflectance.glsl"
LIMN_BEGIN

// Share of diffuse light that the diffuse part reflects: its albedo, less what the dielectric layer keeps on the mean.
LIMN_FN vec3 diffuse_albedo(SurfaceBrdf s) {
  return s.diffuse * (1.0f - mix(s.dielectric_f0, s.dielectric_f90, mean_schlick_weight));
}

// What a widened lobe would have to be multiplied by to keep its energy: wider lobes lose more behind the horizon and to
// masking.
LIMN_FN vec3 widened_energy(SurfaceBrdf s, float alpha, float n_dot_l) {
  if (alpha < 1.02f * s.alpha) return vec3(1.0f);
  vec3 before = ltc_specular_reflectance(s, ltc_lookup(n_dot_l, s.alpha));
  vec3 after = ltc_specular_reflectance(s, ltc_lookup(n_dot_l, alpha));
  return before / max(after, vec3(1e-6f));
}

// f(v, l) of the specular part with a lobe of width alpha.
LIMN_FN vec3 specular_lobe(SurfaceBrdf s, float alpha, vec3 n, vec3 v, vec3 l) {
  SurfaceBrdf widened = s;
  widened.alpha = alpha;
  return brdf_parts(widened, n, v, l).specular;
}

// Radiance, W/(sr m^2), that the specular part sends towards v of one light.
LIMN_FN vec3 reflected_specular(SurfaceBrdf s, vec3 n, vec3 v, IncidentLight light, float widen) {
  float n_dot_l = dot(n, light.direction);
  if (!(n_dot_l > 0.0f)) return vec3(0.0f);
  float alpha = widened_alpha(s.alpha, light.spread, n_dot_l, widen);
  return specular_lobe(s, alpha, n, v, light.direction) * widened_energy(s, alpha, n_dot_l) * light.irradiance * n_dot_l;
}

// The sender as a rectangle, seen from x.
LIMN_FN Rectangle sender_rectangle(SampleSender s, vec3 x) {
  Rectangle r;
  r.centre = s.position - x;
  r.u = s.side;
  r.v = s.area / dot(s.side, s.side) * cross(vertex_unpack_normal(s.normal), s.side);
  return r;
}

// Of a sender's size: points lie as far behind it by rounding, or because elements are flat, and are taken to lie as far
// before it at least.
LIMN_CONST float sender_tolerance = 0.02f;
LIMN_CONST float sender_gap = 1e-3f;

// Radiance, W/(sr m^2), that the specular part at x sends towards v of the whole extent of a sample's sender, as far as it
// lies above the horizons of n and of the geometric normal, by linearly transformed cosines. `radiance`: g.
LIMN_FN vec3 reflected_extent(SurfaceBrdf s, vec3 x, vec3 n, vec3 geometric, vec3 v, SampleSender from, vec3 radiance) {
  vec3 normal = vertex_unpack_normal(from.normal);
  float size = sqrt(from.area);
  float height = dot(x - from.position, normal);
  if (!(height > -sender_tolerance * size)) return vec3(0.0f);
  vec3 at = x + max(sender_gap * size - height, 0.0f) * normal;
  return radiance * unshadowed_rectangle_parts(sender_rectangle(from, at), s, n, geometric, v).lobe;
}

LIMN_END
#endif  // LIMN_SAMPLE_REFLECTION_GLSL
