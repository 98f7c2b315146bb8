// Moment soft shadow maps (Peters and Klein 2015, Peters et al. 2017): percentage-closer soft shadows of which both
// steps, the mean depth of the blockers and the share of light, come from four moments of depth in a summed-area table.
#include "glsl/blocker_search.glsl"
#include "glsl/moment_shadow.glsl"
#include "glsl/texel_kernel.glsl"
#include "glsl/visibility_main.glsl"

layout(binding = 10) uniform usampler2DArray moment_table;
uniform int moment_bits;
uniform float moment_bias;
uniform int search_rounds;
uniform int direct_texels;
uniform int cells;

// What blocks in a kernel of one view.
struct KernelBlockers {
  float texels;  // that block
  float gap;     // sum of their distances to the receiver along the light's axis, metres
};

// A part of a kernel, in the map. The threshold is the least one in it, so that no plane blocks itself.
MomentBlockers cell_blockers(ShadowCursor cursor, ShadowKernel cell) {
  float d = shadow_threshold_range(cursor.view, cursor.receiver, cell).x;
  vec2 depths = kernel_depth_bounds(cursor, cell);
  if (d <= depths.x) return MomentBlockers(0.0, d);
  if (depths.y < d) return MomentBlockers(1.0, 0.5 * (depths.x + depths.y));
  vec4 t = moment_lookup(moment_table, cell.low, cell.high, int(cursor.layer), moment_bits);
  return moment_blockers(t, d, depths.x, moment_bias);
}

// The kernel in cells x cells parts, or as many as sums of the table stay exact in. What lies outside the map is
// unoccluded.
KernelBlockers kernel_blockers(ShadowCursor cursor, ShadowKernel kernel) {
  vec2 size = vec2(cursor.view.info.z);
  vec2 a = clamp(kernel.low, vec2(0.0), size);
  vec2 b = clamp(kernel.high, vec2(0.0), size);
  // Rounding moves an edge by half a texel.
  ivec2 exact = ivec2(ceil((b - a) / float(moment_largest_side(moment_bits) - 1)));
  ivec2 parts = max(exact, ivec2(cells));
  KernelBlockers blockers = KernelBlockers(0.0, 0.0);
  for (int i = 0; i < parts.x * parts.y; ++i) {
    ivec2 part = ivec2(i % parts.x, i / parts.x);
    ShadowKernel cell = kernel;
    cell.low = mix(round(mix(a, b, vec2(part) / vec2(parts))), a, equal(part, ivec2(0)));
    cell.high = mix(round(mix(a, b, vec2(part + 1) / vec2(parts))), b, equal(part + 1, parts));
    if (any(lessThanEqual(cell.high, cell.low))) continue;
    MomentBlockers found = cell_blockers(cursor, cell);
    vec2 extent = cell.high - cell.low;
    float texels = found.share * extent.x * extent.y;
    blockers.texels += texels;
    blockers.gap += texels * shadow_gap(cursor.view, cursor.receiver, 0.5 * (cell.low + cell.high) / size, found.depth);
  }
  return blockers;
}

// Steps 1 and 2: mean distance from the blockers in the search kernel to the receiver, metres; 0: there are none.
float blocker_gap(inout ShadowCursor cursor, VisibilityQuery q, float reach) {
  float sum = 0.0;
  float share = 0.0;
  float texels = 0.0;
  for (uint face = 0u; face < shadow_face_count(q.maps.info.y); ++face) {
    ShadowKernel kernel;
    if (!shadow_kernel_in_face(cursor, q, face, reach, kernel)) continue;
    kernel.low = floor(kernel.low);
    kernel.high = max(ceil(kernel.high), kernel.low + 1.0);
    KernelBlockers found = kernel_blockers(cursor, kernel);
    vec2 extent = kernel.high - kernel.low;
    float weight = kernel.weight / (extent.x * extent.y);
    sum += weight * found.gap;
    share += weight * found.texels;
    texels += found.texels;
  }
  return texels >= 0.5 ? clamp(sum / share, 0.0, reach) : 0.0;
}

// Steps 3 and 4: the lit share of the kernel on the plane of the mean blocker.
float filtered(inout ShadowCursor cursor, VisibilityQuery q, float gap) {
  float blocked = 0.0;
  float total = 0.0;
  for (uint face = 0u; face < shadow_face_count(q.maps.info.y); ++face) {
    ShadowKernel kernel;
    if (!shadow_kernel_in_face(cursor, q, face, gap, kernel)) continue;
    // A kernel within a texel would make the texels' edges visible.
    vec2 widen = max(0.5 * (1.0 - (kernel.high - kernel.low)), vec2(0.0));
    kernel.low -= widen;
    kernel.high += widen;
    vec2 extent = kernel.high - kernel.low;
    // From texels to moments by degrees, between direct_texels and a quarter more: the two answers differ.
    float direct = direct_texels > 0 ? clamp(5.0 - 4.0 * max(extent.x, extent.y) / float(direct_texels), 0.0, 1.0) : 0.0;
    float share = 0.0;
    if (direct > 0.0) share += direct * (1.0 - texel_kernel_lit(cursor, kernel.low, kernel.high));
    if (direct < 1.0) share += (1.0 - direct) * kernel_blockers(cursor, kernel).texels / (extent.x * extent.y);
    blocked += kernel.weight * share;
    total += kernel.weight;
  }
  return total > 0.0 ? 1.0 - blocked / total : 1.0;
}

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  BlockerSearch search = blocker_search(cursor, q, search_rounds);
  if (search.answer == search_lit) return 1.0;
  if (search.answer == search_umbra) return 0.0;
  float gap = blocker_gap(cursor, q, search.gap);
  if (gap <= 0.0) return 1.0;
  // What rounding and bias leave of nothing and of everything.
  const float rest = 1.0 / 256.0;
  return clamp((filtered(cursor, q, gap) - rest) / (1.0 - 2.0 * rest), 0.0, 1.0);
}
