// L_u: what one unoccluded light adds to the radiance leaving a surface point, for every type of light.
//
// Point, spot and directional lights: the BRDF itself (a directional light's angular diameter is left to V).
// A rectangle, distant or not: the Lambertian part by the exact irradiance, the glossy part by linearly transformed cosines
// (glsl/light/ltc.glsl). Fresnel's term in both is taken at the half vector to the mean direction of the light
// received and goes over into its mean over all directions as the light fills the lobe. Errors against
// integration are stated in tests/unit/glsl/unshadowed_light_test.cpp.
//
// Light from below the geometric tangent plane never arrives, whatever a normal map says; light from below
// the shading normal's horizon is not reflected.
#ifndef LIMN_UNSHADOWED_LIGHT_GLSL
#define LIMN_UNSHADOWED_LIGHT_GLSL
#include "glsl/surface/brdf.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/scene/light.glsl"
#include "glsl/light/ltc.glsl"
#include "glsl/light/rectangle_light.glsl"
#include "glsl/surface/reflected_parts.glsl"
LIMN_BEGIN

LIMN_FN vec3 unit_or(vec3 v, vec3 otherwise) {
  float size = length(v);
  return size > 0.0f ? v / size : otherwise;
}

// Unit vector from p to a light's centre, or against a directional light; 0 where p is the centre.
LIMN_FN vec3 punctual_direction(Light light, vec3 p) {
  vec3 offset = light.position - p;
  if (light.type == light_directional) offset = -light.direction;
  return unit_or(offset, vec3(0.0f));
}

// Reflected radiance per unit of the rectangle's radiance; v: to the viewer.
LIMN_FN ReflectedParts unshadowed_rectangle_parts(Rectangle r, SurfaceBrdf s, vec3 n, vec3 ng, vec3 v) {
  ReflectedParts light;
  light.diffuse = vec3(0.0f);
  light.lobe = vec3(0.0f);
  RectanglePart part = rectangle_part_above(r, rectangle_above(r, ng), n);
  if (part.count == 0) return light;
  vec3 towards = rectangle_vector_irradiance(r, part);
  float irradiance = dot(towards, n);
  if (irradiance < 0.0f) {  // seen from the back of a two-sided light
    towards = -towards;
    irradiance = -irradiance;
  }
  light.diffuse = s.diffuse * (inverse_pi * min(irradiance, pi));
  if (brdf_is_lambertian(s)) return light;
  LtcTerms terms = ltc_lookup(dot(n, v), s.alpha);
  float weight = brdf_diffuse_weight(s, half_vector(n, v, unit_or(towards, n)).v_dot_h);
  light.diffuse *= mix(weight, ltc_diffuse_weight(s, terms), inverse_pi * min(irradiance, pi));

  LtcIntegral glossy = ltc_rectangle(ltc_transform(terms, n, v, s.alpha), terms, r, part);
  float schlick = schlick_weight(half_vector(n, v, unit_or(glossy.mean, n)).v_dot_h);
  float total = terms.reflectance.x + terms.reflectance.y;
  schlick = mix(schlick, terms.reflectance.y / total, glossy.share);
  light.lobe = glossy.share * total * mix(s.f0, vec3(s.f90), schlick);
  return light;
}

LIMN_FN vec3 unshadowed_rectangle(Rectangle r, SurfaceBrdf s, vec3 n, vec3 ng, vec3 v) {
  return reflected_whole(unshadowed_rectangle_parts(r, s, n, ng, v));
}

// p: the point; n: shading normal; ng: geometric normal on the viewer's side; v: unit, to the viewer.
// Result in W/(sr m^2).
LIMN_FN vec3 unshadowed_light(Light light, SurfaceBrdf s, vec3 p, vec3 n, vec3 ng, vec3 v) {
  bool distant = light_is_distant_rectangle(light) && (light.flags & light_flag_centre) == 0u;
  if (light.type == light_rectangle || distant) {
    if (!rectangle_emits_towards(light, p)) return vec3(0.0f);
    float factor = receiver_factor(light, p);
    if (factor == 0.0f) return vec3(0.0f);
    return rectangle_radiance(light) * (factor * unshadowed_rectangle(rectangle_from(light, p), s, n, ng, v));
  }
  vec3 l = punctual_direction(light, p);
  float cosine = dot(n, l);
  if (cosine <= 0.0f || dot(ng, l) <= 0.0f) return vec3(0.0f);
  return brdf(s, n, v, l) * punctual_irradiance(light, p) * cosine;
}

LIMN_END
#endif  // LIMN_UNSHADOWED_LIGHT_GLSL
