// The bound of moment soft shadow maps: the texels and the decisions of visibility.comp.glsl, with what a pixel fixes worked out
// once for it: thresholds are those of the least and the greatest slope of the tangent plane in a part, and kernels at all
// distances lie between the same two rays. One view sees all of the light, which is a rectangle.
#include "glsl/shadow/blocker_search.glsl"
#include "glsl/shadow/kernel_blockers.glsl"
#include "glsl/shadow/map_taps.glsl"
#include "glsl/shadow/moment_shadow.glsl"
#include "glsl/shadow/variance_kernel.glsl"
#include "glsl/shadow/visibility_main.glsl"

uniform usampler2DArray moment_table;
uniform int moment_bits;
uniform float moment_bias;
uniform int search_rounds;
uniform int direct_texels;
uniform int cells;
uniform int passes;
uniform float search_blur;  // texels
uniform float least_gap;

const float least_filter_width = 1.0;  // texels
const float least_search_blur = 0.5;   // texels
const float rest = 1.0 / 256.0;        // what rounding and bias leave of nothing and of everything

// One kernel of a receiver.
struct Kernel {
  MapTest test;
  BoxRays rays;
  float receiver;  // its depth, metres
  float gap;
  bool search;
  bool whole;    // the light above the tangent plane
  bool beneath;  // map_from_beneath()
  vec2 place;    // the receiver's own in the map, texels
  vec2 low;
  vec2 high;
};

// Adds what lies in low..high by `share`, `depth` metres from the light.
void add_blockers(inout KernelBlockers blockers, Kernel k, vec2 low, vec2 high, float share, float depth) {
  float own_gap = clamp(k.receiver - depth, least_gap * k.gap, k.gap);
  if (k.search) {
    ShadowKernel own = rays_box(k.rays, own_gap, least_kernel_width);
    float blur = max(search_blur, least_search_blur);
    low = max(low, own.low - blur);
    high = min(high, own.high + blur);
  }
  vec2 inside = max(high - low, vec2(0.0));
  float texels = share * inside.x * inside.y;
  blockers.texels += texels;
  blockers.gap += texels * own_gap;
}

// Adds the texel if it blocks, as if it were low..high.
void add_texel(inout KernelBlockers blockers, ShadowCursor cursor, Kernel k, ivec2 texel, vec2 low, vec2 high) {
  float stored = texelFetch(shadow_depth, ivec3(texel, cursor.layer), 0).r;
  if (map_test_blocks(k.test, dot(k.test.plane, vec3(texel, 1.0)), stored))
    add_blockers(blockers, k, low, high, 1.0, shadow_metres(cursor.view, stored));
}

// What the moments of low..high say. beyond: something may lie before the greatest threshold in it.
MomentBlockers cell_blockers(ShadowCursor cursor, Kernel k, vec2 low, vec2 high, out bool beyond) {
  float slope = dot(k.test.plane, vec3(0.5 * (low + high) - 0.5, 1.0));
  float change = 0.5 * dot(abs(k.test.plane.xy), high - low);
  float d = map_test_threshold(k.test, slope - change);
  vec2 depths = kernel_depth_bounds(cursor, ShadowKernel(low, high, 1.0));
  beyond = depths.x < (k.beneath ? k.test.nearer : map_test_threshold(k.test, slope + change));
  if (d <= depths.x) return MomentBlockers(0.0, d);
  if (depths.y < d) return MomentBlockers(1.0, 0.5 * (depths.x + depths.y));
  vec4 t = moment_lookup(moment_table, low, high, int(cursor.layer), moment_bits);
  return moment_blockers(t, d, depths.x, moment_bias);
}

// Where cell i of parts.x x parts.y begins along both axes.
ivec2 cell_place(ivec2 parts, int i) {
  int row = whole_quotient(i, parts.x);
  return ivec2(i - row * parts.x, row);
}

// The texels there, of a kernel from a to b: whole but for its own edges.
vec2 cell_edge(vec2 a, vec2 b, ivec2 parts, ivec2 place) {
  return vec2(moment_cell_edge(a.x, b.x, place.x, parts.x), moment_cell_edge(a.y, b.y, place.y, parts.y));
}

KernelBlockers cells_blockers(ShadowCursor cursor, Kernel k) {
  vec2 size = vec2(cursor.view.size);
  vec2 a = clamp(k.low, vec2(0.0), size);
  vec2 b = clamp(k.high, vec2(0.0), size);
  ivec2 parts = max(ivec2(ceil((b - a) / float(moment_largest_side(moment_bits) - 1))), ivec2(cells));
  KernelBlockers blockers = KernelBlockers(0.0, 0.0);
  int count = parts.x * parts.y;
  int i = 0;
  do {
    int first = i;
    uint cut = 0u;  // cells that the horizon cuts, bit by bit
    do {
      ivec2 place = cell_place(parts, i);
      vec2 low = cell_edge(a, b, parts, place);
      vec2 high = cell_edge(a, b, parts, place + 1);
      if (all(lessThan(low, high))) {
        bool beyond;
        MomentBlockers found = cell_blockers(cursor, k, low, high, beyond);
        bool crossed = beyond && found.share < rest && (!k.whole || k.beneath);
        cut |= crossed ? 1u << uint(i - first) : 0u;
        if (found.share > 0.0 && !crossed)
          add_blockers(blockers, k, low, high, found.share, shadow_metres(cursor.view, found.depth));
      }
    } while (++i < min(first + 32, count));
    for (; cut != 0u; cut &= cut - 1u) {
      ivec2 place = cell_place(parts, first + findLSB(cut));
      vec2 low = cell_edge(a, b, parts, place);
      vec2 quarter = 0.5 * (cell_edge(a, b, parts, place + 1) - low);
      for (int n = 0; n < 4; ++n) {
        vec2 corner = low + quarter * vec2(n & 1, n >> 1);
        add_texel(blockers, cursor, k, ivec2(corner + 0.5 * quarter), corner, corner + quarter);
      }
    }
  } while (i < count);
  return blockers;
}

// The same, texel by texel.
KernelBlockers texel_blockers(ShadowCursor cursor, Kernel k) {
  ivec2 first = max(ivec2(floor(k.low)), ivec2(0));
  ivec2 last = min(ivec2(ceil(k.high)), ivec2(cursor.view.size)) - 1;
  KernelBlockers blockers = KernelBlockers(0.0, 0.0);
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x)
      add_texel(blockers, cursor, k, ivec2(x, y), max(vec2(x, y), k.low), min(vec2(x, y) + 1.0, k.high));
  }
  return blockers;
}

// What blocks in the kernel at `gap`.
Blockers blockers_at(ShadowCursor cursor, Kernel k, float gap) {
  ShadowKernel box = rays_box(k.rays, gap, k.search ? least_kernel_width : least_filter_width);
  if (k.search && k.beneath) extend_kernel(box, k.place);
  k.gap = gap;
  k.low = k.search ? floor(box.low) : box.low;
  k.high = k.search ? max(ceil(box.high), k.low + 1.0) : box.high;
  vec2 extent = k.high - k.low;
  // From texels to moments by degrees.
  float direct = !k.search && direct_texels > 0
                     ? clamp(5.0 - 4.0 * max(extent.x, extent.y) / float(direct_texels), 0.0, 1.0)
                     : 0.0;
  KernelBlockers found = KernelBlockers(0.0, 0.0);
  if (direct < 1.0) found = cells_blockers(cursor, k);
  if (direct > 0.0) {
    KernelBlockers texels = texel_blockers(cursor, k);
    found.texels = mix(found.texels, texels.texels, direct);
    found.gap = mix(found.gap, texels.gap, direct);
  }
  return Blockers(found.texels / (extent.x * extent.y), clamp(found.gap / max(found.texels, 1e-30), 0.0, gap), found.texels);
}

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  BlockerSearch search = blocker_search(cursor, q, search_rounds);
  if (search.answer != search_partial) return search.answer == search_lit ? 1.0 : 0.0;
  Kernel k;
  k.test = map_test(cursor);
  k.rays = box_rays(cursor.view, map_kernel_across(cursor.view, light_view_part(q.light), q.position));
  k.receiver = cursor.in_map.depth;
  k.whole = q.light.whole;
  k.beneath = map_from_beneath(cursor.view, cursor.in_map);
  k.place = shadow_place(cursor, q.position);
  k.search = true;
  Blockers found = blockers_at(cursor, k, search.gap);
  if (found.texels < 0.5) return 1.0;
  float gap = found.gap;
  float nearer = 1.0;
  int pass = 0;
  k.search = false;
  do {
    Blockers next = blockers_at(cursor, k, gap);
    found.share = mix(found.share, next.share, nearer);
    found.gap = mix(found.gap, next.gap, nearer);
    nearer = clamp(4.5 - 5.0 * found.gap / gap, 0.0, 1.0);
    gap = found.gap;
  } while (++pass < passes && nearer > 0.0);
  float hidden = found.share / light_view_box_share(q.light);
  return clamp((1.0 - hidden - rest) / (1.0 - 2.0 * rest), 0.0, 1.0);
}
