// What a summed-area table of shadow maps and a few of their texels tell about kernels cut into sub-kernels: which share of
// the light is hidden, and how far what hides it lies from the receiver. For techniques that answer `visibility`.
//
// Define TABLE_FORMAT (sat_format), WIDE_Z 1: sums of z over a sub-kernel may need two words, POOLED 1: Chebyshev's
// inequality once for all sub-kernels with E(z) < d, 0: for each, BOUNDS_DEPTH: see glsl/shadow/blocker_search.glsl.
//
// Loops end in their condition: software renderers run a body once more where it comes first. They run what nobody wants,
// too, so loops of lanes without work take one round.
#ifndef LIMN_SUB_KERNELS_GLSL
#define LIMN_SUB_KERNELS_GLSL
#include "glsl/shadow/blocker_search.glsl"
#include "glsl/shadow/variance_kernel.glsl"
#include "glsl/shadow/visibility.glsl"

// 1: every light has one view, in which its kernels at all distances are scaled copies of each other; 0: not so, as where
// several faces cut them, or a square that faces the receiver is seen at an angle.
#define SIMILAR_KERNELS 0
#if ONE_VIEW && defined(LIGHT_KIND)
#if LIGHT_KIND != 0  // light_kind_point
#undef SIMILAR_KERNELS
#define SIMILAR_KERNELS 1
#endif
#endif

uniform usampler2DArray shadow_table;

const uint table_format = TABLE_FORMAT;
#if !POOLED
uniform float least_gap;  // of the kernel's: nearer blockers hide no more than at that

// Texels: how far kernels reach into texels that their edges cut. A depth is taken at the middle of its texel and stands for
// all of it, so that the edge of what it shows lies anywhere within half a texel of the texel's own edge.
const float edge_blur = 0.5;
#endif

// One pixel's kernels in one view.
struct KernelFamily {
  ShadowThresholds thresholds;
  KernelCone cone;
  bool similar;  // its kernels are those of the cone
#if !SIMILAR_KERNELS
  ShadowView view;
  LightView light;
  vec3 receiver;
  bool whole;  // shadow_kernel()'s
#endif
  float nearest;  // stored in its kernels, quanta
  int size;       // texels per side of the map
  int layer;
  bool beneath;  // map_from_beneath(): only texels tell what blocks
};

KernelFamily kernel_family(ShadowCursor cursor, VisibilityQuery q) {
  KernelFamily f;
  vec3 local = shadow_local(cursor.view, q.position);
  f.thresholds = shadow_thresholds(cursor.view, cursor.receiver, dot(cursor.receiver.normal, local),
                                   cursor.view.far, float(sat_scale(table_format)));
  float towards = shadow_view_axes(cursor.view, q.light.centre).z;
  bool perspective = cursor.view.projection == shadow_perspective;
  float gap = perspective ? 0.5 * q.light.depth : cursor.view.far - cursor.view.near;
  ShadowKernel kernel;
  shadow_kernel(cursor.view, q.light, q.position, gap, true, least_kernel_width, kernel);
  f.cone = kernel_cone(cursor.view, local, towards, kernel.low, kernel.high, gap);
  f.similar = true;
#if !SIMILAR_KERNELS
  f.similar = q.maps.faces == shadow_faces_single && kind_of_light(lights[q.maps.light]) != light_kind_point;
  f.view = cursor.view;
  f.light = q.light;
  f.receiver = q.position;
  f.whole = shadow_views_apart(q.maps.faces);
#endif
  f.nearest = 0.0;
  f.size = int(cursor.view.size);
  f.layer = int(cursor.layer);
  f.beneath = map_from_beneath(cursor.view, cursor.in_map);
  return f;
}

// The kernel at `gap`. searching: as in kernel_in_face(). False: nothing of it lies in this view.
bool family_kernel(KernelFamily f, float gap, bool searching, out ShadowKernel kernel) {
  bool reaching = searching && f.beneath;
  float scale = kernel_cone_scale(f.cone, gap);
  ShadowKernel scaled = ShadowKernel(f.cone.apex + scale * f.cone.low, f.cone.apex + scale * f.cone.high, 1.0);
  widen_kernel(scaled, least_kernel_width);
  if (reaching) extend_kernel(scaled, f.cone.apex);
  kernel = scaled;
#if !SIMILAR_KERNELS
  bool seen = shadow_kernel(f.view, f.light, f.receiver, gap, f.whole || reaching, least_kernel_width, kernel);
  if (reaching) seen = extend_to_receiver(f.view, f.receiver, f.whole, seen, kernel);
  if (!f.similar) return seen;
  kernel = scaled;
#endif
  return true;
}

#if !SIMILAR_KERNELS
// Solid angle, or area, of all of the kernel at `gap`, relative to those at other gaps.
float family_measure(KernelFamily f, float gap) {
  if (f.view.projection != shadow_perspective) return gap * gap;
  vec3 r = f.receiver - f.view.origin;
  vec3 middle = r + gap * f.light.centre;
  float inverse = inversesqrt(max(dot(middle, middle), 1e-30));
  return gap * gap * max(dot(f.light.axis, r) - gap, 0.0) * inverse * inverse * inverse;
}
#endif

// A kernel in one view, and what was found in it.
struct KernelTally {
  float gap;      // the kernel's
  vec2 low;       // what counts of it, texels
  vec2 high;
  float blocked;  // texels
  float reach;    // metres to the receiver along the light's axis, summed over those texels
  vec4 pooled;    // sums over sub-kernels with E(z) < d: texels, first, second, first times the gap of its blockers
};

// Sums over the texels left of and above `at`, 0 <= at <= size.
uvec4 table_sums(KernelFamily f, ivec2 at) {
  uvec4 sums = texelFetch(shadow_table, ivec3(max(at - 1, 0), f.layer), 0);
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
  uint receiver = sat_nearest(d, table_format);
  float rest = d - float(receiver);
  SatBox box = sat_box(sat_unpack(s11, table_format), sat_unpack(s01, table_format), sat_unpack(s10, table_format),
                       sat_unpack(s00, table_format), texels, table_format);
#if WIDE_Z
  SatMoments m = sat_accumulated(SatMoments(0.0, 0.0, 0.0), box, 1.0, receiver, table_format);
#else
  // Sums of z fit one word.
  uint all = texels * receiver;
  uint first = all - box.z.x;
  bool before = all >= box.z.x;
  uvec2 twice = wide_subtract(uvec2(first, before ? 0u : 0xffffffffu), uvec2(box.z.x, 0u));
  uvec2 second = wide_add(wide_multiply(twice, receiver), box.zz);
  SatMoments m;
  m.first = before ? float(first) : -float(0u - first);
  m.second = sat_second(second, m.first, texels, table_format);
#endif
  float n = float(texels);
  return vec2(m.first + n * rest, m.second + rest * (2.0 * m.first + n * rest));
}

#if !POOLED
// Share of the light that what lies in low..high, texels, `gap` metres from the receiver hides, as the number of texels of
// the kernel that would hide as much: it is compared to the kernel at its own gap, the cone to the light cut there.
float hidden_texels(KernelFamily f, KernelTally tally, vec2 low, vec2 high, float gap) {
  ShadowKernel kernel;
  gap = clamp(gap, least_gap * tally.gap, tally.gap);
  bool seen = family_kernel(f, gap, false, kernel);
  vec2 first = max(tally.low, kernel.low - vec2(edge_blur));
  vec2 last = min(tally.high, kernel.high + vec2(edge_blur));
  vec2 extent = max(last - first, vec2(1e-6));
  vec2 inside = max(min(high, last) - max(low, first), vec2(0.0));
  vec2 whole = tally.high - tally.low;
  float magnified = whole.x * whole.y / (extent.x * extent.y);
#if !SIMILAR_KERNELS
  // Another view may hold more of the kernel at the one distance than at the other.
  float most = family_measure(f, tally.gap) / max(family_measure(f, gap), 1e-30);
  magnified = f.similar ? magnified : min(magnified, most);
#endif
  return seen ? inside.x * inside.y * magnified : 0.0;
}
#endif

// Adds a box in which Chebyshev's inequality holds, about `d`.
void tally_moments(inout KernelTally tally, KernelFamily f, TexelBox box, SubKernel s, float d) {
  ShadowThresholds t = f.thresholds;
  vec2 centre = 0.5 * vec2(box.low + box.high);
  float second = sub_kernel_second(s);
  float gap = threshold_gap(t, centre, t.near + (d - blocker_distance(s.first, second)) / t.quanta);
#if POOLED
  tally.pooled += box.weight * vec4(s.texels, s.first, second, s.first * gap);
#else
  float share = min(s.first * s.first / (s.texels * second), 1.0);
  float blocked = share * hidden_texels(f, tally, vec2(box.low), vec2(box.high), gap);
  tally.blocked += blocked;
  tally.reach += blocked * gap;
#endif
}

// Texels that stand for a box: up to 2 x 2, or 4 in a line.
ivec2 box_taps(ivec2 extent) { return min(extent, extent.x == 1 ? ivec2(1, 4) : extent.y == 1 ? ivec2(4, 1) : ivec2(2)); }

// Adds those of one box.
void tally_texels(inout KernelTally tally, KernelFamily f, TexelBox box, bool wanted) {
  ShadowThresholds t = f.thresholds;
  ivec2 extent = box.high - box.low;
  ivec2 taps = max(box_taps(extent), ivec2(1));  // boxes that nobody wants may be empty
  vec2 part = vec2(extent) / vec2(taps);
  float metres = float(sat_scale(table_format)) / t.quanta;
  for (int tap = 0; tap < 4; ++tap) {
    ivec2 place = taps == ivec2(2) ? ivec2(tap & 1, tap >> 1) : min(ivec2(tap), taps - 1);
    vec2 corner = vec2(box.low) + part * vec2(place);
    ivec2 texel = ivec2(corner + 0.5 * part);
    float stored = texelFetch(shadow_depth, ivec3(texel, f.layer), 0).r;
    float depth = t.near + stored * metres;
    vec2 centre = vec2(texel) + 0.5;
    bool blocks = wanted && tap < taps.x * taps.y && stored < 1.0 && threshold_blocks(t, centre, depth);
    float gap = threshold_gap(t, centre, depth);
#if POOLED
    float blocked = box.weight * part.x * part.y;
#else
    float blocked = hidden_texels(f, tally, corner, corner + part, gap);
#endif
    tally.blocked += blocks ? blocked : 0.0;
    tally.reach += blocks ? blocked * gap : 0.0;
  }
}

// Adds one box; true: its mean lies behind the threshold though something in it may block, and nothing was added.
bool tally_box(inout KernelTally tally, KernelFamily f, TexelBox box, uvec4 s11, uvec4 s01, uvec4 s10, uvec4 s00) {
  ivec2 extent = box.high - box.low;
  vec2 centre = 0.5 * vec2(box.low + box.high);
  PlaceThresholds at = thresholds_at(f.thresholds, centre);
  float d = min(at.unoccluded, float(sat_scale(table_format)));
  vec2 moments = box_moments(s11, s01, s10, s00, uint(extent.x * extent.y), d);
  at.blocking = min(at.blocking, d);
  at.unoccluded = d;
  SubKernel s = sub_kernel(at, vec2(extent), moments.x, moments.y);
  bool some = min(extent.x, extent.y) > 0 && box.weight > 0.0;
  int kind = some ? sub_kernel_kind(s) : sub_kernel_lit;
  bool in_range = plane_in_range(f.thresholds, centre, vec2(extent));
  bool told = in_range && !f.beneath;
#if !POOLED
  told = told && !sub_kernel_contradicts(s, d - f.nearest);
#endif
  if (kind == sub_kernel_blocked && !told) kind = sub_kernel_mixed;
  if (some && f.beneath) kind = sub_kernel_mixed;
  if (kind == sub_kernel_blocked) tally_moments(tally, f, box, s, d);
  return kind == sub_kernel_mixed;
}

// Adds what was pooled: once, when all boxes are in.
void tally_pooled(inout KernelTally tally) {
#if POOLED
  float blocked = chebyshev_blocked(tally.pooled.x, tally.pooled.y, tally.pooled.z);
  tally.blocked += blocked;
  if (blocked > 0.0) tally.reach += blocked * tally.pooled.w / tally.pooled.y;
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
bool tally_uniform(inout KernelTally tally, KernelFamily f, KernelAxes axes, int parts, int rim, bool leave_whole,
                   bool wanted) {
  bool open = false;
  ivec2 count = max(min(ivec2(parts), ivec2(axes.x.last - axes.x.first, axes.y.last - axes.y.first)), ivec2(1));
  ivec2 end = wanted ? count + rim : ivec2(1 - rim);
  int rows = parts + 2 * rim;
  int columns = max(whole_quotient(32, rows), 1);
  int i = -rim;
  do {
    // Columns whose sub-kernels have a bit each: few lanes need texels, so they take them together.
    int from = i;
    int till = min(from + columns, end.x);
    uint mixed = 0u;  // sub-kernels of these columns, bit by bit
    TexelBox box;
    do {
      box.low.x = clamp(axis_edge(axes.x, i, count.x), 0, f.size);
      box.high.x = clamp(axis_edge(axes.x, i + 1, count.x), 0, f.size);
      float weight = wanted ? axis_weight(axes.x, i, count.x) : 0.0;
      box.high.y = clamp(axis_edge(axes.y, -rim, count.y), 0, f.size);
      uvec4 left = table_sums(f, ivec2(box.low.x, box.high.y));
      uvec4 right = table_sums(f, box.high);
      int j = -rim;
      do {
        uvec4 s00 = left;
        uvec4 s10 = right;
        box.low.y = box.high.y;
        box.high.y = clamp(axis_edge(axes.y, j + 1, count.y), 0, f.size);
        box.weight = weight * axis_weight(axes.y, j, count.y);
        left = table_sums(f, ivec2(box.low.x, box.high.y));
        right = table_sums(f, box.high);
        bool undecided = tally_box(tally, f, box, right, left, s10, s00);
        bool whole = leave_whole && i == 0 && j == 0;
        open = open || (undecided && whole);
        mixed |= undecided && !whole ? 1u << uint((i - from) * rows + j + rim) : 0u;
      } while (++j < end.y);
    } while (++i < till);
    do {
      int bit = findLSB(mixed | 0x80000000u);
      int column = whole_quotient(bit, rows);
      ivec2 place = ivec2(from + column, bit - column * rows - rim);
      box.low = ivec2(axis_edge(axes.x, place.x, count.x), axis_edge(axes.y, place.y, count.y));
      box.high = ivec2(axis_edge(axes.x, place.x + 1, count.x), axis_edge(axes.y, place.y + 1, count.y));
      box.low = clamp(box.low, ivec2(0), ivec2(f.size));
      box.high = clamp(box.high, ivec2(0), ivec2(f.size));
      box.weight = axis_weight(axes.x, place.x, count.x) * axis_weight(axes.y, place.y, count.y);
      tally_texels(tally, f, box, mixed != 0u);
      mixed &= mixed - 1u;
    } while (mixed != 0u);
  } while (i < end.x);
  return open;
}

// Adaptive subdivision (VSSM, section 7.4.3) of the whole texels: down the quad-tree where neither Chebyshev's inequality
// nor the variance tells, to leaves of 4^-height of the kernel or of 2 x 2 texels.
void tally_adaptive(inout KernelTally tally, KernelFamily f, KernelAxes axes, int height, bool wanted) {
  uvec2 node = wanted ? quadtree_child(uvec2(0u)) : uvec2(0u, 1u);
  do {
    ivec2 place = quadtree_place(node);
    int parts = 1 << node.x;
    TexelBox box;
    box.low = ivec2(kernel_part(axes.x, place.x, parts), kernel_part(axes.y, place.y, parts));
    box.high = ivec2(kernel_part(axes.x, place.x + 1, parts), kernel_part(axes.y, place.y + 1, parts));
    box.weight = wanted ? 1.0 : 0.0;
    bool mixed = tally_box(tally, f, box, table_sums(f, box.high), table_sums(f, ivec2(box.low.x, box.high.y)),
                           table_sums(f, ivec2(box.high.x, box.low.y)), table_sums(f, box.low));
    ivec2 extent = box.high - box.low;
    bool leaf = int(node.x) >= height || max(extent.x, extent.y) <= 2;
    tally_texels(tally, f, box, mixed && leaf);
    node = mixed && !leaf ? quadtree_child(node) : quadtree_next(node);
  } while (wanted && !quadtree_done(node));
}

// --- The blocker search ---

// What the bounds of the depths in a kernel tell (glsl/shadow/blocker_search.glsl), from the prepared thresholds.
struct KernelBounds {
  bool lit;
  bool umbra;
  float gap;    // no blocker in the kernel is farther from the receiver, metres
  vec2 depths;  // least and greatest stored in the kernel, metres
};

KernelBounds family_bounds(KernelFamily f, ShadowCursor cursor, ShadowKernel kernel) {
  ShadowThresholds t = f.thresholds;
  vec2 stored = kernel_depth_bounds(cursor, kernel);
  float least = shadow_metres(cursor.view, stored.x);
  float greatest = shadow_metres(cursor.view, stored.y);
  ShadowKernel centres = kernel_centres(cursor, kernel);
  vec2 plane = threshold_range(t.biased, centres.low, centres.high);
  vec2 axis = threshold_range(t.axis, centres.low, centres.high);
  KernelBounds bounds;
  bounds.lit = stored.x >= 1.0 || !threshold_nearer(t, least, max(plane.x, axis.x));
  bounds.umbra = !f.beneath && stored.y < 1.0 && threshold_nearer(t, greatest, max(plane.y, axis.y));
  bounds.gap = t.gap.x + t.gap.y * (t.inverse ? least * axis.x : least + axis.x);
  bounds.depths = vec2(least, greatest);
  return bounds;
}

#endif  // LIMN_SUB_KERNELS_GLSL
