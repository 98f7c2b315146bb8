// Measured reflectance: tables of f, 1/sr, whose values lie one after another in Scene::measured. Local frame: n = +z, t = +x.
//
// An isotropic table lies over the half and difference angles (Rusinkiewicz 1998, A New Change of Variables for Efficient BRDF
// Representation): node (i, j, k) of n x m x p stands at theta_h = pi/2 (i/n)^2, theta_d = pi/2 (j/m) and phi_d = pi (k/p), k
// varying fastest. f is trilinear in i, j and k, periodic in k, and constant beyond the last node in the others.
//
// A table over pairs of directions (model_option_pairs) has both on squares of n x n texels: the hemisphere is projected from
// the lower pole, p = d.xy / (1 + d.z), and its disc stretched along rays from the centre, s = p |p| / max(|p.x|, |p.y|). Texel
// i stands at s = (2 i + 1) / n - 1; l.x varies fastest, then l.y, v.x and v.y. f is linear in the four coordinates, and
// constant from the outermost texel to the edge, which is the horizon.
#ifndef LIMN_MEASURED_GLSL
#define LIMN_MEASURED_GLSL
#include "glsl/materials/microfacet.glsl"
LIMN_BEGIN

// Where a table begins, and its value i.
#ifdef __cplusplus
using MeasuredTable = const vec3*;
LIMN_FN vec3 measured_value(MeasuredTable table, uint i) { return table[i]; }
#else
#define MeasuredTable uint
layout(std430) readonly buffer MeasuredValues { float measured_values[]; };
vec3 measured_value(uint table, uint i) {
  uint first = 3u * (table + i);
  return vec3(measured_values[first], measured_values[first + 1u], measured_values[first + 2u]);
}
#endif

// The sizes n, m and p of a table, at most 1023 each, in one number; of a table over pairs (n, 0, 0).
LIMN_FN uint measured_nodes(uvec3 size) { return size.x | (size.y << 10u) | (size.z << 20u); }
LIMN_FN uvec3 measured_size(uint nodes) { return uvec3(nodes & 1023u, (nodes >> 10u) & 1023u, nodes >> 20u); }

// Two neighbouring nodes and the second one's share.
struct MeasuredBetween {
  uint below;
  uint above;
  float share;
};
LIMN_FN MeasuredBetween measured_clamped(float at, uint count) {
  float inside = clamp(at, 0.0f, float(count - 1u));
  MeasuredBetween b;
  b.below = uint(inside);
  b.above = min(b.below + 1u, count - 1u);
  b.share = inside - float(b.below);
  return b;
}
// On a circle of `count` nodes, for `at` in [0, count].
LIMN_FN MeasuredBetween measured_wrapped(float at, uint count) {
  uint below = uint(at);
  MeasuredBetween b;
  b.below = below % count;
  b.above = (below + 1u) % count;
  b.share = at - float(below);
  return b;
}

// Between two values of a row, and between two rows.
LIMN_FN vec3 measured_row(MeasuredTable table, uint first, MeasuredBetween b) {
  return mix(measured_value(table, first + b.below), measured_value(table, first + b.above), b.share);
}
LIMN_FN vec3 measured_face(MeasuredTable table, uint first, uint width, MeasuredBetween x, MeasuredBetween y) {
  return mix(measured_row(table, first + y.below * width, x), measured_row(table, first + y.above * width, x), y.share);
}

// theta_h and theta_d in [0, pi/2], phi_d in [0, pi): l and v may swap. Where h is the normal, phi_d counts from the tangent.
LIMN_FN vec3 half_difference_angles(vec3 v, vec3 l) {
  vec3 sum = l + v;
  vec3 apart = l - v;
  float across = length(vec2(sum));
  float size = length(sum);
  // The frame at h: t leads away from the normal, b is horizontal.
  vec2 azimuth = across > 0.0f ? vec2(sum) / across : vec2(1.0f, 0.0f);
  float cosine = size > 0.0f ? sum.z / size : 1.0f;
  float sine = size > 0.0f ? across / size : 0.0f;
  vec3 t = vec3(azimuth * cosine, -sine);
  vec3 b = vec3(-azimuth.y, azimuth.x, 0.0f);
  float x = dot(apart, t);
  float y = dot(apart, b);
  float phi = x == 0.0f && y == 0.0f ? 0.0f : atan(y, x);
  if (phi < 0.0f) phi += pi;
  if (phi >= pi) phi = 0.0f;
  return vec3(atan(across, sum.z), atan(length(apart), size), phi);
}

// f of an isotropic table; both directions lie above the horizon.
LIMN_FN vec3 measured_isotropic(MeasuredTable table, uvec3 size, vec3 v, vec3 l) {
  vec3 angles = half_difference_angles(v, l);
  MeasuredBetween h = measured_clamped(sqrt(angles.x * 2.0f * inverse_pi) * float(size.x), size.x);
  MeasuredBetween d = measured_clamped(angles.y * 2.0f * inverse_pi * float(size.y), size.y);
  MeasuredBetween p = measured_wrapped(angles.z * inverse_pi * float(size.z), size.z);
  uint slice = size.y * size.z;
  return mix(measured_face(table, h.below * slice, size.z, p, d), measured_face(table, h.above * slice, size.z, p, d), h.share);
}

// Coordinates on the square of a direction above the horizon, [-1, 1].
LIMN_FN vec2 measured_square(vec3 d) {
  vec2 p = vec2(d) / (1.0f + d.z);
  float longest = max(abs(p.x), abs(p.y));
  return longest > 0.0f ? p * (length(p) / longest) : p;
}
LIMN_FN MeasuredBetween measured_texels(float s, uint size) {
  return measured_clamped((s + 1.0f) * 0.5f * float(size) - 0.5f, size);
}

// f of a table over pairs of directions; both lie above the horizon.
LIMN_FN vec3 measured_pairs(MeasuredTable table, uint size, vec3 v, vec3 l) {
  vec2 from = measured_square(l);
  vec2 to = measured_square(v);
  MeasuredBetween lx = measured_texels(from.x, size);
  MeasuredBetween ly = measured_texels(from.y, size);
  MeasuredBetween vx = measured_texels(to.x, size);
  MeasuredBetween vy = measured_texels(to.y, size);
  uint square = size * size;
  uint below = vy.below * size;
  uint above = vy.above * size;
  vec3 low = mix(measured_face(table, (below + vx.below) * square, size, lx, ly),
                 measured_face(table, (below + vx.above) * square, size, lx, ly), vx.share);
  vec3 high = mix(measured_face(table, (above + vx.below) * square, size, lx, ly),
                  measured_face(table, (above + vx.above) * square, size, lx, ly), vx.share);
  return mix(low, high, vy.share);
}

// ks f cos(l). Reciprocal as far as the table is. Arguments: as model_response() and its companions have them.
LIMN_FN vec3 measured_response(MeasuredTable table, MaterialModel m, vec3 v, vec3 l) {
  if (!(v.z > 0.0f && l.z > 0.0f)) return vec3(0.0f);
  uvec3 size = measured_size(m.nodes);
  vec3 f = (m.options & model_option_pairs) != 0u ? measured_pairs(table, size.x, v, l) : measured_isotropic(table, size, v, l);
  return m.ks * f * l.z;
}

// Samples are half of a lobe of the table's width and half of a cosine, since the table may hold any shape; a table over pairs
// has no lobe that one width would describe.
LIMN_FN float measured_share(MaterialModel m, vec3 v) {
  return v.z > 0.0f && (m.options & model_option_pairs) == 0u ? 0.5f : 0.0f;
}
LIMN_FN vec3 measured_sample(MaterialModel m, vec3 v, vec3 u) {
  return microfacet_or_cosine_sample(measured_share(m, v), vec2(model_alpha(m).x), v, u);
}
LIMN_FN float measured_pdf(MaterialModel m, vec3 v, vec3 l) {
  return microfacet_or_cosine_pdf(measured_share(m, v), vec2(model_alpha(m).x), v, l);
}

// Hemispherical reflectance, with ks in it: core/brdf/measured_model.h integrates it from the table.
LIMN_FN vec3 measured_albedo(MaterialModel m) { return min(m.k, vec3(1.0f)); }

LIMN_END
#endif  // LIMN_MEASURED_GLSL
