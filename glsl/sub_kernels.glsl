// What a summed-area table of shadow maps and a few of their texels tell about kernels cut into sub-kernels: how many
// texels block, and how far they lie from the receiver. For techniques that answer `visibility`.
//
// Define TABLE_FORMAT (sat_format), WIDE_Z 1: sums of z over a sub-kernel may need two words, POOLED 1:
// Chebyshev's inequality once for all sub-kernels with E(z) < d, 0: for each.
//
// Loops end in their condition: software renderers run a body once more where it comes first.
#ifndef LIMN_SUB_KERNELS_GLSL
#define LIMN_SUB_KERNELS_GLSL
#include "glsl/variance_kernel.glsl"
#include "glsl/visibility.glsl"

layout(binding = 10) uniform usampler2DArray shadow_table;

const uint table_format = TABLE_FORMAT;

// A kernel in one view, and what was found in it.
struct KernelTally {
  ShadowThresholds thresholds;
  KernelCone cone;
  int size;       // texels per side of the map
  int layer;
  float blocked;  // texels
  float gap;      // metres to the receiver along the light's axis, summed over those texels
  vec4 pooled;    // sums over sub-kernels with E(z) < d: texels, first, second, first times the gap of its blockers
};

// gap: the kernel's. deepest: stored in any texel of it.
KernelTally kernel_tally(ShadowCursor cursor, VisibilityQuery q, ShadowKernel kernel, float gap, float deepest) {
  KernelTally tally;
  vec3 local = shadow_local(cursor.view, q.position);
  float towards = shadow_view_axes(cursor.view, q.light.centre).z;
  tally.cone = kernel_cone(cursor.view, local, towards, kernel.low, kernel.high, gap);
  tally.thresholds = shadow_thresholds(cursor.view, cursor.receiver, dot(cursor.receiver.plane.xyz, local),
                                       shadow_metres(cursor.view, deepest), float(sat_scale(table_format)));
  tally.size = int(cursor.view.info.z);
  tally.layer = int(cursor.layer);
  tally.blocked = 0.0;
  tally.gap = 0.0;
  tally.pooled = vec4(0.0);
  return tally;
}

// Sums over the texels left of and above `at`, 0 <= at <= size.
uvec4 table_sums(KernelTally tally, ivec2 at) {
  uvec4 sums = texelFetch(shadow_table, ivec3(max(at - 1, 0), tally.layer), 0);
  return at.x > 0 && at.y > 0 ? sums : uvec4(0u);
}

// Texels low..high (excluded), each weighted by `weight`.
struct TexelBox {
  ivec2 low;
  ivec2 high;
  float weight;
};

// Sums over `texels` texels of d - z and (d - z)^2, from the table's at (high.x, high.y), (low.x, high.y), ...; d in quanta.
vec2 box_moments(uvec4 s11, uvec4 s01, uvec4 s10, uvec4 s00, uint texels, float d) {
  uint receiver = uint(d + 0.5);
  float rest = d - float(receiver);
  SatBox box = sat_box(sat_unpack(s11, table_format), sat_unpack(s01, table_format), sat_unpack(s10, table_format),
                       sat_unpack(s00, table_format), texels, table_format);
#if WIDE_Z
  SatMoments m = sat_accumulated(SatMoments(0.0, 0.0, 0.0), box, 1.0, receiver);
#else
  // Sums of z fit one word.
  uint all = texels * receiver;
  uint first = all - box.z.x;
  bool before = all >= box.z.x;
  uvec2 twice = wide_subtract(uvec2(first, before ? 0u : 0xffffffffu), uvec2(box.z.x, 0u));
  uvec2 second = wide_add(wide_multiply(twice, receiver), box.zz);
  SatMoments m;
  m.first = before ? float(first) : -float(0u - first);
  m.second = wide_unsigned_float(second);
#endif
  float n = float(texels);
  return vec2(m.first + n * rest, m.second + rest * (2.0 * m.first + n * rest));
}

// Adds a box in which Chebyshev's inequality holds, about `d`.
void tally_moments(inout KernelTally tally, TexelBox box, SubKernel s, float d) {
  ShadowThresholds t = tally.thresholds;
  vec2 centre = 0.5 * vec2(box.low + box.high);
  float second = sub_kernel_second(s);
  float gap = threshold_gap(t, centre, t.near + (d - blocker_distance(s.first, second)) / t.quanta);
#if POOLED
  tally.pooled += box.weight * vec4(s.texels, s.first, second, s.first * gap);
#else
  float inside = kernel_cone_share(tally.cone, vec2(box.low), vec2(box.high), gap);
  float blocked = inside * box.weight * chebyshev_blocked(s.texels, s.first, second);
  tally.blocked += blocked;
  tally.gap += blocked * gap;
#endif
}

// Adds a box from four of its texels: 2 x 2, or 4 in a line.
void tally_texels(inout KernelTally tally, TexelBox box, bool wanted) {
  ShadowThresholds t = tally.thresholds;
  ivec2 extent = box.high - box.low;
  ivec2 taps = extent.x == 1 ? ivec2(1, 4) : extent.y == 1 ? ivec2(4, 1) : ivec2(2);
  float share = 0.25 * box.weight * float(extent.x * extent.y);
  float metres = float(sat_scale(table_format)) / t.quanta;
  int i = wanted ? 0 : 3;
  do {
    ivec2 place = taps.x == 2 ? ivec2(i & 1, i >> 1) : min(ivec2(i), taps - 1);
    ivec2 texel = box.low + (extent * (2 * place + 1)) / (2 * taps);
    float stored = texelFetch(shadow_depth, ivec3(texel, tally.layer), 0).r;
    float depth = t.near + stored * metres;
    vec2 centre = vec2(texel) + 0.5;
    if (wanted && stored < 1.0 && threshold_blocks(t, centre, depth)) {
      float gap = threshold_gap(t, centre, depth);
#if POOLED
      float blocked = share;
#else
      float blocked = share * kernel_cone_share(tally.cone, vec2(texel), vec2(texel + 1), gap);
#endif
      tally.blocked += blocked;
      tally.gap += blocked * gap;
    }
  } while (++i < 4);
}

// Adds one box; true: its mean lies behind the threshold though something in it may block, and nothing was added.
bool tally_box(inout KernelTally tally, TexelBox box, uvec4 s11, uvec4 s01, uvec4 s10, uvec4 s00) {
  ivec2 extent = box.high - box.low;
  PlaceThresholds at = thresholds_at(tally.thresholds, 0.5 * vec2(box.low + box.high));
  float d = min(at.unoccluded, float(sat_scale(table_format)));
  vec2 moments = box_moments(s11, s01, s10, s00, uint(extent.x * extent.y), d);
  at.blocking = min(at.blocking, d);
  at.unoccluded = d;
  SubKernel s = sub_kernel(at, vec2(extent), moments.x, moments.y);
  bool some = min(extent.x, extent.y) > 0 && box.weight > 0.0;
  int kind = some ? sub_kernel_kind(s) : sub_kernel_lit;
  bool in_range = plane_in_range(tally.thresholds, 0.5 * vec2(box.low + box.high), vec2(extent));
  if (kind == sub_kernel_blocked && !in_range) kind = sub_kernel_mixed;
  if (kind == sub_kernel_blocked) tally_moments(tally, box, s, d);
  return kind == sub_kernel_mixed;
}

// Adds what was pooled: once, when all boxes are in.
void tally_pooled(inout KernelTally tally) {
#if POOLED
  float blocked = chebyshev_blocked(tally.pooled.x, tally.pooled.y, tally.pooled.z);
  tally.blocked += blocked;
  if (blocked > 0.0) tally.gap += blocked * tally.pooled.w / tally.pooled.y;
#endif
}

// --- A kernel along both axes ---

struct KernelAxes {
  KernelAxis x;
  KernelAxis y;
};

// whole: with all of every texel that the kernel touches.
KernelAxes kernel_axes(ShadowKernel kernel, int size, bool whole) {
  if (whole) {
    return KernelAxes(kernel_axis_whole(kernel.low.x, kernel.high.x, size),
                      kernel_axis_whole(kernel.low.y, kernel.high.y, size));
  }
  return KernelAxes(kernel_axis(kernel.low.x, kernel.high.x, size), kernel_axis(kernel.low.y, kernel.high.y, size));
}

// First texel of part i of `parts`, where part -1 is the one cut by the kernel's edge; and the weight of part i.
int axis_edge(KernelAxis axis, int i, int parts) {
  return i < 0 ? axis.first - 1 : i > parts ? axis.last + 1 : kernel_part(axis, i, parts);
}
float axis_weight(KernelAxis axis, int i, int parts) { return i < 0 ? axis.before : i < parts ? 1.0 : axis.after; }

// Uniform subdivision (VSSM, section 7.4.2): parts x parts sub-kernels of whole texels and, where rim is 1, those that the
// kernel's edges cut. True: `open`, which is the only whole sub-kernel (parts = 1), needs subdivision and was left out.
bool tally_uniform(inout KernelTally tally, KernelAxes axes, int parts, int rim, bool leave_whole) {
  bool open = false;
  ivec2 count = max(min(ivec2(parts), ivec2(axes.x.last - axes.x.first, axes.y.last - axes.y.first)), ivec2(1));
  int i = -rim;
  do {
    TexelBox box;
    box.low.x = clamp(axis_edge(axes.x, i, count.x), 0, tally.size);
    box.high.x = clamp(axis_edge(axes.x, i + 1, count.x), 0, tally.size);
    float weight = axis_weight(axes.x, i, count.x);
    box.high.y = clamp(axis_edge(axes.y, -rim, count.y), 0, tally.size);
    uvec4 left = table_sums(tally, ivec2(box.low.x, box.high.y));
    uvec4 right = table_sums(tally, box.high);
    int j = -rim;
    do {
      uvec4 s00 = left;
      uvec4 s10 = right;
      box.low.y = box.high.y;
      box.high.y = clamp(axis_edge(axes.y, j + 1, count.y), 0, tally.size);
      box.weight = weight * axis_weight(axes.y, j, count.y);
      left = table_sums(tally, ivec2(box.low.x, box.high.y));
      right = table_sums(tally, box.high);
      bool mixed = tally_box(tally, box, right, left, s10, s00);
      bool whole = leave_whole && i == 0 && j == 0;
      open = open || (mixed && whole);
      tally_texels(tally, box, mixed && !whole);
    } while (++j < count.y + rim);
  } while (++i < count.x + rim);
  return open;
}

// Adaptive subdivision (VSSM, section 7.4.3) of the whole texels: down the quad-tree where neither Chebyshev's inequality
// nor the variance tells, to leaves of 4^-height of the kernel or of 2 x 2 texels.
void tally_adaptive(inout KernelTally tally, KernelAxes axes, int height, bool wanted) {
  uvec2 node = wanted ? quadtree_child(uvec2(0u)) : uvec2(0u, 1u);
  do {
    ivec2 place = quadtree_place(node);
    int parts = 1 << node.x;
    TexelBox box;
    box.low = ivec2(kernel_part(axes.x, place.x, parts), kernel_part(axes.y, place.y, parts));
    box.high = ivec2(kernel_part(axes.x, place.x + 1, parts), kernel_part(axes.y, place.y + 1, parts));
    box.weight = wanted ? 1.0 : 0.0;
    bool mixed = tally_box(tally, box, table_sums(tally, box.high), table_sums(tally, ivec2(box.low.x, box.high.y)),
                           table_sums(tally, ivec2(box.high.x, box.low.y)), table_sums(tally, box.low));
    ivec2 extent = box.high - box.low;
    bool leaf = int(node.x) >= height || max(extent.x, extent.y) <= 2;
    tally_texels(tally, box, mixed && leaf);
    node = mixed && !leaf ? quadtree_child(node) : quadtree_next(node);
  } while (wanted && !quadtree_done(node));
}

#endif  // LIMN_SUB_KERNELS_GLSL
