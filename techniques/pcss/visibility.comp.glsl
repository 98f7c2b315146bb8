// Percentage-closer soft shadows (Fernando 2005).
//
// A sample is a point of the light. The ray from the receiver to it crosses a plane at depth z in a point of the kernel
// whose width is S (d - z) / d there; the map texel in that point's direction is tested. So the kernels w_i and w_p of
// the soft-shadow framework hold for every projection and across the faces of a cube, and only the part of the light
// above the receiver's tangent plane is sampled.
//
// PATTERN 0: grid, 1: R2 sequence shifted per pixel. SEARCH 0: at the near plane, 1: through the cone.
#include "glsl/sampling.glsl"
#include "glsl/visibility.glsl"

layout(binding = 0, r16) writeonly uniform image2DArray visibility;
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
  // The near plane: from the view's origin for directional lights, from the light for all others.
  float depth = q.light.cone ? dot(q.light.axis, q.position - cursor.view.origin.xyz) : q.light.depth;
  float reach = max(depth - cursor.view.origin.w, 0.0);
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

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID.xy, gl_WorkGroupID.z);
  VisibilityQuery q = visibility_query(at.xy, gl_WorkGroupID.z);
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  float v = 1.0;
  if (!q.masked) {
    ShadowCursor cursor = shadow_cursor(q);
    if (shadow_covers_receiver(cursor, q)) {
      if (!q.light.extended) {
        v = shadow_tap(cursor, q, q.position).blocked ? 0.0 : 1.0;
      } else {
        vec3 shift = pixel_noise(uint(at.x), uint(at.y), 0u);
        float gap = blocker_gap(cursor, q, shift);
        if (gap > 0.0) v = filtered(cursor, q, gap, pixel_noise(uint(at.x), uint(at.y), 1u).xy);
      }
    }
  }
  imageStore(visibility, at, vec4(v));
}
