// Fourier series of the shadow test (thesis, chapter 5; Annen et al. 2007 and 2008): the step is expanded in sines of
// period 2, each of which splits into a factor of the receiver's depth and one of the stored depth, so that the latter
// can be filtered beforehand. Depths in the series are those of fourier_depth(): 0 to R, R = 1 - 2 delta.
//
// With c_k = pi (2 k - 1) and weights u_k = 2 g_k / c_k (g_k: fourier_window), k = 1..M,
//   S(x) = 1/2 + sum u_k sin(c_k x)
//   s    = 1/2 + sum u_k (cos(c_k d) [sin c_k z] - sin(c_k d) [cos c_k z])          mean of S(z - d): share that is lit
//   n    = [z]/2 - sum u_k (cos(c_k d) [z sin c_k z] - sin(c_k d) [z cos c_k z])    mean of (1 - S(z - d)) z
// where [] is a filtered basis image. Both are taken at d - delta, the first root of S(x) = 1, so that what lies at or
// behind the receiver counts as lit in full and z_avg = n / (1 - s) holds blockers alone.
//
// The images of the terms 2 g + 1 and 2 g + 2 share a texel of group g: (sin, cos, sin, cos).
#ifndef LIMN_FOURIER_SHADOW_GLSL
#define LIMN_FOURIER_SHADOW_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

LIMN_CONST uint fourier_window_none = 0u;
LIMN_CONST uint fourier_window_lanczos = 1u;
LIMN_CONST uint fourier_window_fejer = 2u;

// g_k in (0, 1], 1 <= k <= order.
LIMN_FN float fourier_window(int k, int order, uint window) {
  float u = float(2 * k - 1) / float(2 * order);
  if (window == fourier_window_lanczos) return sin(pi * u) / (pi * u);
  return window == fourier_window_fejer ? 1.0f - u : 1.0f;
}

// u_k; 0 beyond the order.
LIMN_FN float fourier_weight(int k, int order, uint window) {
  return k > order ? 0.0f : 2.0f * fourier_window(k, order, window) / (pi * float(2 * k - 1));
}

// --- Depths of one map ---

// What of a map's depth the series spans: the stored depth less a plane over the map, scaled to [0, R]. Order along
// each ray is kept, so that comparisons are, too.
struct FourierRange {
  float zero;      // stored depth that becomes 0, at the map's centre
  float change_u;  // of that depth per uv
  float change_v;
  float scale;  // > 0
};

LIMN_FN float fourier_origin(FourierRange range, vec2 uv) {
  return range.zero + range.change_u * (uv.x - 0.5f) + range.change_v * (uv.y - 0.5f);
}

// A stored depth at uv; not limited.
LIMN_FN float fourier_depth(FourierRange range, vec2 uv, float stored) {
  return (stored - fourier_origin(range, uv)) * range.scale;
}

LIMN_FN float fourier_stored(FourierRange range, vec2 uv, float depth) {
  return fourier_origin(range, uv) + depth / range.scale;
}

// The same as texels of the basis images hold it: in [0, R], R where nothing is.
LIMN_FN float fourier_texel_depth(FourierRange range, vec2 uv, float stored, float most) {
  return stored < 1.0f ? clamp(fourier_depth(range, uv, stored), 0.0f, most) : most;
}

// --- The series ---

// (cos, sin) of c_k x.
LIMN_FN vec2 fourier_phase(int k, float x) {
  float angle = pi * float(2 * k - 1) * x;
  return vec2(cos(angle), sin(angle));
}

// (cos, sin) of 2 pi x, from those of c_1 x: what lies between c_k x and c_(k+1) x.
LIMN_FN vec2 fourier_phase_step(vec2 first) {
  return vec2(first.x * first.x - first.y * first.y, 2.0f * first.x * first.y);
}

// From c_k x to c_(k+1) x, step = (cos, sin) of 2 pi x.
LIMN_FN vec2 fourier_next_phase(vec2 phase, vec2 step) {
  return vec2(phase.x * step.x - phase.y * step.y, phase.x * step.y + phase.y * step.x);
}

// A texel of the basis images: terms k and k + 1.
LIMN_FN vec4 fourier_basis(vec2 phase, vec2 next) { return vec4(phase.y, phase.x, next.y, next.x); }

// What a group adds to s - 1/2 (basis images), or takes from n (those times z): phases of the receiver's depth and
// weights of its two terms.
LIMN_FN float fourier_terms(vec4 basis, vec2 phase, vec2 next, vec2 weights) {
  return weights.x * (phase.x * basis.x - phase.y * basis.y) + weights.y * (next.x * basis.z - next.y * basis.w);
}

// --- From s to V ---

// Ringing suppression: exactly 1 where all lies at or behind the receiver, exactly 0 where all lies 2 delta before it.
LIMN_FN float fourier_visibility(float s, float gain) { return clamp(0.5f + gain * (s - 0.5f), 0.0f, 1.0f); }

// Exponent of V (thesis, eq. 5.9); gap: d - z_avg as a share of the range.
LIMN_FN float fourier_sharpening(float gap, float strength, float falloff) {
  return 1.0f + strength * exp(-falloff * gap);
}

// V of a share b of blockers at one depth is 1 - b (1 - v), v: what the series gives where all blocks. From V and v: 1 - b.
// least: of 1 - v, below which noise would show.
LIMN_FN float fourier_normalised(float visibility, float blocked, float least) {
  return clamp(1.0f - (1.0f - visibility) / max(1.0f - blocked, least), 0.0f, 1.0f);
}

// --- Filters ---

// Level of detail at which a trilinear fetch has the second moment of a box of `width` texels: bilinear fetches have
// r^2 = 1 and 4 times 4^k width^2 / 3 at the levels k and k + 1.
LIMN_FN float fourier_lod(float width) {
  float r = width * 0.577350269f;
  if (r < 1.0f) return 0.0f;
  float level = floor(log2(r));
  float ratio = r * exp2(-level);
  return level + (ratio * ratio - 1.0f) / 3.0f;
}

// Bits of a quantised basis value, so that sums over `texels` texels fit 32-bit signed words.
LIMN_FN int fourier_sum_bits(int texels) { return clamp(31 - findMSB(uint(max(texels - 1, 1))), 2, 24); }

// Largest quantised value: of 1.
LIMN_FN int fourier_sum_scale(int texels) { return (1 << (fourier_sum_bits(texels) - 1)) - 1; }

LIMN_END
#endif  // LIMN_FOURIER_SHADOW_GLSL
