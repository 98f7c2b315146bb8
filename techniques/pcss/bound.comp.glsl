// The bound of percentage-closer soft shadows: the texels and the decisions of visibility.comp.glsl, with what a pixel fixes
// worked out once for it. One view sees all of the light, which is a rectangle.
//
// PATTERN, SEARCH: see glsl/shadow/sample_taps.glsl.
#include "glsl/shadow/sample_taps.glsl"
#include "glsl/shadow/visibility_main.glsl"

uniform int filter_samples;

// The lit share of the samples of the kernel on the plane of the mean blocker.
float lit_share(ShadowCursor cursor, MapTest test, MapKernel rays, vec3 rises, float gap, vec2 shift) {
  Lattice points = lattice(filter_samples, shift);
  vec3 rise = of_numbers(points, rises);
  Places places = places_at(cursor, points, rays, gap);
  float lit = 0.0;
  float total = 0.0;
  for (int i = 0; i < points.count; ++i) {
    vec2 number = next_number(points);
    Tap tap = tap_at(cursor, test, vec2(affine(places.x, number), affine(places.y, number)));
    bool counts = affine(rise, number) > 0.0;
    total += counts ? 1.0 : 0.0;
    lit += counts && !tap.blocks ? 1.0 : 0.0;
  }
  return total > 0.0 ? lit / total : 1.0;
}

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  LightView part = light_view_part(q.light);
  vec3 rises = light_view_rise(part);
  MapKernel rays = map_kernel_across(cursor.view, part, q.position);
  MapTest test = map_test(cursor);
  float gap = mean_gap(cursor, q, test, rays, rises, pixel_noise(uint(pixel.x), uint(pixel.y), 0u));
  if (gap <= 0.0) return gap < 0.0 ? 0.0 : 1.0;
  return lit_share(cursor, test, rays, rises, gap, pixel_noise(uint(pixel.x), uint(pixel.y), 1u).xy);
}
