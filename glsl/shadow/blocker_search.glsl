// The blocker search of prefiltered soft shadows: the kernel in which blockers are looked for, and what the min-max
// pyramid of the maps says about it.
//
// Define BOUNDS_DEPTH, the lookup that suits what shadow_min_max is: min_max_depth (where it is undefined),
// min_max_windows_depth or n_buffer_depth.
#ifndef LIMN_BLOCKER_SEARCH_GLSL
#define LIMN_BLOCKER_SEARCH_GLSL
#include "glsl/shadow/min_max_pyramid.glsl"
#include "glsl/shadow/min_max_windows.glsl"
#include "glsl/shadow/n_buffer.glsl"
#include "glsl/shadow/visibility.glsl"

#ifndef BOUNDS_DEPTH
#define BOUNDS_DEPTH min_max_depth
#endif

uniform sampler2DArray shadow_min_max;  // bounds of the depths in the maps

LIMN_CONST int search_lit = 0;      // nothing in the kernel blocks: V = 1
LIMN_CONST int search_umbra = 1;    // everything in it blocks: V = 0
LIMN_CONST int search_partial = 2;  // neither is certain

struct BlockerSearch {
  int answer;  // search_*
  float gap;   // metres from the receiver to the plane of the search kernel; no blocker in the kernel is farther
};

// The texels that a kernel touches, with a margin of one where it reaches out of the map: (low, high), both included.
ivec4 kernel_texels(ShadowCursor cursor, ShadowKernel kernel) {
  ivec2 low = ivec2(floor(clamp(kernel.low, vec2(-1.0), vec2(cursor.view.size))));
  ivec2 high = ivec2(ceil(clamp(kernel.high, vec2(0.0), vec2(cursor.view.size) + 1.0))) - 1;
  return ivec4(low, max(high, low));
}

// The box of their centres, which is where the depths that they hold are to be compared: on a slope seen edge-on, half a
// texel aside is more than any bias.
ShadowKernel kernel_centres(ShadowCursor cursor, ShadowKernel kernel) {
  ivec4 texels = kernel_texels(cursor, kernel);
  return ShadowKernel(vec2(texels.xy) + 0.5, vec2(texels.zw) + 0.5, kernel.weight);
}

// Bounds of the depths stored in them.
vec2 kernel_depth_bounds(ShadowCursor cursor, ShadowKernel kernel) {
  ivec4 texels = kernel_texels(cursor, kernel);
  return BOUNDS_DEPTH(shadow_min_max, texels.xy, texels.zw, int(cursor.layer));
}

// Extends a kernel to a place, texels.
void extend_kernel(inout ShadowKernel kernel, vec2 place) {
  kernel.low = min(kernel.low, place);
  kernel.high = max(kernel.high, place);
}

// Extends a kernel that no face has cut to where the view sees the receiver; then its face cuts it, unless it is to stay `whole`.
// seen, whole: shadow_kernel()'s. False: nothing of it lies in this view.
bool extend_to_receiver(ShadowView view, vec3 receiver, bool whole, bool seen, inout ShadowKernel kernel) {
  vec3 r = shadow_local(view, receiver);
  bool there = seen || r.z > 0.0 || view.projection != shadow_perspective;
  // As in shadow_kernel(): what lies beside or behind a perspective view lies far outside its map.
  if (view.projection == shadow_perspective) r.z = max(r.z, 1e-3 * max(abs(r.x), abs(r.y)));
  extend_kernel(kernel, float(view.size) * shadow_project_local(view, r).uv);
  if (whole) return there;
  kernel.low = max(kernel.low, vec2(0.0));
  kernel.high = min(kernel.high, vec2(view.size));
  vec2 extent = kernel.high - kernel.low;
  kernel.weight = extent.x * extent.y;  // so that texels count alike in all faces
  return there && extent.x > 0.0 && extent.y > 0.0;
}

// As shadow_kernel_in_face(). searching: the kernel is to hold those at all lesser gaps, which shrink towards the receiver's own
// place. Each of them holds that place itself while the light's centre counts; where the centre lies beneath the tangent plane,
// they lie beside it, and the kernel is extended to it.
bool kernel_in_face(inout ShadowCursor cursor, VisibilityQuery q, uint face, float gap, float least, bool searching,
                    out ShadowKernel kernel) {
#if !ONE_VIEW
  if (face != cursor.face) cursor = shadow_cursor_at(q, face);
#endif
  bool whole = shadow_views_apart(q.maps.faces);
  bool reaching = searching && map_from_beneath(cursor.view, cursor.in_map);
  bool seen = shadow_kernel(cursor.view, q.light, q.position, gap, whole || reaching, least, kernel);
  if (reaching) seen = extend_to_receiver(cursor.view, q.position, whole, seen, kernel);
  return seen;
}

// The kernel starts at the near plane and stays there without rounds, as published; each of `rounds` moves it to the nearest depth
// in it, beyond which nothing can block. Bounds may decide in every kernel but the last one that it moves to.
BlockerSearch blocker_search(inout ShadowCursor cursor, VisibilityQuery q, int rounds) {
  BlockerSearch search;
  search.gap = shadow_near_gap(cursor, q);
  int round = 0;
  do {
    float widest = 0.0;
    bool lit = true;
    bool umbra = true;
    uint face = 0u;
    do {  // the condition comes last: software renderers run a loop's body once more where it comes first
      ShadowKernel kernel;
      if (kernel_in_face(cursor, q, face, search.gap, least_kernel_width, true, kernel)) {
        vec2 depths = kernel_depth_bounds(cursor, kernel);
        ShadowKernel centres = kernel_centres(cursor, kernel);
        vec2 thresholds = map_threshold_range(cursor.view, cursor.in_map, centres.low, centres.high);
        lit = lit && thresholds.y <= depths.x;
        umbra = umbra && depths.y < thresholds.x;
        widest = max(widest, map_gap_bound(cursor.view, cursor.in_map, centres.low, centres.high,
                                           shadow_metres(cursor.view, depths.x)));
      }
    } while (++face < shadow_face_count(q.maps.faces));
    search.answer = lit ? search_lit : umbra ? search_umbra : search_partial;
    if (search.answer != search_partial || rounds == 0) return search;
    search.gap = clamp(widest, 0.0, search.gap);
  } while (++round < rounds);
  return search;
}

#endif  // LIMN_BLOCKER_SEARCH_GLSL
