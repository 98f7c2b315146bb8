// The blocker search of percentage-closer soft shadows by point samples (Fernando 2005, steps 1 and 2).
//
// Define PATTERN 0: grid, 1: R2 sequence shifted per pixel; SEARCH: see glsl/shadow/blocker_reach.glsl.
#ifndef LIMN_BLOCKER_SAMPLES_GLSL
#define LIMN_BLOCKER_SAMPLES_GLSL
#include "glsl/numeric/sampling.glsl"
#include "glsl/shadow/blocker_reach.glsl"
#include "glsl/shadow/visibility.glsl"

uniform int blocker_samples;

// The points of a pattern one after the other.
struct SamplePoints {
#if PATTERN == 0
  int side;
  ivec2 cell;
#else
  uvec2 next;  // in fixed point
#endif
};

SamplePoints sample_points(int count, vec2 shift) {
#if PATTERN == 0
  return SamplePoints(int(sqrt(float(count)) + 1e-3), ivec2(0));
#else
  return SamplePoints(uvec2(fixed_point(shift.x), fixed_point(shift.y)));
#endif
}

vec2 next_sample(inout SamplePoints points) {
#if PATTERN == 0
  vec2 u = (vec2(points.cell) + 0.5) / float(points.side);
  bool row_ends = points.cell.x + 1 == points.side;
  points.cell = row_ends ? ivec2(0, points.cell.y + 1) : points.cell + ivec2(1, 0);
#else
  vec2 u = vec2(fixed_point_value(points.next.x), fixed_point_value(points.next.y));
  points.next += r2_step;
#endif
  return u;
}

int sample_count(int count) {
#if PATTERN == 0
  int side = int(sqrt(float(count)) + 1e-3);
  return side * side;
#else
  return count;
#endif
}

// The rays from the receiver to the counted part of its light, in the cursor's view.
MapKernel sample_rays(ShadowCursor cursor, VisibilityQuery q, LightView part) {
  return axis_along_view() ? map_kernel_across(cursor.view, part, q.position) : map_kernel(cursor.view, part, q.position);
}

// Steps 1 and 2: mean distance from the blockers to the receiver along the light's axis, metres; 0: there are none, V = 1;
// negative: nothing else is there, V = 0.
float blocker_gap(inout ShadowCursor cursor, VisibilityQuery q, vec3 shift) {
  float reach;
  if (!blocker_reach(cursor, q, reach)) return reach;
  LightView part = light_view_part(q.light);
  vec3 rise = light_view_rise(part);
  MapKernel rays = sample_rays(cursor, q, part);
#if SEARCH == 1
  MapCone cone = map_cone(cursor.view, q.light, q.position, cursor.in_map, cursor.receiver.axis);
  uint height = fixed_point(shift.z);
#endif
  SamplePoints points = sample_points(blocker_samples, shift.xy);
  float sum = 0.0;
  float blockers = 0.0;
  int count = sample_count(blocker_samples);
  for (int i = 0; i < count; ++i) {
    float gap = reach;
#if SEARCH == 1
    gap *= fixed_point_value(height);
    height += r3_step_z;
#endif
    vec2 p;
    bool counts = light_view_choose(part, rise, next_sample(points), p);
#if !ONE_VIEW
    for (uint face = face_of_light_point(q, part, p, gap); counts && face != cursor.face;) {
      cursor = shadow_cursor_at(q, face);
      rays = sample_rays(cursor, q, part);
#if SEARCH == 1
      cone = map_cone(cursor.view, q.light, q.position, cursor.in_map, cursor.receiver.axis);
#endif
    }
#endif
    ShadowTap tap = shadow_tap_at(cursor, map_texel(cursor.view, map_kernel_point(rays, p, gap)));
    float found = map_gap(cursor.view, cursor.in_map, tap.texel, tap.depth);
    counts = counts && tap.blocked;
#if SEARCH == 1
    // Only what lies between the receiver and the light is a blocker, give or take a texel.
    counts = counts && map_cone_contains(cursor.view, q.light, cone, tap.texel, tap.depth, found,
                                         shadow_footprint(cursor.view, tap.depth));
#endif
    sum += counts ? found : 0.0;
    blockers += counts ? 1.0 : 0.0;
  }
  return blockers > 0.0 ? sum / blockers : 0.0;
}

#endif  // LIMN_BLOCKER_SAMPLES_GLSL
