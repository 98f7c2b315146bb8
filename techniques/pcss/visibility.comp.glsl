// Percentage-closer soft shadows (Fernando 2005).
//
// A sample is a point of the light. The ray from the receiver to it crosses a plane at depth z in a point of the kernel
// whose width is S (d - z) / d there; the map texel in that point's direction is tested. So the kernels w_i and w_p of
// the soft-shadow framework hold for every projection and across the faces of a cube, and only the part of the light
// above the receiver's tangent plane is sampled.
//
// PATTERN 0: grid, 1: R2 sequence shifted per pixel. SEARCH 0: at the near plane, 1: through the cone.
#include "glsl/blocker_samples.glsl"
#include "glsl/visibility_main.glsl"

uniform int filter_samples;

// Steps 3 and 4: the lit share of the samples of the kernel on the plane of the mean blocker.
float filtered(inout ShadowCursor cursor, VisibilityQuery q, float gap, vec2 shift) {
  float lit = 0.0;
  float total = 0.0;
  int count = sample_count(filter_samples);
  for (int i = 0; i < count; ++i) {
    vec3 slope;
    if (!light_view_sample(q.light, sample_point(i, filter_samples, shift), slope)) continue;
    total += 1.0;
    if (!shadow_tap(cursor, q, q.position + gap * slope).blocked) lit += 1.0;
  }
  return total > 0.0 ? lit / total : 1.0;
}

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  float gap = blocker_gap(cursor, q, pixel_noise(uint(pixel.x), uint(pixel.y), 0u));
  return gap > 0.0 ? filtered(cursor, q, gap, pixel_noise(uint(pixel.x), uint(pixel.y), 1u).xy) : 1.0;
}
