// Percentage-closer soft shadows (Fernando 2005).
//
// A sample is a point of the light. The ray from the receiver to it crosses a plane at depth z in a point of the kernel
// whose width is S (d - z) / d there; the map texel in that point's direction is tested. So the kernels w_i and w_p of
// the soft-shadow framework hold for every projection and across the faces of a cube, and only the part of the light
// above the receiver's tangent plane is sampled.
//
// PATTERN, SEARCH: see glsl/shadow/blocker_samples.glsl.
#include "glsl/shadow/blocker_samples.glsl"
#include "glsl/shadow/visibility_main.glsl"

uniform int filter_samples;

// Steps 3 and 4: the lit share of the samples of the kernel on the plane of the mean blocker.
float filtered(inout ShadowCursor cursor, VisibilityQuery q, float gap, vec2 shift) {
  LightView part = light_view_part(q.light);
  vec3 rise = light_view_rise(part);
  MapKernel rays = sample_rays(cursor, q, part);
  MapBox box = map_box(cursor.view, rays, gap);
  SamplePoints points = sample_points(filter_samples, shift);
  float lit = 0.0;
  float total = 0.0;
  int count = sample_count(filter_samples);
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

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  float gap = blocker_gap(cursor, q, pixel_noise(uint(pixel.x), uint(pixel.y), 0u));
  if (gap <= 0.0) return gap < 0.0 ? 0.0 : 1.0;
  return filtered(cursor, q, gap, pixel_noise(uint(pixel.x), uint(pixel.y), 1u).xy);
}
