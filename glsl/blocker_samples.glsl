// The blocker search of percentage-closer soft shadows by point samples (Fernando 2005, steps 1 and 2).
//
// Define PATTERN 0: grid, 1: R2 sequence shifted per pixel; SEARCH 0: at the near plane, 1: through the cone.
#ifndef LIMN_BLOCKER_SAMPLES_GLSL
#define LIMN_BLOCKER_SAMPLES_GLSL
#include "glsl/sampling.glsl"
#include "glsl/visibility.glsl"

uniform int blocker_samples;

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

#endif  // LIMN_BLOCKER_SAMPLES_GLSL
