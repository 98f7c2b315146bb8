// The bound of percentage-closer filtering: the texels and the decisions of visibility.comp.glsl, with what a row or a pixel
// fixes worked out once for it. One view sees all of the light.
#include "glsl/shadow/blocker_search.glsl"
#include "glsl/shadow/map_taps.glsl"
#include "glsl/shadow/visibility_main.glsl"

uniform float kernel_width;  // texels

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  vec2 low = shadow_place(cursor, q.position) - 0.5 * kernel_width;
  vec2 high = low + kernel_width;
  ivec2 first = ivec2(floor(low));
  ivec2 last = ivec2(ceil(high)) - 1;
  vec2 thresholds = map_threshold_range(cursor.view, cursor.in_map, vec2(first) + 0.5, vec2(last) + 0.5);
  vec2 depths = min_max_depth(shadow_min_max, first, last, int(cursor.layer));
  if (thresholds.y <= depths.x) return 1.0;
  if (depths.y < thresholds.x) return 0.0;
  first = max(first, ivec2(0));
  last = min(last, ivec2(cursor.view.size) - 1);
  MapTest test = map_test(cursor);
  float blocked = 0.0;
  int y = first.y;
  do {
    float row = float(y);
    float along_row = test.plane.y * row + test.plane.z;
    float of_row = 0.0;
    int x = first.x;
    do {
      float column = float(x);
      float stored = texelFetch(shadow_depth, ivec3(x, y, cursor.layer), 0).r;
      bool counts = map_test_blocks(test, test.plane.x * column + along_row, stored);
      of_row += counts ? min(column + 1.0, high.x) - max(column, low.x) : 0.0;
    } while (++x <= last.x);
    blocked += of_row * (min(row + 1.0, high.y) - max(row, low.y));
  } while (++y <= last.y);
  return clamp(1.0 - blocked / (kernel_width * kernel_width), 0.0, 1.0);
}
