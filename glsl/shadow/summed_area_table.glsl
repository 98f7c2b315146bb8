// Integer summed-area tables of shadow maps (shadow::DerivedMaps): exact sums of depth z and z^2 over boxes of texels,
// and from them the moments of d - z about a receiver's depth d, formed in integers because in floating point the
// difference E(z^2) - E(z)^2 cancels.
//
// Depths are quantised to Z = round(z M), M = 2^bits - 1; the quantum is q = 1 / M. A texel of the table holds the sums
// over all texels left of, above and at it, modulo 2^32 per word. Differences of such sums are exact, whatever the
// table's size, while the sum within one box stays below 2^32 or 2^64: sat_largest_box().
#ifndef LIMN_SUMMED_AREA_TABLE_GLSL
#define LIMN_SUMMED_AREA_TABLE_GLSL
#include "glsl/numeric/language.glsl"
// Every compiler is to quantise alike: no fused multiply and add.
#ifdef __cplusplus
#define SAT_PRECISE
#else
#define SAT_PRECISE precise
#endif
LIMN_BEGIN

// --- 64-bit integers: (low word, high word), two's complement, modulo 2^64 ---

LIMN_FN uvec2 wide_add(uvec2 a, uvec2 b) {
  uint carry;
  uint low = uaddCarry(a.x, b.x, carry);
  return uvec2(low, a.y + b.y + carry);
}

LIMN_FN uvec2 wide_subtract(uvec2 a, uvec2 b) {
  return uvec2(a.x - b.x, a.y - b.y - uint(a.x < b.x));
}

LIMN_FN uvec2 wide_multiply(uvec2 a, uint b) {
  uint high;
  uint low;
  umulExtended(a.x, b, high, low);
  return uvec2(low, high + a.y * b);
}

LIMN_FN float wide_unsigned_float(uvec2 a) { return float(a.y) * 4294967296.0f + float(a.x); }

LIMN_FN float wide_signed_float(uvec2 a) {
  bool negative = (a.y & 0x80000000u) != 0u;
  float magnitude = wide_unsigned_float(negative ? wide_subtract(uvec2(0u), a) : a);
  return negative ? -magnitude : magnitude;
}

// --- Format of a table: what its texels hold, as one number for a uniform, or a constant that spares the branches ---

// bits: of Z, 8 to 24. words: 32-bit words per moment, 1 or 2. squares: 1 if z^2 is there as well, else 0.
// Texels: z in 1 word: R32UI. z in 2: RG32UI (low, high). z and z^2 in 1: RG32UI, with z^2 rounded to `bits` bits. Both
// in 2: RGBA32UI (z low, z^2 low, z^2 high, z high).
LIMN_FN uint sat_format(uint bits, uint words, uint squares) { return bits | words << 8u | squares << 16u; }
LIMN_FN uint sat_bits(uint format) { return format & 255u; }
LIMN_FN bool sat_two_words(uint format) { return (format >> 8u & 255u) == 2u; }
LIMN_FN bool sat_has_squares(uint format) { return format >> 16u != 0u; }
// M: the largest Z.
LIMN_FN uint sat_scale(uint format) { return (1u << sat_bits(format)) - 1u; }

// Texels in a box up to which every sum in the table is exact.
LIMN_FN uint sat_largest_box(uint format) {
  uint scale = sat_scale(format);
  if (!sat_two_words(format)) return 4294967295u / scale;
  if (!sat_has_squares(format)) return 4294967295u;
  // (2^64 - 1) / M^2 = 2^(64 - 2 bits) + 2^(65 - 3 bits) + terms below 1 / 2
  uint bits = sat_bits(format);
  if (bits <= 16u) return 4294967295u;
  return (1u << (64u - 2u * bits)) + (bits <= 21u ? 1u << (65u - 3u * bits) : 0u);
}

// Nearest Z to a depth; what is not within [0, 1] or not a number becomes 0 or M.
LIMN_FN uint sat_quantise(float z, uint format) {
  float limited = z < 1.0f ? max(z, 0.0f) : 1.0f;
  float scaled = limited * float(sat_scale(format));
  uint whole = uint(scaled);  // adding 1/2 first would round twice
  SAT_PRECISE float rest = scaled - float(whole);
  return min(whole + uint(rest >= 0.5f), sat_scale(format));
}

// Nearest Z to a depth in quanta, >= 0. Adding 1/2 to the largest of 24 bits rounds to more than Z may be.
LIMN_FN uint sat_nearest(float quanta, uint format) { return min(uint(quanta + 0.5f), sat_scale(format)); }

// --- Sums: (z low, z^2 low, z^2 high, z high) while they are computed, packed as `format` says when stored ---

// The sums over one texel.
LIMN_FN uvec4 sat_texel(float z, uint format) {
  uint value = sat_quantise(z, format);
  uvec2 square = wide_multiply(uvec2(value, 0u), value);
  if (!sat_two_words(format)) {
    // round(Z^2 / M) without a division: a 2^bits + b = a M + (a + b).
    uint scale = sat_scale(format);
    uint bits = sat_bits(format);
    uvec2 product = wide_add(square, uvec2(scale / 2u, 0u));
    uint quotient = (product.x >> bits) | (product.y << (32u - bits));
    uint rest = (product.x & scale) + quotient;
    square = uvec2(quotient + uint(rest >= scale), 0u);
  }
  return uvec4(value, square.x, square.y, 0u);
}

LIMN_FN uvec4 sat_add(uvec4 a, uvec4 b) {
  uvec2 z = wide_add(uvec2(a.x, a.w), uvec2(b.x, b.w));
  uvec2 zz = wide_add(uvec2(a.y, a.z), uvec2(b.y, b.z));
  return uvec4(z.x, zz.x, zz.y, z.y);
}

// Sums to the components of a texel, and back; words that are not stored are 0.
LIMN_FN uvec4 sat_pack(uvec4 sums, uint format) {
  if (!sat_two_words(format)) return uvec4(sums.x, sat_has_squares(format) ? sums.y : 0u, 0u, 0u);
  return sat_has_squares(format) ? sums : uvec4(sums.x, sums.w, 0u, 0u);
}
LIMN_FN uvec4 sat_unpack(uvec4 texel, uint format) {
  if (!sat_two_words(format)) return uvec4(texel.x, sat_has_squares(format) ? texel.y : 0u, 0u, 0u);
  return sat_has_squares(format) ? texel : uvec4(texel.x, 0u, 0u, texel.y);
}

// --- Boxes ---

struct SatBox {
  uint texels;
  uvec2 z;   // sum of Z, 64 bit
  uvec2 zz;  // sum of Z^2, 64 bit
};

// The box [x0, x1) x [y0, y1) of `texels` texels, from the unpacked sums at (x1, y1), (x0, y1), (x1, y0) and (x0, y0),
// where (x, y) stands for all texels left of x and above y.
LIMN_FN SatBox sat_box(uvec4 s11, uvec4 s01, uvec4 s10, uvec4 s00, uint texels, uint format) {
  SatBox box;
  box.texels = texels;
  box.z = wide_subtract(wide_subtract(uvec2(s11.x, s11.w), uvec2(s01.x, s01.w)),
                        wide_subtract(uvec2(s10.x, s10.w), uvec2(s00.x, s00.w)));
  box.zz = wide_subtract(wide_subtract(uvec2(s11.y, s11.z), uvec2(s01.y, s01.z)),
                         wide_subtract(uvec2(s10.y, s10.z), uvec2(s00.y, s00.z)));
  if (!sat_two_words(format)) {
    box.z.y = 0u;
    box.zz = wide_multiply(uvec2(box.zz.x, 0u), sat_scale(format));
  }
  return box;
}

// Adds texels outside the map, which are unoccluded: depth 1.
LIMN_FN SatBox sat_extended(SatBox box, uint texels, uint format) {
  uint scale = sat_scale(format);
  uvec2 z = wide_multiply(uvec2(texels, 0u), scale);
  box.texels += texels;
  box.z = wide_add(box.z, z);
  box.zz = wide_add(box.zz, wide_multiply(z, scale));
  return box;
}

// --- Moments about a receiver ---

// Weighted sums over boxes of 1, D - Z and (D - Z)^2, D the receiver's quantised depth.
struct SatMoments {
  float weight;
  float first;
  float second;
};

// The sum of (D - Z)^2 over `texels` texels as a number; `first`: that of D - Z. Where squares were rounded to one word it
// may come out less than any depths have, even below 0: it is no less than first^2 / texels.
LIMN_FN float sat_second(uvec2 second, float first, uint texels, uint format) {
  if (sat_two_words(format)) return wide_unsigned_float(second);
  return max(wide_signed_float(second), first * first / float(max(texels, 1u)));
}

// sum (D - Z) = n D - SZ and sum (D - Z)^2 = n D^2 - 2 D SZ + SZZ, in integers.
LIMN_FN SatMoments sat_accumulated(SatMoments moments, SatBox box, float weight, uint receiver, uint format) {
  uvec2 all = wide_multiply(uvec2(box.texels, 0u), receiver);
  uvec2 first = wide_subtract(all, box.z);
  // D (n D - 2 SZ) + SZZ
  uvec2 second = wide_add(wide_multiply(wide_subtract(first, box.z), receiver), box.zz);
  float sum = wide_signed_float(first);
  moments.weight += weight * float(box.texels);
  moments.first += weight * sum;
  moments.second += weight * sat_second(second, sum, box.texels, format);
  return moments;
}

// (m1, m2) = (E(d - z), E((d - z)^2)); m2 is meaningful where the table holds squares. The receiver's depth d = q D + e
// enters with its remainder e below one quantum. Without texels: as if all were at depth 1.
LIMN_FN vec2 sat_moments(SatMoments moments, float d, uint receiver, uint format) {
  if (moments.weight <= 0.0f) return vec2(d - 1.0f, (d - 1.0f) * (d - 1.0f));
  float scale = float(sat_scale(format));
  float m1 = moments.first / (moments.weight * scale);
  float m2 = moments.second / (moments.weight * scale * scale);
  float e = (d * scale - float(receiver)) / scale;
  return vec2(m1 + e, m2 + 2.0f * e * m1 + e * e);
}

// --- Kernels with fractional edges ---

// One axis of a kernel [lo, hi) in texels: boxes [edges[i], edges[i + 1]) of weights[i]: the two texels that an edge
// cuts, and all between them.
struct SatAxis {
  ivec4 edges;
  vec3 weights;
};

// How far beyond the edges of a map of `size` texels its boxes may reach: by one map, where sums of (D - Z)^2 over so many texels
// fit 64 bits, else not at all. What lies there is at depth 1, which may be far from D.
LIMN_FN ivec2 sat_margin(ivec2 size, uint format) {
  float scale = float(sat_scale(format));
  float texels = 9.0f * float(size.x) * float(size.y);
  return texels * scale * scale < 1.8e19f ? size : ivec2(0);
}

// The kernel is cut `margin` texels beyond either edge of the map, of `size` texels; sat_beyond() adds the rest of it.
LIMN_FN SatAxis sat_axis(float lo, float hi, int size, int margin) {
  float least = -float(margin);
  float most = float(size) + float(margin);
  float a = clamp(lo, least, most);
  float b = clamp(hi, a, most);
  int first = int(floor(a));
  int last = int(floor(b));
  SatAxis axis;
  if (first == last) {
    axis.edges = ivec4(first, first + 1, first + 1, first + 1);
    axis.weights = vec3(b - a, 0.0f, 0.0f);
  } else {
    axis.edges = ivec4(first, first + 1, last, last + 1);
    axis.weights = vec3(float(first + 1) - a, 1.0f, b - float(last));
  }
  return axis;
}

// Adds what of the kernel lo..hi lies beyond where sat_axis() cuts it: unoccluded, as all outside the map.
LIMN_FN SatMoments sat_beyond(SatMoments moments, vec2 lo, vec2 hi, ivec2 size, uint receiver, uint format) {
  vec2 margin = vec2(sat_margin(size, format));
  vec2 least = clamp(lo, -margin, vec2(size) + margin);
  vec2 most = clamp(hi, -margin, vec2(size) + margin);
  vec2 outside = (hi - most) + (least - lo);
  SAT_PRECISE float texels = outside.x * (hi.y - lo.y) + (most.x - least.x) * outside.y;
  float before = float(receiver) - float(sat_scale(format));
  moments.weight += texels;
  moments.first += texels * before;
  moments.second += texels * before * before;
  return moments;
}

// Box (i, j) of 3 x 3 from the sums at the 4 x 4 edges, corners[4 * row + column], of which those outside the map are
// taken at its edge.
LIMN_FN SatBox sat_kernel_box(uvec4 s11, uvec4 s01, uvec4 s10, uvec4 s00, ivec2 lo, ivec2 hi, ivec2 size, uint format) {
  ivec2 inside = clamp(hi, ivec2(0), size) - clamp(lo, ivec2(0), size);
  ivec2 whole = hi - lo;
  uint covered = uint(inside.x) * uint(inside.y);
  return sat_extended(sat_box(s11, s01, s10, s00, covered, format), uint(whole.x) * uint(whole.y) - covered, format);
}

LIMN_END

#ifndef __cplusplus
// Sums over all texels left of at.x and above at.y, which may lie outside the map.
uvec4 sat_sums(usampler2DArray table, ivec2 at, int layer, ivec2 size, uint format) {
  ivec2 inside = min(at, size);
  if (inside.x <= 0 || inside.y <= 0) return uvec4(0u);
  return sat_unpack(texelFetch(table, ivec3(inside - 1, layer), 0), format);
}

// Whole texels lo <= x < hi. Accurate for boxes up to one map size beyond the map.
SatBox sat_lookup_box(usampler2DArray table, ivec2 lo, ivec2 hi, int layer, uint format) {
  ivec2 size = textureSize(table, 0).xy;
  return sat_kernel_box(sat_sums(table, hi, layer, size, format),
                        sat_sums(table, ivec2(lo.x, hi.y), layer, size, format),
                        sat_sums(table, ivec2(hi.x, lo.y), layer, size, format),
                        sat_sums(table, lo, layer, size, format), lo, hi, size, format);
}

// (E(d - z), E((d - z)^2)) over the kernel lo..hi in texels, whose edges may cut texels and lie outside the map.
vec2 sat_lookup_moments(usampler2DArray table, vec2 lo, vec2 hi, int layer, float d, uint format) {
  ivec2 size = textureSize(table, 0).xy;
  ivec2 margin = sat_margin(size, format);
  SatAxis ax = sat_axis(lo.x, hi.x, size.x, margin.x);
  SatAxis ay = sat_axis(lo.y, hi.y, size.y, margin.y);
  uint receiver = sat_quantise(d, format);
  SatMoments moments = SatMoments(0.0, 0.0, 0.0);
  uvec4 above[4];
  for (int i = 0; i < 4; ++i) above[i] = sat_sums(table, ivec2(ax.edges[i], ay.edges[0]), layer, size, format);
  for (int j = 0; j < 3; ++j) {
    uvec4 below[4];
    for (int i = 0; i < 4; ++i) below[i] = sat_sums(table, ivec2(ax.edges[i], ay.edges[j + 1]), layer, size, format);
    for (int i = 0; i < 3; ++i) {
      float weight = ax.weights[i] * ay.weights[j];
      if (weight <= 0.0) continue;
      SatBox box = sat_kernel_box(below[i + 1], below[i], above[i + 1], above[i], ivec2(ax.edges[i], ay.edges[j]),
                                  ivec2(ax.edges[i + 1], ay.edges[j + 1]), size, format);
      moments = sat_accumulated(moments, box, weight, receiver, format);
    }
    above = below;
  }
  return sat_moments(sat_beyond(moments, lo, hi, size, receiver, format), d, receiver, format);
}
#endif

#endif  // LIMN_SUMMED_AREA_TABLE_GLSL
