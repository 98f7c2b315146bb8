// How bright a fragment of a rasterised light line is (thesis, section 8.3.3, without its free constant): a line element dl
// of flux F scatters the radiant intensity F sigma_s p dl; a pixel's mean radiance is what arrives of it over the pixel's
// solid angle (Z/R)^3 / f^2, and a fragment stands for the piece of line between two columns or rows of pixels.
//
// Camera space here: x right, y up, z depth along the view axis, metres. focal: focal length in pixels.
#ifndef LIMN_CAUSTIC_LINE_GLSL
#define LIMN_CAUSTIC_LINE_GLSL
#include "glsl/numeric/geometry.glsl"
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Metres along origin + l direction to the point whose picture lies on the line dot(axis, (x, y) / z) = dot(axis, slope).
LIMN_FN float caustic_line_position(vec3 origin, vec3 direction, vec2 axis, vec2 slope) {
  float a = dot(axis, slope);
  float rate = dot(axis, vec2(direction.x, direction.y)) - a * direction.z;
  float offset = a * origin.z - dot(axis, vec2(origin.x, origin.y));
  return rate != 0.0f ? offset / rate : 0.0f;
}

// Where the picture of x lies along an axis of the view plane at distance 1.
LIMN_FN float caustic_line_picture(vec3 x, vec2 axis) { return dot(axis, vec2(x.x, x.y)) / x.z; }

// The part of a line's picture between `piece`.x and .y, places along the axis (unit), that belongs to the line and is seen.
// The picture moves forwards on the axis as l grows; range: of l on the line; depth: of what the pixel shows, 0: nothing.
// x >= y: nothing is seen.
LIMN_FN vec2 caustic_line_part(vec3 origin, vec3 direction, vec2 axis, vec2 range, float depth, vec2 piece) {
  bool away = direction.z >= 0.0f;
  vec2 seen = range;
  if (depth > 0.0f) {
    float rate = abs(direction.z) > 1e-20f ? direction.z : 1e-20f;
    float met = clamp((depth - origin.z) / rate, range.x, range.y);
    seen = away ? vec2(range.x, met) : vec2(met, range.y);
  }
  return vec2(max(piece.x, caustic_line_picture(origin + seen.x * direction, axis)),
              min(piece.y, caustic_line_picture(origin + seen.y * direction, axis)));
}

// Movement of the picture of x, in view-plane units, per metre along `direction`; times focal / z: pixels.
LIMN_FN vec2 caustic_line_rate(vec3 x, vec3 direction) {
  return vec2(direction.x - x.x / x.z * direction.z, direction.y - x.y / x.z * direction.z);
}

// Radiance per (flux * sigma_s * p * transmittances) of a fragment at x, 1/m, whose whole piece is seen. rate: of the
// picture along the axis, that is, the largest component of caustic_line_rate where lines have as many fragments as columns
// (or rows), its length where they have as many as pixels of length (rectangles; then also divide by the width in pixels).
LIMN_FN float caustic_line_weight(vec3 x, float rate, float focal) {
  return focal * length(x) / (x.z * x.z * max(rate, 1e-12f));
}

// The same for a whole line that is shorter than a pixel: (int dl / R^2) over the pixel's solid angle; with `span` the
// angle at the eye between the line's ends a and b, int dl / R^2 = (L / (R_a R_b)) span / sin(span).
LIMN_FN float caustic_point_weight(vec3 a, vec3 b, float focal) {
  vec3 middle = 0.5f * (a + b);
  float lengths = max(length(a) * length(b), 1e-30f);
  float ratio = 1.0f + angle_over_sine_minus_one(length(cross(a, b)) / lengths, dot(a, b) / lengths);
  float distance = length(middle);
  float cosine = middle.z / distance;
  float integral = length(b - a) / (length(a) * length(b)) * ratio;
  return integral * focal * focal / (cosine * cosine * cosine);
}

// The place on such a line, as a share of the way from a to b, up to which lies the share u of int dl / R^2: even in 1/R, since
// the angle between a and b is small.
LIMN_FN float caustic_point_node(vec3 a, vec3 b, float u) {
  float from_a = u * length(a);
  return from_a / (from_a + (1.0f - u) * length(b));
}

// One weight for all fragments, 1/m, with which lines in all directions scatter as much as with caustic_line_weight at the
// middle of the picture, `away` metres from the camera. There a metre across the view is focal / away pixels long; in the mean
// of all directions a metre of line has sqrt(1/2) as many columns (or rows), and pi/4 as many pixels of length (rectangles).
LIMN_FN float caustic_even_weight(float away, float focal, bool rectangles) {
  return focal / (away * (rectangles ? 0.25f * pi : 0.70710678f));
}

// The integral of two boxes of unit area and these widths, one after the other (a trapezoid), from the middle to x, times
// the greater width. wide >= narrow >= 0.
LIMN_FN float caustic_trapezoid_part(float wide, float narrow, float x) {
  float level = 0.5f * (wide - narrow);
  float distance = abs(x);
  float slope = clamp(distance - level, 0.0f, narrow);
  float part = min(distance, level) + slope * (1.0f - 0.5f * slope / max(narrow, 1e-20f));
  return x < 0.0f ? -part : part;
}

// How bright a pixel is across a beam, over the beam's flux per pixel of width, 1/pixels: the beam is a parallelogram whose
// sides are a and b pixels wide across its line, and `away` is the pixel's distance from that line. The picture of a
// parallelogram is one box after another, and the pixel's mean another box yet. Of all profiles this one alone lets the beams
// between the points of a lattice add up to the same everywhere.
LIMN_FN float caustic_beam_profile(float a, float b, float away) {
  float wide = max(max(a, b), 1e-3f);
  float narrow = min(a, b);
  float distance = abs(away);
  return (caustic_trapezoid_part(wide, narrow, distance + 0.5f) - caustic_trapezoid_part(wide, narrow, distance - 0.5f)) /
         wide;
}

// A beam as it is drawn: made once for each ray that is one, and read by each of its corners. Storage buffer element.
struct RayBeam {
  vec2 range;       // of the piece that the camera can see, metres along the ray from and to
  float narrowest;  // share of the way between
  float unused;
  vec4 sides;       // u and v at the near end, u and v at the far end: how far they reach across the line in the picture, metres
};

// Where a beam's picture is narrowest, as a share of the way between its ends: u and v reach so far across the line at both ends,
// and change evenly in between, through 0 where they turn over.
LIMN_FN float caustic_beam_narrowest(vec2 u, vec2 v) {
  float at_u = u.x != u.y ? clamp(u.x / (u.x - u.y), 0.0f, 1.0f) : 0.5f;
  float at_v = v.x != v.y ? clamp(v.x / (v.x - v.y), 0.0f, 1.0f) : 0.5f;
  float sum_u = abs(mix(u.x, u.y, at_u)) + abs(mix(v.x, v.y, at_u));
  float sum_v = abs(mix(u.x, u.y, at_v)) + abs(mix(v.x, v.y, at_v));
  return sum_u < sum_v ? at_u : at_v;
}

LIMN_END
#endif  // LIMN_CAUSTIC_LINE_GLSL
