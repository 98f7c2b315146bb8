// The BRDF of a point that looks one way, for loops over lights: what the direction to the viewer fixes is worked out once, and
// the half vector is never normalised. The same answers as brdf_parts() gives.
#ifndef LIMN_BRDF_VIEW_GLSL
#define LIMN_BRDF_VIEW_GLSL
#include "glsl/numeric/geometry.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/surface/brdf.glsl"
LIMN_BEGIN

struct BrdfView {
  Frame frame;          // around the normal; the viewer lies over its t
  float across;         // the direction to the viewer, along t and n
  float along;
  float n_dot_v;        // at least brdf_min_cosine
  float a2;             // alpha^2
  float masking;        // of the direction to the viewer
  float peak;           // constant factors of the lobe
  vec3 f0;
  vec3 f_rise;          // f90 - f0
  float dielectric;     // 1 - F of the diffuse weight at normal incidence
  float dielectric_fall;
};

// n, v: as brdf_parts() has them.
LIMN_FN BrdfView brdf_view(SurfaceBrdf s, vec3 n, vec3 v) {
  BrdfView b;
  b.frame = frame_towards(n, v);
  b.across = dot(b.frame.t, v);
  b.along = dot(n, v);
  b.n_dot_v = max(b.along, brdf_min_cosine);
  b.a2 = s.alpha * s.alpha;
  b.masking = sqrt(b.n_dot_v * b.n_dot_v * (1.0f - b.a2) + b.a2);
  b.peak = 0.5f * inverse_pi * b.a2;
  b.f0 = s.f0;
  b.f_rise = vec3(s.f90) - s.f0;
  b.dielectric = 1.0f - s.dielectric_f0;
  b.dielectric_fall = s.dielectric_f90 - s.dielectric_f0;
  return b;
}

// brdf_parts() of the unit vector l, n.l > 0. With the sum s = v + l, of length |s|: n.h = n.s / |s|, v.h = |s| / 2.
LIMN_FN BrdfParts brdf_view_parts(BrdfView b, vec3 l) {
  float n_dot_l = dot(b.frame.n, l);
  float sx = dot(b.frame.t, l) + b.across;
  float sy = dot(b.frame.b, l);
  float sz = n_dot_l + b.along;
  float flat2 = sx * sx + sy * sy;
  float s2 = flat2 + sz * sz;
  float weight = schlick_weight(0.5f * sqrt(s2));
  float from_v = n_dot_l * b.masking;
  float from_l = b.n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0f - b.a2) + b.a2);
  float q = b.a2 * sz * sz + flat2;
  // ggx_distribution() ggx_visibility()
  float lobe = b.peak * s2 * s2 / max(q * q * max(from_v + from_l, 1e-20f), 1e-37f);
  BrdfParts parts;
  parts.diffuse = inverse_pi * (b.dielectric - weight * b.dielectric_fall);
  parts.specular = (sz > 0.0f ? lobe : 0.0f) * (b.f0 + weight * b.f_rise);
  return parts;
}

LIMN_END
#endif  // LIMN_BRDF_VIEW_GLSL
