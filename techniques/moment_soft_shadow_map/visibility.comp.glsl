// Moment soft shadow maps (Peters and Klein 2015, Peters et al. 2017): percentage-closer soft shadows of which both
// steps, the mean depth of the blockers and the share of light, come from four moments of depth in a summed-area table.
#include "glsl/shadow/blocker_search.glsl"
#include "glsl/shadow/light_kernels.glsl"
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

// How far, in texels, a part of a search kernel may lie beside the cone to the light and still count: its depth is a mean,
// which would let go of blockers that touch the receiver.
uniform float search_blur;

// The least distance of blockers to the receiver, relative to that of the kernel that they are found in: their mean depth is
// no more exact.
uniform float least_gap;

// A penumbra kernel within a texel would make the texels' edges visible.
const float least_filter_width = 1.0;

// The least of search_blur, so that the cone to a narrow light is a texel wide: what fills it counts as found.
const float least_search_blur = 0.5;

// What rounding and bias leave of nothing and of everything.
const float rest = 1.0 / 256.0;

// A part of a kernel, in the map. The threshold is the least one in it, so that no plane blocks itself. beyond: something may
// lie before the greatest one.
MomentBlockers cell_blockers(ShadowCursor cursor, ShadowKernel cell, out bool beyond) {
  vec2 thresholds = map_threshold_range(cursor.view, cursor.in_map, cell.low, cell.high);
  float d = thresholds.x;
  vec2 depths = kernel_depth_bounds(cursor, cell);
  beyond = depths.x < thresholds.y;
  if (d <= depths.x) return MomentBlockers(0.0, d);
  if (depths.y < d) return MomentBlockers(1.0, 0.5 * (depths.x + depths.y));
  vec4 t = moment_lookup(moment_table, cell.low, cell.high, int(cursor.layer), moment_bits);
  return moment_blockers(t, d, depths.x, moment_bias);
}

// How many texels of low..high lie in the cone to the light where they are, `own_gap` before the receiver.
float texels_in_cone(ShadowCursor cursor, VisibilityQuery q, vec2 low, vec2 high, float own_gap) {
  ShadowKernel own;
  bool whole = shadow_views_apart(q.maps.faces);
  if (!shadow_kernel(cursor.view, q.light, q.position, own_gap, whole, least_kernel_width, own)) return 0.0;
  float blur = max(search_blur, least_search_blur);
  vec2 inside = max(min(high, own.high + blur) - max(low, own.low - blur), vec2(0.0));
  return inside.x * inside.y;
}

// Adds what lies in low..high of the kernel at `gap`, by `share`, `depth` metres from the light. A search kernel is so wide
// that much of what is in it lies beside the cone to the light; one at the blockers' distance is filtered as published.
void add_blockers(inout KernelBlockers blockers, ShadowCursor cursor, VisibilityQuery q, float gap, int use, vec2 low,
                  vec2 high, float share, float depth) {
  vec2 middle = 0.5 * (low + high) - 0.5;
  float own_gap = clamp(map_gap(cursor.view, cursor.in_map, middle, depth), least_gap * gap, gap);
  float texels = share * (use == kernel_search ? texels_in_cone(cursor, q, low, high, own_gap)
                                               : (high.x - low.x) * (high.y - low.y));
  blockers.texels += texels;
  blockers.gap += texels * own_gap;
}

// Adds what texels say of a cell that the horizon cuts.
void add_quarters(inout KernelBlockers blockers, ShadowCursor cursor, VisibilityQuery q, float gap, int use,
                  ShadowKernel cell) {
  for (int i = 0; i < 4; ++i) {
    PartQuarter part = part_quarter(cursor, cell.low, cell.high, i);
    if (part.tap.blocked) add_blockers(blockers, cursor, q, gap, use, part.low, part.high, 1.0, part.tap.depth);
  }
}

// Cell i of parts.x x parts.y of the kernel from a to b.
ShadowKernel kernel_cell(vec2 a, vec2 b, ivec2 parts, int i) {
  int row = whole_quotient(i, parts.x);
  ivec2 part = ivec2(i - row * parts.x, row);
  vec2 low = vec2(moment_cell_edge(a.x, b.x, part.x, parts.x), moment_cell_edge(a.y, b.y, part.y, parts.y));
  vec2 high = vec2(moment_cell_edge(a.x, b.x, part.x + 1, parts.x), moment_cell_edge(a.y, b.y, part.y + 1, parts.y));
  return ShadowKernel(low, high, 1.0);
}

// The kernel at `gap` in cells x cells parts, or as many as sums of the table stay exact in. What lies outside the map is
// unoccluded.
KernelBlockers cells_blockers(ShadowCursor cursor, VisibilityQuery q, ShadowKernel kernel, float gap, int use) {
  vec2 size = vec2(cursor.view.size);
  vec2 a = clamp(kernel.low, vec2(0.0), size);
  vec2 b = clamp(kernel.high, vec2(0.0), size);
  // Rounding moves an edge by half a texel.
  ivec2 exact = ivec2(ceil((b - a) / float(moment_largest_side(moment_bits) - 1)));
  ivec2 parts = max(exact, ivec2(cells));
  // From beneath the tangent plane no threshold parts what blocks from the rest: each cell counts as cut.
  bool horizon = !q.light.whole || map_from_beneath(cursor.view, cursor.in_map);
  KernelBlockers blockers = KernelBlockers(0.0, 0.0);
  int count = parts.x * parts.y;
  int i = 0;
  do {
    // Cells that have a bit each: few pixels need texels, so they take them together.
    int first = i;
    uint cut = 0u;  // those that the horizon cuts
    do {  // conditions come last: software renderers run a loop's body once more where they come first
      ShadowKernel cell = kernel_cell(a, b, parts, i);
      if (all(lessThan(cell.low, cell.high))) {
        bool beyond;
        MomentBlockers found = cell_blockers(cursor, cell, beyond);
        bool crossed = beyond && found.share < rest && horizon;
        cut |= crossed ? 1u << uint(i - first) : 0u;
        if (found.share > 0.0 && !crossed)
          add_blockers(blockers, cursor, q, gap, use, cell.low, cell.high, found.share,
                       shadow_metres(cursor.view, found.depth));
      }
    } while (++i < min(first + 32, count));
    for (; cut != 0u; cut &= cut - 1u)
      add_quarters(blockers, cursor, q, gap, use, kernel_cell(a, b, parts, first + findLSB(cut)));
  } while (i < count);
  return blockers;
}

// The same, texel by texel.
KernelBlockers texel_blockers(ShadowCursor cursor, VisibilityQuery q, ShadowKernel kernel, float gap) {
  ivec2 first = max(ivec2(floor(kernel.low)), ivec2(0));
  ivec2 last = min(ivec2(ceil(kernel.high)), ivec2(cursor.view.size)) - 1;
  KernelBlockers blockers = KernelBlockers(0.0, 0.0);
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      ShadowTap tap = shadow_texel(cursor, ivec2(x, y));
      if (!tap.blocked) continue;
      add_blockers(blockers, cursor, q, gap, kernel_filter, max(vec2(x, y), kernel.low),
                   min(vec2(x, y) + 1.0, kernel.high), 1.0, tap.depth);
    }
  }
  return blockers;
}

KernelBlockers kernel_blockers(ShadowCursor cursor, VisibilityQuery q, inout ShadowKernel kernel, float gap, int use) {
  if (use == kernel_search) {
    kernel.low = floor(kernel.low);
    kernel.high = max(ceil(kernel.high), kernel.low + 1.0);
  }
  vec2 extent = kernel.high - kernel.low;
  // From texels to moments by degrees, between direct_texels and a quarter more: the two answers differ.
  float direct = use == kernel_filter && direct_texels > 0
                     ? clamp(5.0 - 4.0 * max(extent.x, extent.y) / float(direct_texels), 0.0, 1.0)
                     : 0.0;
  KernelBlockers found = KernelBlockers(0.0, 0.0);
  if (direct < 1.0) found = cells_blockers(cursor, q, kernel, gap, use);
  if (direct > 0.0) {
    KernelBlockers texels = texel_blockers(cursor, q, kernel, gap);
    found.texels = mix(found.texels, texels.texels, direct);
    found.gap = mix(found.gap, texels.gap, direct);
  }
  return found;
}

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  BlockerSearch search = blocker_search(cursor, q, search_rounds);
  if (search.answer == search_lit) return 1.0;
  if (search.answer == search_umbra) return 0.0;
  Blockers found = blockers_at(cursor, q, search.gap, least_kernel_width, kernel_search, true);
  if (found.texels < 0.5) return 1.0;
  float gap = found.gap;
  found = blockers_at(cursor, q, gap, least_filter_width, kernel_filter, true);
  for (int pass = 1; pass < passes; ++pass) {
    // By degrees between 0.9 and 0.7 of the distance before: neighbouring pixels would part there.
    float nearer = clamp(4.5 - 5.0 * found.gap / gap, 0.0, 1.0);
    if (nearer == 0.0) break;
    gap = found.gap;
    Blockers next = blockers_at(cursor, q, gap, least_filter_width, kernel_filter, true);
    found.share = mix(found.share, next.share, nearer);
    found.gap = mix(found.gap, next.gap, nearer);
  }
  // The kernel is a box around what of the light counts; what blocks hides none of the rest.
  float hidden = found.share / light_view_box_share(q.light);
  return clamp((1.0 - hidden - rest) / (1.0 - 2.0 * rest), 0.0, 1.0);
}
