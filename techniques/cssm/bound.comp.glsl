// The bound of convolution soft shadow maps: the texels and the decisions of visibility.comp.glsl, with what a pixel fixes worked
// out once for it: thresholds are affine in the place but for one division, and kernels at all distances lie between the same two
// rays. A search works out no V. One view sees all of the light, which is a rectangle.
//
// CONTACT: as there.
#include "glsl/shadow/blocker_search.glsl"
#include "glsl/shadow/fourier_lookup.glsl"
#include "glsl/shadow/kernel_blockers.glsl"
#include "glsl/shadow/map_taps.glsl"
#include "glsl/shadow/visibility_main.glsl"

uniform int search_rounds;
uniform int blocker_passes;
uniform int splits;
#if CONTACT == 1
uniform float sharpening;
uniform float falloff;
#endif

const float least_response = max(0.02, 8.0 * FOURIER_NOISE);

// What all parts of a receiver's kernels share. Affine functions of a place, texels, are (value at 0, per texel along u, along v).
struct Receiver {
  BoxRays rays;
  MapTest test;
  vec3 plane;       // inverse depth of the raised tangent plane, 1 / m
  float least;      // of all thresholds: of the receiver's own depth, or the far plane's
  float numerator;  // series depth of a threshold: numerator / inverse depth - offset
  vec3 offset;
  float scale;      // and of a stored depth: scale * stored - origin
  vec3 origin;
  vec2 tilt;        // change of the origin over half a texel
  float depth;      // of the receiver, metres
  float metres;     // of depth per series depth
  float near;
  float range;
  int layer;
  int size;         // texels per side of the map
  bool beneath;     // map_from_beneath()
};

Receiver receiver_at(ShadowCursor cursor, VisibilityQuery q) {
  ShadowView view = cursor.view;
  FourierRange range = fourier_ranges[cursor.layer];
  ShadowThresholds t = shadow_thresholds(view, cursor.receiver, dot(cursor.receiver.normal, shadow_local(view, q.position)),
                                         view.far, range.scale);
  vec2 change = range.scale * vec2(range.change_u, range.change_v);
  Receiver r;
  r.rays = box_rays(view, map_kernel_across(view, light_view_part(q.light), q.position));
  r.test = map_test(cursor);
  r.plane = t.biased;
  r.least = max(t.axis.x, t.least);
  r.numerator = t.quanta;
  r.scale = range.scale;
  r.origin = vec3(range.scale * range.zero - 0.5 * (change.x + change.y), change / float(view.size));
  r.offset = r.origin + vec3(view.near * t.quanta, 0.0, 0.0);
  r.tilt = 0.5 * abs(r.origin.yz);
  r.depth = cursor.in_map.depth;
  r.metres = 1.0 / t.quanta;
  r.near = view.near;
  r.range = view.far - view.near;
  r.layer = int(cursor.layer);
  r.size = int(view.size);
  r.beneath = map_from_beneath(view, cursor.in_map);
  return r;
}

// Series depth below which what lies at a place blocks.
float series_threshold(Receiver r, vec2 place) {
  return r.numerator / max(threshold_value(r.plane, place), r.least) - threshold_value(r.offset, place);
}

// Adds the part low..high, of which `texels` texels count. exponent: of V, CONTACT 1. last: V is wanted. True: none of them
// blocks, but something lies before a greater threshold of the part.
bool add_part(inout KernelBlockers blockers, ShadowCursor cursor, Receiver r, FourierMeans means, vec2 low, vec2 high, float texels,
              float exponent, bool last) {
  vec2 centre = 0.5 * (low + high);
  float middle = series_threshold(r, centre);
  float t00 = series_threshold(r, low);
  float t10 = series_threshold(r, vec2(high.x, low.y));
  float t01 = series_threshold(r, vec2(low.x, high.y));
  float t11 = series_threshold(r, high);
  float most = max(max(max(t00, t10), max(t01, t11)), middle);
  float least = min(min(min(t00, t10), min(t01, t11)), 2.0 * middle - most);
  float before = min(middle - least, FOURIER_TOLERANCE);
  float threshold = clamp(least + before, 0.0, FOURIER_RANGE);
  vec2 stored = kernel_depth_bounds(cursor, ShadowKernel(low, high, 1.0));
  float origin = threshold_value(r.origin, centre);
  float tilt = dot(r.tilt, high - low);
  float nearest = r.scale * stored.x - origin - tilt;
  float behind = max(r.scale * stored.y - origin + tilt - threshold, 0.0);
  float dip = min(FOURIER_LEVEL - FOURIER_CURVATURE * before * before,
                  fourier_step(min(behind, FOURIER_VALLEY - FOURIER_DELTA))) -
              FOURIER_NOISE;
  vec2 sums = fourier_shadow(means, threshold);
  float blocked = 1.0 - sums.x;
  float depth = clamp(sums.y / max(blocked, 1e-6), min(nearest, threshold), threshold);
  float hidden = blocked > 1.0 - dip ? texels * blocked : 0.0;
  if (last) {
    float gain = 0.5 / (dip - 0.5);
    float v = fourier_visibility(sums.x, gain);
#if CONTACT == 1
    v = pow(v, exponent);
#elif CONTACT == 2
    v = fourier_normalised(v, fourier_visibility(fourier_step(depth - threshold), gain), least_response);
#endif
    hidden = texels * (1.0 - v);
  }
  blockers.texels += hidden;
  blockers.gap += hidden * max(r.depth - r.near - (depth + origin) * r.metres, 0.0);
  return hidden == 0.0 && nearest < most;
}

// Adds what texels say of the part low..high, which the kernel covers by `weight`.
void add_quarters(inout KernelBlockers blockers, Receiver r, vec2 low, vec2 high, float weight) {
  vec2 quarter = 0.5 * (high - low);
  for (int i = 0; i < 4; ++i) {
    ivec2 texel = min(ivec2(low + quarter * (vec2(i & 1, i >> 1) + 0.5)), ivec2(r.size - 1));
    float stored = texelFetch(shadow_depth, ivec3(texel, r.layer), 0).r;
    bool blocks = map_test_blocks(r.test, dot(r.test.plane, vec3(texel, 1.0)), stored);
    float hidden = blocks ? weight * quarter.x * quarter.y : 0.0;
    blockers.texels += hidden;
    blockers.gap += hidden * (r.depth - r.near - stored * r.range);
  }
}

// What blocks in the kernel at `gap`.
KernelBlockers kernel_blockers(ShadowCursor cursor, VisibilityQuery q, Receiver r, ShadowKernel kernel, float gap, bool last) {
  KernelBlockers blockers = KernelBlockers(0.0, 0.0);
  float exponent = 1.0;
#if CONTACT == 1
  exponent = fourier_sharpening(gap / r.range * r.scale / FOURIER_RANGE, sharpening, falloff);
#endif
  float size = float(r.size);
  FourierAxis x = fourier_axis(kernel.low.x, kernel.high.x, r.size, splits, !last);
  FourierAxis y = fourier_axis(kernel.low.y, kernel.high.y, r.size, splits, !last);
  int cut = last ? fourier_cut : 0;
  int i = -cut;
  do {
    vec2 low;
    vec2 high;
    low.x = clamp(fourier_part(x, i), 0.0, size);
    high.x = clamp(fourier_part(x, i + 1), 0.0, size);
    float weight = fourier_part_weight(x, i);
    uint crossed = 0u;  // parts of this column that texels answer for, bit by bit
    int j = -cut;
    high.y = clamp(fourier_part(y, j), 0.0, size);
#if FOURIER_SAT
    float scale = float(fourier_sum_scale(r.size * r.size));
    FourierEdge below = fourier_edge(ivec2(low.x, high.x), int(high.y), r.layer);
#endif
    do {
      low.y = high.y;
      high.y = clamp(fourier_part(y, j + 1), 0.0, size);
      float texels = (high.x - low.x) * (high.y - low.y);
#if FOURIER_SAT
      FourierEdge above = below;
      below = fourier_edge(ivec2(low.x, high.x), int(high.y), r.layer);
      FourierMeans means = fourier_means(above, below, texels, scale);
#else
      FourierMeans means = fourier_means(low, high, ivec2(r.size), r.layer);
#endif
      float counted = r.beneath ? 0.0 : texels * weight * fourier_part_weight(y, j);
      bool beyond = add_part(blockers, cursor, r, means, low, high, counted, exponent, last);
      crossed |= r.beneath || (beyond && !q.light.whole) ? 1u << uint(j + cut) : 0u;
    } while (++j < y.parts + cut);
    for (; crossed != 0u; crossed &= crossed - 1u) {
      int part = findLSB(crossed) - cut;
      low.y = clamp(fourier_part(y, part), 0.0, size);
      high.y = clamp(fourier_part(y, part + 1), 0.0, size);
      add_quarters(blockers, r, low, high, weight * fourier_part_weight(y, part));
    }
  } while (++i < x.parts + cut);
  return blockers;
}

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  BlockerSearch search = blocker_search(cursor, q, search_rounds);
  if (search.answer != search_partial) return search.answer == search_lit ? 1.0 : 0.0;
  Receiver r = receiver_at(cursor, q);
  float gap = search.gap;
  int pass = 0;
  do {
    ShadowKernel kernel = rays_box(r.rays, gap, least_kernel_width);
    if (r.beneath) extend_kernel(kernel, shadow_place(cursor, q.position));
    KernelBlockers found = kernel_blockers(cursor, q, r, kernel, gap, false);
    if (found.texels <= 0.0) return 1.0;
    gap = clamp(found.gap / found.texels, 0.0, gap);
  } while (++pass < blocker_passes);
  ShadowKernel kernel = rays_box(r.rays, gap, least_kernel_width);
  vec2 extent = kernel.high - kernel.low;
  float hidden = kernel_blockers(cursor, q, r, kernel, gap, true).texels / (extent.x * extent.y);
  return clamp(1.0 - hidden / light_view_box_share(q.light), 0.0, 1.0);
}
