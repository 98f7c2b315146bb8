// Percentage-closer filtering (Reeves, Salesin, Cook 1987): the lit share of a square of the shadow map around the
// receiver, seen from the light's centre. Each texel is tested against the receiver's tangent plane and weighted by
// what the square covers of it, so that V is continuous in the receiver's position.
#include "glsl/shadow/blocker_search.glsl"
#include "glsl/shadow/texel_kernel.glsl"
#include "glsl/shadow/visibility_main.glsl"

uniform float kernel_width;  // texels

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  ShadowView view = cursor.view;  // in which the kernel is square
  float size = float(view.size);
  ShadowPoint at = shadow_project(view, q.position);
  vec2 low = at.uv * size - 0.5 * kernel_width;
  ivec2 first = ivec2(floor(low));
  ivec2 last = ivec2(ceil(low + kernel_width)) - 1;
  bool inside = all(greaterThanEqual(first, ivec2(0))) && all(lessThan(last, ivec2(size)));
  if (inside || q.maps.faces == shadow_faces_single) {  // lies in no other view
    vec2 thresholds = map_threshold_range(view, cursor.in_map, vec2(first) + 0.5, vec2(last) + 0.5);
    vec2 depths = min_max_depth(shadow_min_max, first, last, int(cursor.layer));
    if (thresholds.y <= depths.x) return 1.0;
    if (depths.y < thresholds.x) return 0.0;
    return texel_kernel_lit(cursor, low, low + kernel_width);
  }
  float blocked = 0.0;
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      // In another view, the direction of the texel's middle; its depth does not matter.
      vec3 p = shadow_unproject_local(view, (vec2(x, y) + 0.5) / size, at.depth);
      ShadowTap tap = shadow_tap(cursor, q, view.origin + shadow_world_offset(view, p));
      if (tap.blocked) blocked += texel_coverage(low, low + kernel_width, ivec2(x, y));
    }
  }
  return clamp(1.0 - blocked / (kernel_width * kernel_width), 0.0, 1.0);
}
