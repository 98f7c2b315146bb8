// Points of a plane along rays from the eye, and from them the estimator of light below surfaces: a point drawn in the plane
// that touches a surface stands for the place where the ray through it meets what the camera sees. All places are from the eye.
#ifndef LIMN_DIFFUSION_EYE_PLANE_GLSL
#define LIMN_DIFFUSION_EYE_PLANE_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Planes seen at a smaller cosine are turned to this one: their texel's surface is farther away than its neighbours tell.
LIMN_CONST float eye_plane_least_cosine = 1e-3f;
// A ray that would have to go on for so many times the way to the drawn point does not meet the plane.
LIMN_CONST float eye_plane_most_stretch = 1e3f;

// The plane through `place` with that unit normal, on the eye's side, as the vector m for which dot(m, p) = 1 for all its points.
LIMN_FN vec3 eye_plane(vec3 place, vec3 normal) {
  float d = length(place);
  vec3 away = place / d;
  float lacking = max(eye_plane_least_cosine + dot(normal, away), 0.0f);
  vec3 n = normal - lacking * away;
  return n / (dot(n, away) * d);
}

// The factor at which `towards` ends on the plane; 0: not in front of the eye, or too far.
LIMN_FN float eye_plane_stretch(vec3 plane, vec3 towards) {
  float inverse = dot(plane, towards);
  return inverse > 1.0f / eye_plane_most_stretch ? 1.0f / inverse : 0.0f;
}

// Area of the plane within a narrow cone of rays, relative to other planes that are stretched to along the same `towards`.
// With m it is cos^-1 d^2 without an angle: stretch^3 |m|.
LIMN_FN float eye_plane_area(vec3 plane, float stretch) { return stretch * stretch * stretch * length(plane); }

// Distance between two places of which one is `towards` times `stretch`. `offset`: from the other one to `towards`. It keeps the
// digits of offsets that are short beside the way from the eye.
LIMN_FN float eye_plane_distance(vec3 offset, vec3 towards, float stretch) {
  return length(offset + (stretch - 1.0f) * towards);
}

LIMN_END
#endif  // LIMN_DIFFUSION_EYE_PLANE_GLSL
