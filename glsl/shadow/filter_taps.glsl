// The samples of glsl/shadow/filter_samples.glsl with what a pixel fixes worked out once for it, which bounds measure.
//
// Define PATTERN, SEARCH: see glsl/shadow/sample_taps.glsl.
#ifndef LIMN_FILTER_TAPS_GLSL
#define LIMN_FILTER_TAPS_GLSL
#include "glsl/shadow/sample_taps.glsl"

// The lit share of `wanted` samples of the kernel on the plane of the mean blocker.
float taps_lit(ShadowCursor cursor, MapTest test, MapKernel rays, vec3 rises, float gap, int wanted, vec2 shift) {
  Lattice points = lattice(wanted, shift);
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

#endif  // LIMN_FILTER_TAPS_GLSL
