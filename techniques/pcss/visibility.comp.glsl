// Percentage-closer soft shadows (Fernando 2005).
//
// A sample is a point of the light. The ray from the receiver to it crosses a plane at depth z in a point of the kernel
// whose width is S (d - z) / d there; the map texel in that point's direction is tested. So the kernels w_i and w_p of
// the soft-shadow framework hold for every projection and across the faces of a cube, and only the part of the light
// above the receiver's tangent plane is sampled.
//
// PATTERN, SEARCH: see glsl/shadow/blocker_samples.glsl.
#include "glsl/shadow/filter_samples.glsl"
#include "glsl/shadow/visibility_main.glsl"

uniform int filter_samples;

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  float gap = blocker_gap(cursor, q, pixel_noise(uint(pixel.x), uint(pixel.y), 0u));
  if (gap <= 0.0) return gap < 0.0 ? 0.0 : 1.0;
  return samples_lit(cursor, q, gap, filter_samples, pixel_noise(uint(pixel.x), uint(pixel.y), 1u).xy);
}
