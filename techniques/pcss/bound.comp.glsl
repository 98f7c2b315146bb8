// The bound of percentage-closer soft shadows: the texels and the decisions of visibility.comp.glsl, with what a pixel fixes
// worked out once for it. One view sees all of the light, which is a rectangle.
//
// PATTERN, SEARCH: see glsl/shadow/sample_taps.glsl.
#include "glsl/shadow/filter_taps.glsl"
#include "glsl/shadow/visibility_main.glsl"

uniform int filter_samples;

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  LightView part = light_view_part(q.light);
  vec3 rises = light_view_rise(part);
  MapKernel rays = map_kernel_across(cursor.view, part, q.position);
  MapTest test = map_test(cursor);
  float gap = mean_gap(cursor, q, test, rays, rises, pixel_noise(uint(pixel.x), uint(pixel.y), 0u));
  if (gap <= 0.0) return gap < 0.0 ? 0.0 : 1.0;
  return taps_lit(cursor, test, rays, rises, gap, filter_samples, pixel_noise(uint(pixel.x), uint(pixel.y), 1u).xy);
}
