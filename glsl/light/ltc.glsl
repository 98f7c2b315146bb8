// Linearly transformed cosines for the glossy part of brdf.glsl (Heitz, Dupuy, Hill and Neubelt 2016,
// Real-Time Polygonal-Light Shading with Linearly Transformed Cosines), and the directional reflectance of
// that part.
//
// The lobe brdf(v, l) n.l with Fresnel term 1 is replaced by amplitude * D(l), D a clamped cosine pushed
// through a linear map M; integrating it over a polygon is integrating the clamped cosine over the polygon
// pushed through M^-1. In the frame (t, b, n) with v in the plane of t and n on the side of +t,
//     M = [X Y Z] [m11 0 0; 0 m22 0; m13 0 1],   Z = (-sin tilt, 0, cos tilt), Y = (0, 1, 0), X = Y x Z.
//
// The table (limn-fit-ltc writes it) has two texels per (roughness, n.v):
//     0: m11 / alpha, m22 / alpha, m13 / sin(theta), tilt / theta        with cos(theta) = n.v
//     1: a, b: reflectance f0 * a + f90 * b in a uniform environment;
//        c: mean of (1 - v.h)^5 over a cosine lobe; d: share of D above the horizon, which is all that counts
// Rows and columns: x = (sqrt(alpha) - sqrt(alpha_min)) / (1 - sqrt(alpha_min)), y = sqrt(n.v), texel centres
// on both ends; every entry is smooth along both, which is what lets so few texels do.
#ifndef LIMN_LTC_GLSL
#define LIMN_LTC_GLSL
#include "glsl/surface/brdf.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/light/rectangle_light.glsl"

// Texel `layer` (0 or 1) at column x (roughness), row y (n.v) of the table: on the CPU from core/shading, in
// GLSL from the 2D array texture ltc_table (RGBA32F, see shading::makeLtcTexture).
#ifdef __cplusplus
#include "core/base/export.h"
namespace limn::glsl {
LIMN_API glm::vec4 ltc_texel(int layer, int x, int y);
}
#endif
LIMN_BEGIN

LIMN_CONST int ltc_size = 32;

#ifndef __cplusplus
uniform sampler2DArray ltc_table;
vec4 ltc_texel(int layer, int x, int y) {
  return texelFetch(ltc_table, ivec3(x, y, layer), 0);
}
#endif

// One surface point's entries.
struct LtcTerms {
  vec4 shape;        // as in texel 0
  vec4 reflectance;  // as in texel 1
};

LIMN_FN vec4 ltc_interpolate(int layer, ivec2 corner, vec2 weight) {
  vec4 low = mix(ltc_texel(layer, corner.x, corner.y), ltc_texel(layer, corner.x + 1, corner.y), weight.x);
  vec4 high =
      mix(ltc_texel(layer, corner.x, corner.y + 1), ltc_texel(layer, corner.x + 1, corner.y + 1), weight.x);
  return mix(low, high, weight.y);
}

LIMN_FN LtcTerms ltc_lookup(float n_dot_v, float alpha) {
  float low = sqrt(brdf_min_alpha);
  vec2 place = vec2((sqrt(alpha) - low) / (1.0f - low), sqrt(clamp(n_dot_v, 0.0f, 1.0f)));
  place = clamp(place, vec2(0.0f), vec2(1.0f)) * float(ltc_size - 1);
  ivec2 corner = min(ivec2(place), ivec2(ltc_size - 2));
  vec2 weight = place - vec2(corner);
  LtcTerms terms;
  terms.shape = ltc_interpolate(0, corner, weight);
  terms.reflectance = ltc_interpolate(1, corner, weight);
  return terms;
}

// Reflectance of the glossy part in a uniform environment: what a split sum multiplies.
LIMN_FN vec3 ltc_specular_reflectance(SurfaceBrdf s, LtcTerms terms) {
  return s.f0 * terms.reflectance.x + vec3(s.f90 * terms.reflectance.y);
}

// Mean over a cosine lobe of what Fresnel leaves to the diffuse part.
LIMN_FN float ltc_diffuse_weight(SurfaceBrdf s, LtcTerms terms) {
  return 1.0f - mix(s.dielectric_f0, s.dielectric_f90, terms.reflectance.z);
}

// M in world space: M p = p.x m11 x + p.y m22 y + (p.x m13 + p.z) z, with x, y, z orthonormal.
struct LtcTransform {
  vec3 x;
  vec3 y;
  vec3 z;
  float m11;
  float m22;
  float m13;
};

LIMN_FN LtcTransform ltc_transform(LtcTerms terms, vec3 n, vec3 v, float alpha) {
  Frame frame = frame_towards(n, v);
  float sine = length(cross(n, v));
  float tilt = terms.shape.w * atan(sine, max(dot(n, v), brdf_min_cosine));
  LtcTransform m;
  m.x = cos(tilt) * frame.t + sin(tilt) * frame.n;
  m.y = frame.b;
  m.z = cos(tilt) * frame.n - sin(tilt) * frame.t;
  m.m11 = terms.shape.x * alpha;
  m.m22 = terms.shape.y * alpha;
  m.m13 = terms.shape.z * sine;
  return m;
}

LIMN_FN vec3 ltc_apply(LtcTransform m, vec3 p) {
  return p.x * m.m11 * m.x + p.y * m.m22 * m.y + (p.x * m.m13 + p.z) * m.z;
}

LIMN_FN vec3 ltc_apply_inverse(LtcTransform m, vec3 p) {
  float x = dot(m.x, p) / m.m11;
  return vec3(x, dot(m.y, p) / m.m22, dot(m.z, p) - m.m13 * x);
}

// Share of the lobe D above the plane through the surface's point with that normal, which is unit: M^-1 pushes planes to planes,
// and above one whose normal is at the angle a to its axis a clamped cosine has the share (1 + cos(a)) / 2.
LIMN_FN float ltc_share_above(LtcTransform m, vec3 normal) {
  float z = dot(m.z, normal);
  return 0.5f + 0.5f * z / length(vec3(m.m11 * dot(m.x, normal) + m.m13 * z, m.m22 * dot(m.y, normal), z));
}

// What the lobe D receives from a rectangle.
struct LtcIntegral {
  float share;  // of the lobe above the horizon that falls on the rectangle, in [0, 1]
  vec3 mean;  // about the mean direction of that light, weighted by the lobe; any length, 0 where share is 0
};

// `above_horizon`: the part of r above the surface's horizon.
LIMN_FN LtcIntegral ltc_rectangle(LtcTransform m, LtcTerms terms, Rectangle r, RectanglePart above_horizon) {
  vec3 lowest = m.z - (m.m13 / m.m11) * m.x;  // the cosine lobe's own horizon
  RectanglePart part = rectangle_part_above(r, above_horizon, lowest);
  Rectangle pushed;
  pushed.centre = ltc_apply_inverse(m, r.centre);
  pushed.u = ltc_apply_inverse(m, r.u);
  pushed.v = ltc_apply_inverse(m, r.v);
  vec3 received = rectangle_vector_irradiance(pushed, part);
  if (received.z < 0.0f) received = -received;
  LtcIntegral result;
  result.share = clamp(inverse_pi * received.z / terms.reflectance.w, 0.0f, 1.0f);
  result.mean = ltc_apply(m, received);
  return result;
}

LIMN_END
#endif  // LIMN_LTC_GLSL
