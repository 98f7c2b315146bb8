// Convolution soft shadow maps (thesis, chapter 5): percentage-closer soft shadows whose two averages come from
// prefiltered Fourier basis images. CONTACT: of blockers close to the receiver, to which the series answers only in part.
// 0: V as it is; 1: sharpened, as published; 2: normalised by what a blocker at the mean depth of the part gives.
//
// Loops end in their condition: software renderers run a body once more where it comes first.
//
// Without the whole bias planes that a hemicube light grazes shadow themselves, V down to 0.06.
#define WHOLE_BIAS (1 - ONE_VIEW)
#include "glsl/shadow/blocker_search.glsl"
#include "glsl/shadow/fourier_lookup.glsl"
#include "glsl/shadow/light_kernels.glsl"
#include "glsl/shadow/visibility_main.glsl"

uniform int search_rounds;
uniform int blocker_passes;
uniform int splits;       // of a kernel per axis, each part with a threshold of its own
#if CONTACT == 1
uniform float sharpening;
uniform float falloff;
#endif

// Blockers so close to the receiver that the series answers them with less are not made up for.
const float least_response = max(0.02, 8.0 * FOURIER_NOISE);

// What all parts of a kernel share.
struct KernelView {
  ShadowThresholds thresholds;
  FourierRange range;
  int layer;
  float size;        // texels per side of the map
  float sharpening;  // exponent of V, CONTACT 1
  bool beneath;      // map_from_beneath(): only texels tell what blocks
};

KernelView kernel_view(ShadowCursor cursor, VisibilityQuery q, float gap) {
  KernelView k;
  vec3 local = shadow_local(cursor.view, q.position);
  k.thresholds = shadow_thresholds(cursor.view, cursor.receiver, dot(cursor.receiver.normal, local),
                                   cursor.view.far, 1.0);
  k.range = fourier_ranges[cursor.layer];
  k.layer = int(cursor.layer);
  k.size = float(cursor.view.size);
  k.beneath = map_from_beneath(cursor.view, cursor.in_map);
#if CONTACT == 1
  // From the blockers to the receiver along the map's depth.
  float distance = shadow_normalise(cursor.view, gap) - shadow_normalise(cursor.view, 0.0);
  k.sharpening = fourier_sharpening(distance * k.range.scale / FOURIER_RANGE, sharpening, falloff);
#endif
  return k;
}

// Series depth below which what lies at a place blocks.
float series_threshold(KernelView k, vec2 texel) {
  ShadowThresholds t = k.thresholds;
  float depth = threshold_depth(t, max(threshold_value(t.biased, texel), threshold_value(t.axis, texel)));
  return fourier_depth(k.range, texel / k.size, min((depth - t.near) * t.quanta, 1.0));
}

// How the series takes a box of texels.
struct PartDepths {
  float threshold;  // series depth below which texels block
  float least;      // bound of the depths in it, at most the threshold
  float dip;        // least s that it has where nothing in it blocks
  bool beyond;      // something in it lies before the greatest threshold at its corners
};

PartDepths part_depths(ShadowCursor cursor, KernelView k, vec2 low, vec2 high) {
  PartDepths part;
  // The threshold varies over the part, which takes but one: the middle one, unless a lit plane would then span more
  // depth within the part than ringing suppression absorbs. least bounds convex thresholds as well: tangent planes in
  // perspective.
  vec2 centre = 0.5 * (low + high);
  float middle = series_threshold(k, centre);
  float t00 = series_threshold(k, low);
  float t10 = series_threshold(k, vec2(high.x, low.y));
  float t01 = series_threshold(k, vec2(low.x, high.y));
  float t11 = series_threshold(k, high);
  float most = max(max(max(t00, t10), max(t01, t11)), middle);
  float least = min(min(min(t00, t10), min(t01, t11)), 2.0 * middle - most);
  float before = min(middle - least, FOURIER_TOLERANCE);
  part.threshold = clamp(least + before, 0.0, FOURIER_RANGE);
  vec2 bounds = kernel_depth_bounds(cursor, ShadowKernel(low, high, 1.0));
  vec2 uv = centre / k.size;
  float tilt = k.range.scale * 0.5 * dot(abs(vec2(k.range.change_u, k.range.change_v)), (high - low) / k.size);
  float nearest = fourier_depth(k.range, uv, bounds.x) - tilt;
  part.least = min(nearest, part.threshold);
  part.beyond = nearest < most;
  float behind = max(fourier_depth(k.range, uv, bounds.y) + tilt - part.threshold, 0.0);
  part.dip = min(FOURIER_LEVEL - FOURIER_CURVATURE * before * before,
                 fourier_step(min(behind, FOURIER_VALLEY - FOURIER_DELTA))) -
             FOURIER_NOISE;
  return part;
}

// Adds `texels` texels about `centre`: to a search those that block as the series sees them, to V those that hide light after
// ringing suppression and contact. True: there are none of them, but something lies before a greater threshold of the part.
bool add_part(inout KernelBlockers blockers, KernelView k, PartDepths part, FourierMeans means, vec2 centre, float texels,
              int use) {
  vec2 sums = fourier_shadow(means, part.threshold);
  float blocked = 1.0 - sums.x;
  float depth = clamp(sums.y / max(blocked, 1e-6), part.least, part.threshold);
  // Stages 1 and 2, unless a lit part may give as much.
  float counted = blocked > 1.0 - part.dip ? texels * blocked : 0.0;
  float stored = fourier_stored(k.range, centre / k.size, depth);
  float gap = threshold_gap(k.thresholds, centre, k.thresholds.near + stored / k.thresholds.quanta);
  // Stage 3.
  float gain = 0.5 / (part.dip - 0.5);
  float v = fourier_visibility(sums.x, gain);
#if CONTACT == 1
  v = pow(v, k.sharpening);
#elif CONTACT == 2
  v = fourier_normalised(v, fourier_visibility(fourier_step(depth - part.threshold), gain), least_response);
#endif
  float hidden = use == kernel_search ? counted : texels * (1.0 - v);
  blockers.texels += hidden;
  blockers.gap += hidden * max(gap, 0.0);
  return hidden == 0.0 && part.beyond;
}

// Adds what texels say of the part low..high, which the kernel covers by `weight`.
void add_quarters(inout KernelBlockers blockers, ShadowCursor cursor, vec2 low, vec2 high, float weight) {
  for (int i = 0; i < 4; ++i) {
    PartQuarter part = part_quarter(cursor, low, high, i);
    vec2 extent = part.high - part.low;
    float hidden = part.tap.blocked ? weight * extent.x * extent.y : 0.0;
    blockers.texels += hidden;
    blockers.gap += hidden * map_gap(cursor.view, cursor.in_map, part.tap.texel, part.tap.depth);
  }
}

// The parts of a kernel in one view.
KernelBlockers kernel_blockers(ShadowCursor cursor, VisibilityQuery q, inout ShadowKernel kernel, float gap, int use) {
  KernelBlockers blockers = KernelBlockers(0.0, 0.0);
  KernelView k = kernel_view(cursor, q, gap);
  ivec2 size = ivec2(cursor.view.size);
  bool whole = use == kernel_search;
  FourierAxis x = fourier_axis(kernel.low.x, kernel.high.x, size.x, splits, whole);
  FourierAxis y = fourier_axis(kernel.low.y, kernel.high.y, size.y, splits, whole);
  int cut = whole ? 0 : fourier_cut;
  int i = -cut;
  do {
    vec2 low;
    vec2 high;
    low.x = clamp(fourier_part(x, i), 0.0, k.size);
    high.x = clamp(fourier_part(x, i + 1), 0.0, k.size);
    float weight = fourier_part_weight(x, i);
    // Parts of this column that texels answer for, bit by bit: few pixels need texels, so they take them together.
    uint crossed = 0u;
    int j = -cut;
    high.y = clamp(fourier_part(y, j), 0.0, k.size);
#if FOURIER_SAT
    float scale = float(fourier_sum_scale(size.x * size.y));
    FourierEdge below = fourier_edge(ivec2(low.x, high.x), int(high.y), k.layer);
#endif
    do {
      low.y = high.y;
      high.y = clamp(fourier_part(y, j + 1), 0.0, k.size);
      float texels = (high.x - low.x) * (high.y - low.y);
#if FOURIER_SAT
      FourierEdge above = below;
      below = fourier_edge(ivec2(low.x, high.x), int(high.y), k.layer);
      FourierMeans means = fourier_means(above, below, texels, scale);
#else
      FourierMeans means = fourier_means(low, high, size, k.layer);
#endif
      float counted = k.beneath ? 0.0 : texels * weight * fourier_part_weight(y, j);
      bool beyond = add_part(blockers, k, part_depths(cursor, k, low, high), means, 0.5 * (low + high), counted, use);
      crossed |= k.beneath || (beyond && !q.light.whole) ? 1u << uint(j + cut) : 0u;
    } while (++j < y.parts + cut);
    for (; crossed != 0u; crossed &= crossed - 1u) {
      int part = findLSB(crossed) - cut;
      low.y = clamp(fourier_part(y, part), 0.0, k.size);
      high.y = clamp(fourier_part(y, part + 1), 0.0, k.size);
      add_quarters(blockers, cursor, low, high, weight * fourier_part_weight(y, part));
    }
  } while (++i < x.parts + cut);
  return blockers;
}

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  BlockerSearch search = blocker_search(cursor, q, search_rounds);
  bool open = search.answer == search_partial;
  float v = search.answer == search_umbra ? 0.0 : 1.0;
  float gap = search.gap;
  int pass = 0;
  do {
    bool last = pass == blocker_passes;
    Blockers found = blockers_at(cursor, q, gap, least_kernel_width, last ? kernel_filter : kernel_search, open);
    // The kernel is a box around what of the light counts; what blocks hides none of the rest.
    if (open && last) v = clamp(1.0 - found.share / light_view_box_share(q.light), 0.0, 1.0);
    open = open && found.texels > 0.0 && !last;
    gap = open ? found.gap : gap;
  } while (open && ++pass <= blocker_passes);
  return v;
}
