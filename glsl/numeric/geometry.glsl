// Frames, basic sample maps and small numeric helpers.
#ifndef LIMN_GEOMETRY_GLSL
#define LIMN_GEOMETRY_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// An orthonormal, right-handed frame; n is its third axis.
struct Frame {
  vec3 t;
  vec3 b;
  vec3 n;
};

// Frame around the unit vector n, continuous except across n.z = 0 (Duff et al. 2017, Building an Orthonormal
// Basis, Revisited, listing 3).
LIMN_FN Frame frame_around(vec3 n) {
  float s = n.z >= 0.0f ? 1.0f : -1.0f;
  float a = -1.0f / (s + n.z);
  float b = n.x * n.y * a;
  Frame f;
  f.t = vec3(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
  f.b = vec3(b, s + n.y * n.y * a, -n.y);
  f.n = n;
  return f;
}

// Frame around n whose t lies in the plane of n and v, on v's side; any tangent where they are parallel.
LIMN_FN Frame frame_towards(vec3 n, vec3 v) {
  vec3 across = cross(n, v);
  float size = length(across);
  if (!(size > 1e-7f)) return frame_around(n);
  Frame f;
  f.b = across / size;
  f.t = cross(f.b, n);
  f.n = n;
  return f;
}

// Frame around n whose t is the part of `along` (any length) that is perpendicular to n; frame_around(n) where there is none.
LIMN_FN Frame frame_along(vec3 n, vec3 along) {
  vec3 across = along - n * dot(n, along);
  float size = length(across);
  if (!(size > 1e-6f * length(along))) return frame_around(n);
  Frame f;
  f.t = across / size;
  f.b = cross(n, f.t);
  f.n = n;
  return f;
}

// The angle from frame_around(n).t to `along` about n, as a part of a whole turn in [0, 1); and the frame of that angle.
LIMN_FN float frame_turn(vec3 n, vec3 along) {
  Frame f = frame_around(n);
  float turn = atan(dot(f.b, along), dot(f.t, along)) * (0.5f * inverse_pi);
  return turn < 0.0f ? turn + 1.0f : turn;
}
LIMN_FN Frame frame_turned(vec3 n, float turn) {
  Frame f = frame_around(n);
  float angle = 2.0f * pi * turn;
  return frame_along(n, cos(angle) * f.t + sin(angle) * f.b);
}

LIMN_FN vec3 to_local(Frame f, vec3 v) {
  return vec3(dot(f.t, v), dot(f.b, v), dot(f.n, v));
}
LIMN_FN vec3 from_local(Frame f, vec3 v) {
  return v.x * f.t + v.y * f.b + v.z * f.n;
}

// The direction v mirrored at the unit vector n: both point away from the surface.
LIMN_FN vec3 mirror_direction(vec3 n, vec3 v) { return 2.0f * dot(n, v) * n - v; }

// Unit square to the unit disc, area-preserving and continuous (Shirley and Chiu 1997).
LIMN_FN vec2 sample_disc(vec2 u) {
  vec2 p = 2.0f * u - vec2(1.0f);
  if (p.x == 0.0f && p.y == 0.0f) return vec2(0.0f);
  bool wide = abs(p.x) > abs(p.y);
  float radius = wide ? p.x : p.y;
  float angle = wide ? 0.25f * pi * (p.y / p.x) : 0.5f * pi - 0.25f * pi * (p.x / p.y);
  return radius * vec2(cos(angle), sin(angle));
}

// Unit square to the hemisphere around +z with density cosine_pdf(direction.z).
LIMN_FN vec3 sample_cosine(vec2 u) {
  vec2 p = sample_disc(u);
  return vec3(p.x, p.y, sqrt(max(0.0f, 1.0f - p.x * p.x - p.y * p.y)));
}
LIMN_FN float cosine_pdf(float cosine) {
  return inverse_pi * max(cosine, 0.0f);
}

// A normal of the GGX distribution with the slopes alpha along x and y as seen from v (n = +z, v.z > 0), from u in [0, 1)^2: its
// density is G1(v) max(v.h, 0) D(h) / n.v. Dupuy and Benyoub 2023, Sampling Visible GGX Normals with Spherical Caps, listing 3.
LIMN_FN vec3 sample_visible_normal(vec3 v, vec2 alpha, vec2 u) {
  vec3 stretched = normalize(vec3(alpha.x * v.x, alpha.y * v.y, v.z));
  float azimuth = 2.0f * pi * u.x;
  float z = (1.0f - u.y) * (1.0f + stretched.z) - stretched.z;
  float radius = sqrt(clamp(1.0f - z * z, 0.0f, 1.0f));
  vec3 h = vec3(radius * cos(azimuth), radius * sin(azimuth), z) + stretched;
  return normalize(vec3(alpha.x * h.x, alpha.y * h.y, max(h.z, 1e-12f)));
}

// The angle in [-pi/2, pi/2] whose sine is x, by atan2, whose relative error does not grow towards 0: GLSL says nothing of asin.
LIMN_FN float arc_sine(float x) { return atan(x, sqrt((1.0f - x) * (1.0f + x))); }

// angle / sin(angle) - 1 for angle in [0, pi) given its sine and cosine, within 7.4e-7 of its value, small angles
// included. Grows without bound towards pi; sine = 0 with a negative cosine gives a large finite number.
//
// With w = tan^2(angle / 2) and cosine >= 0 it is w r(w), r(w) = ((1 + w) atan(sqrt(w)) / sqrt(w) - 1) / w, which a
// polynomial of degree 7 meets within 2.4e-8 on [0, 1] (interpolated at Chebyshev nodes). The angle of a negative cosine
// is pi less an acute one. No branch: software renderers execute both sides.
LIMN_FN float angle_over_sine_minus_one(float sine, float cosine) {
  float half_tangent = sine / (1.0f + abs(cosine));
  float w = half_tangent * half_tangent;
  float low = 0.666666627f + w * (-0.133331314f + w * (0.0570991673f - w * 0.0313753113f));
  float high = 0.018591838f + w * (-0.00991543196f + w * (0.00375377084f - w * 0.000693053065f));
  float w2 = w * w;
  float acute = w * (low + w2 * w2 * high);
  return cosine < 0.0f ? pi / max(sine, 1e-12f) - 2.0f - acute : acute;
}

LIMN_END
#endif  // LIMN_GEOMETRY_GLSL
