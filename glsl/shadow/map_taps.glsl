// The comparison of map_blocks(), its thresholds and the boxes of shadow_kernel() with all that a receiver fixes worked out, which
// bounds measure. For perspective views and rectangles whose axis is the view's.
#ifndef LIMN_MAP_TAPS_GLSL
#define LIMN_MAP_TAPS_GLSL
#include "glsl/shadow/visibility.glsl"

// A texel blocks where (plane . (x, y, 1)) (stored + offset) > height and stored < nearer.
struct MapTest {
  vec3 plane;
  float offset;
  float height;
  float nearer;
};

MapTest map_test(ShadowCursor cursor) {
  float range = cursor.view.far - cursor.view.near;
  MapTest test;
  test.plane = cursor.in_map.plane.xyz;
  test.offset = cursor.view.near / range;
  test.height = cursor.in_map.height / range;
  test.nearer = min(1.0, (cursor.in_map.depth - cursor.view.near) / range);
  return test;
}

// slope: plane . (x, y, 1).
bool map_test_blocks(MapTest test, float slope, float stored) {
  return slope * (stored + test.offset) > test.height && stored < test.nearer;
}

// The stored depth below which it does, in [0, 1]. It grows with the slope.
float map_test_threshold(MapTest test, float slope) {
  float plane = slope < 0.0 ? test.height / slope - test.offset : test.height < 0.0 ? 1.0 : 0.0;
  return max(min(plane, test.nearer), 0.0);
}

// The boxes through which a receiver sees the counted part of its light: the one at `gap` metres lies between
// middle + (receiver + gap low) / (depth - gap) and the same of high, texels.
struct BoxRays {
  vec2 middle;
  vec2 receiver;
  vec2 low;
  vec2 high;
  float depth;  // of the receiver, metres
};

// rays: those to that part (light_view_part).
BoxRays box_rays(ShadowView view, MapKernel rays) {
  BoxRays r;
  r.middle = float(view.size) * view.middle;
  r.receiver = rays.receiver.xy;
  r.low = rays.centre.xy + min(rays.side_u.xy, vec2(0.0)) + min(rays.side_v.xy, vec2(0.0));
  r.high = rays.centre.xy + max(rays.side_u.xy, vec2(0.0)) + max(rays.side_v.xy, vec2(0.0));
  r.depth = rays.receiver.z;
  return r;
}

// At least `least` texels wide.
ShadowKernel rays_box(BoxRays rays, float gap, float least) {
  float inverse = 1.0 / max(rays.depth - gap, 1e-30);
  ShadowKernel box;
  box.low = rays.middle + inverse * (rays.receiver + gap * rays.low);
  box.high = rays.middle + inverse * (rays.receiver + gap * rays.high);
  box.weight = 1.0;
  widen_kernel(box, least);
  return box;
}

#endif  // LIMN_MAP_TAPS_GLSL
