// The penumbra kernel of percentage-closer soft shadows by point samples (Fernando 2005, steps 3 and 4).
//
// Define PATTERN, SEARCH: see glsl/shadow/blocker_samples.glsl.
#ifndef LIMN_FILTER_SAMPLES_GLSL
#define LIMN_FILTER_SAMPLES_GLSL
#include "glsl/shadow/blocker_samples.glsl"

// The lit share of `wanted` samples of the kernel `gap` metres before the receiver, on the plane of the mean blocker.
float samples_lit(inout ShadowCursor cursor, VisibilityQuery q, float gap, int wanted, vec2 shift) {
  LightView part = light_view_part(q.light);
  vec3 rise = light_view_rise(part);
  MapKernel rays = sample_rays(cursor, q, part);
  MapBox box = map_box(cursor.view, rays, gap);
  SamplePoints points = sample_points(wanted, shift);
  float lit = 0.0;
  float total = 0.0;
  int count = sample_count(wanted);
  for (int i = 0; i < count; ++i) {
    vec2 p;
    bool counts = light_view_choose(part, rise, next_sample(points), p);
#if !ONE_VIEW
    for (uint face = face_of_light_point(q, part, p, gap); counts && face != cursor.face;) {
      cursor = shadow_cursor_at(q, face);
      rays = sample_rays(cursor, q, part);
    }
#endif
    vec2 place = axis_along_view() ? map_box_texel(box, p) : map_texel(cursor.view, map_kernel_point(rays, p, gap));
    ShadowTap tap = shadow_tap_at(cursor, place);
    total += counts ? 1.0 : 0.0;
    lit += counts && !tap.blocked ? 1.0 : 0.0;
  }
  return total > 0.0 ? lit / total : 1.0;
}

#endif  // LIMN_FILTER_SAMPLES_GLSL
