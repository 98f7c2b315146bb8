// Convolution soft shadow maps (thesis, chapter 5): percentage-closer soft shadows whose two averages come from
// prefiltered Fourier basis images. CONTACT: of blockers close to the receiver, to which the series answers only in part.
// 0: V as it is; 1: sharpened, as published; 2: normalised by what a blocker at the mean depth of the part gives.
#include "glsl/blocker_search.glsl"
#include "glsl/fourier_lookup.glsl"
#include "glsl/visibility_main.glsl"

uniform int search_rounds;
uniform int blocker_passes;
uniform int splits;       // of a kernel per axis, each part with a threshold of its own
#if CONTACT == 1
uniform float sharpening;
uniform float falloff;
#endif

// Blockers so close to the receiver that the series answers them with less are not made up for.
const float least_response = max(0.02, 8.0 * FOURIER_NOISE);

// Part (i, j) of a kernel, cut to the map; what lies outside is lit.
struct KernelPart {
  bool inside;       // some of it lies in the map
  float share;       // of the part that does
  float threshold;   // series depth below which texels block
  float least;       // bound of the depths in it, at most the threshold
  float dip;         // least s that it has where nothing in it blocks
  FourierRange range;
  vec2 uv;           // its centre
  FourierBox box;
  ShadowKernel kernel;
};

KernelPart kernel_part(ShadowCursor cursor, ShadowKernel kernel, ivec2 index) {
  KernelPart part;
  vec2 extent = (kernel.high - kernel.low) / float(splits);
  vec2 low = kernel.low + vec2(index) * extent;
  vec2 high = low + extent;
  float size = float(cursor.view.info.z);
  part.kernel.low = clamp(low, vec2(0.0), vec2(size));
  part.kernel.high = clamp(high, vec2(0.0), vec2(size));
  vec2 cut = part.kernel.high - part.kernel.low;
  part.share = clamp(cut.x * cut.y / max(extent.x * extent.y, 1e-20), 0.0, 1.0);
  part.inside = part.share > 0.0;
  if (!part.inside) return part;
  part.uv = 0.5 * (part.kernel.low + part.kernel.high) / size;
  part.range = fourier_ranges[cursor.layer];
  // The threshold varies over the kernel, which takes but one: the middle one, unless a lit plane would then span more
  // depth within the kernel than ringing suppression absorbs. least bounds convex thresholds as well: tangent planes in
  // perspective.
  float middle = fourier_depth(part.range, part.uv, shadow_threshold(cursor.view, cursor.receiver, part.uv));
  float least = middle;
  float most = middle;
  for (int i = 0; i < 4; ++i) {
    vec2 at = vec2((i & 1) == 0 ? part.kernel.low.x : part.kernel.high.x,
                   (i & 2) == 0 ? part.kernel.low.y : part.kernel.high.y) / size;
    float t = fourier_depth(part.range, at, shadow_threshold(cursor.view, cursor.receiver, at));
    least = min(least, t);
    most = max(most, t);
  }
  least = min(least, 2.0 * middle - most);
  float before = min(middle - least, FOURIER_TOLERANCE);
  part.threshold = clamp(least + before, 0.0, FOURIER_RANGE);
  vec2 bounds = kernel_depth_bounds(cursor, part.kernel);
  float tilt = part.range.plane.w * 0.5 * dot(abs(part.range.plane.yz), cut / size);
  part.least = min(fourier_depth(part.range, part.uv, bounds.x) - tilt, part.threshold);
  float behind = max(fourier_depth(part.range, part.uv, bounds.y) + tilt - part.threshold, 0.0);
  part.dip = min(FOURIER_LEVEL - FOURIER_CURVATURE * before * before,
                 fourier_step(min(behind, FOURIER_VALLEY - FOURIER_DELTA))) -
             FOURIER_NOISE;
  part.box = fourier_box(part.kernel.low, part.kernel.high, ivec2(cursor.view.info.z));
  return part;
}

// Stages 1 and 2 for one face: (1 - s, times the mean gap of the blockers in metres).
vec2 blockers(ShadowCursor cursor, ShadowKernel kernel) {
  vec2 sum = vec2(0.0);
  for (int i = 0; i < splits * splits; ++i) {
    KernelPart part = kernel_part(cursor, kernel, ivec2(i % splits, i / splits));
    if (!part.inside) continue;
    float blocked = 1.0 - fourier_lit(part.box, int(cursor.layer), part.threshold);
    if (blocked <= 1.0 - part.dip) continue;  // as a lit kernel may give
    float depth = fourier_blocked_depth(part.box, int(cursor.layer), part.threshold) / blocked;
    depth = clamp(depth, part.least, part.threshold);
    float gap = shadow_gap(cursor.view, cursor.receiver, part.uv, fourier_stored(part.range, part.uv, depth));
    sum += part.share * blocked * vec2(1.0, max(gap, 0.0));
  }
  return sum / float(splits * splits);
}

// Stage 3 for one face: the lit share of the penumbra kernel, whose blockers lie `gap` metres before the receiver.
float filtered(ShadowCursor cursor, ShadowKernel kernel, float gap) {
  float sum = 0.0;
  for (int i = 0; i < splits * splits; ++i) {
    KernelPart part = kernel_part(cursor, kernel, ivec2(i % splits, i / splits));
    float v = 1.0;
    if (part.inside) {
      float s = fourier_lit(part.box, int(cursor.layer), part.threshold);
      float gain = 0.5 / (part.dip - 0.5);
      v = fourier_visibility(s, gain);
      // From the blockers to the receiver along the map's depth.
#if CONTACT == 1
      float distance = shadow_normalise(cursor.view, gap) - shadow_normalise(cursor.view, 0.0);
      v = pow(v, fourier_sharpening(distance * part.range.plane.w / FOURIER_RANGE, sharpening, falloff));
#elif CONTACT == 2
      float depth = fourier_blocked_depth(part.box, int(cursor.layer), part.threshold) / max(1.0 - s, 1e-6);
      float distance = part.threshold - clamp(depth, part.least, part.threshold);
      v = fourier_normalised(v, fourier_visibility(fourier_step(-distance), gain), least_response);
#endif
      v = mix(1.0, v, part.share);
    }
    sum += v;
  }
  return sum / float(splits * splits);
}

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  BlockerSearch search = blocker_search(cursor, q, search_rounds);
  if (search.answer != search_partial) return search.answer == search_lit ? 1.0 : 0.0;
  float gap = search.gap;
  for (int i = 0; i < blocker_passes; ++i) {
    vec2 found = vec2(0.0);
    for (uint face = 0u; face < shadow_face_count(q.maps.info.y); ++face) {
      ShadowKernel kernel;
      if (shadow_kernel_in_face(cursor, q, face, gap, kernel)) found += kernel.weight * blockers(cursor, kernel);
    }
    if (!(found.x > 0.0)) return 1.0;
    gap = clamp(found.y / found.x, 0.0, gap);
  }
  float lit = 0.0;
  float weight = 0.0;
  for (uint face = 0u; face < shadow_face_count(q.maps.info.y); ++face) {
    ShadowKernel kernel;
    if (!shadow_kernel_in_face(cursor, q, face, gap, kernel)) continue;
    lit += kernel.weight * filtered(cursor, kernel, gap);
    weight += kernel.weight;
  }
  return weight > 0.0 ? lit / weight : 1.0;
}
