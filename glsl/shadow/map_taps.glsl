// The comparison of map_blocks() with all that a receiver fixes worked out, which bounds measure. For perspective views and
// lights whose axis is the view's.
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

#endif  // LIMN_MAP_TAPS_GLSL
