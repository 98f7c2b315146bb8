// Percentage-closer soft shadows (Fernando 2005).
//
// A sample is a point of the light. The ray from the receiver to it crosses a plane at depth z in a point of the kernel
// whose width is S (d - z) / d there; the map texel in that point's direction is tested. So the kernels w_i and w_p of
// the soft-shadow framework hold for every projection and across the faces of a cube, and only the part of the light
// above the receiver's tangent plane is sampled.
//
// PATTERN 0: grid, 1: R2 sequence shifted per pixel. SEARCH 0: at the near plane, 1: through the cone.
#include "glsl/sampling.glsl"
#include "glsl/visibility_main.glsl"

uniform int blocker_samples;
uniform int filter_samples;

vec2 sample_point(int i, int count, vec2 shift) {
#if PATTERN == 0
  return grid_point(i, int(sqrt(float(count)) + 1e-3));
#else
  return fract(r2_sequence(uint(i)) + shift);
#endif
}

int sample_count(int count) {
#if PATTERN == 0
  int side = int(sqrt(float(count)) + 1e-3);
  return side * side;
#else
  return count;
#endif
}

// Steps 1 and 2: mean distance from the blockers to the receiver along the light's axis, metres; 0: there are none.
float blocker_gap(inout ShadowCursor cursor, VisibilityQuery q, vec3 shift) {
  float reach = shadow_near_gap(cursor, q);
  float sum = 0.0;
  int blockers = 0;
  int count = sample_count(blocker_samples);
  for (int i = 0; i < count; ++i) {
    float gap = reach;
#if SEARCH == 1
    gap *= fract(r3_sequence(uint(i)).z + shift.z);
#endif
    vec3 slope;
    if (!light_view_sample(q.light, sample_point(i, blocker_samples, shift.xy), slope)) continue;
    ShadowTap tap = shadow_tap(cursor, q, q.position + gap * slope);
    if (!tap.blocked) continue;
    float found = cursor.receiver.axis.w - dot(cursor.receiver.axis.xyz, tap.offset);
#if SEARCH == 1
    // Only what lies between the receiver and the light is a blocker, give or take a texel.
    vec3 to = shadow_world_offset(cursor.view, tap.offset) - (q.position - cursor.view.origin.xyz);
    float texel = shadow_footprint(cursor.view, shadow_depth_of(cursor.view, tap.offset));
    if (!light_view_contains(q.light, to / found, texel / found)) continue;
#endif
    sum += found;
    ++blockers;
  }
  return blockers > 0 ? sum / float(blockers) : 0.0;
}

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
