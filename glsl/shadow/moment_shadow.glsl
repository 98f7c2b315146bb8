// Moment shadow maps (Peters and Klein 2015, Moment Shadow Mapping; Peters, Muenstermann, Wetzstein, Klein 2017, Improved
// Moment Shadow Maps for Translucent Occluders, Soft Shadows and Single Scattering): of the depths in a box of a shadow map
// only the first four power moments are known; among all distributions that have them, the one that hides the least
// bounds how much of the box blocks from below, and how far its blockers are.
//
// Depth z in [0, 1] enters as u = 2 z - 1, of which the means of the Chebyshev polynomials T1 to T4 are kept instead of
// u, u^2, u^3, u^4: all of them fill [-1, 1], so that each word of a table quantises equally well.
#ifndef LIMN_MOMENT_SHADOW_GLSL
#define LIMN_MOMENT_SHADOW_GLSL
#include "glsl/numeric/sampling.glsl"
#include "glsl/shadow/summed_area_table.glsl"
LIMN_BEGIN

// --- Quantised moments, and boxes of them ---

// Moments of `bits` bits are whole numbers within -S..S.
LIMN_FN int moment_scale(int bits) { return (1 << (bits - 1)) - 1; }

// Side of the largest square box whose sums, at most 2^31 - 1 = n S, are exact in one word: 256 texels at 16 bits.
LIMN_FN int moment_largest_side(int bits) {
  return int(sqrt(float(2147483647 / moment_scale(bits))));
}

// T1 to T4 of depth z; what is not within [0, 1] or not a number counts as 0 or 1.
LIMN_FN vec4 moment_polynomials(float z) {
  float limited = z < 1.0f ? max(z, 0.0f) : 1.0f;
  SAT_PRECISE float u = 2.0f * limited - 1.0f;
  SAT_PRECISE float square = u * u;
  SAT_PRECISE float t2 = 2.0f * square - 1.0f;
  SAT_PRECISE float t3 = u * (2.0f * t2 - 1.0f);
  SAT_PRECISE float t4 = 2.0f * (t2 * t2) - 1.0f;
  return vec4(u, t2, t3, t4);
}

// What a texel adds to the table, in two's complement. Rounding follows a sequence of low discrepancy over the map (R2,
// Roberts 2018), so that what it adds to the mean of n texels of equal depth falls off as 1 / n.
LIMN_FN uvec4 moment_texel(float z, uvec2 at, int bits) {
  int scale = moment_scale(bits);
  vec4 t = moment_polynomials(z);
  uint shift = at.x * r2_step.x + at.y * r2_step.y;
  ivec4 texel;
  for (int i = 0; i < 4; ++i) {
    SAT_PRECISE float scaled = t[i] * float(scale);
    SAT_PRECISE float rounded = floor(scaled + float((shift + uint(i) * 0x40000000u) >> 8u) / 16777216.0f);
    texel[i] = clamp(int(rounded), -scale, scale);
  }
  return uvec4(texel);
}

// Sums of T1 to T4 over a box, from those over all texels above its lower and above its upper edge, between its columns;
// exact for boxes of up to moment_largest_side() squared texels.
LIMN_FN vec4 moment_box(uvec4 below, uvec4 above, int bits) {
  return vec4(ivec4(below - above)) / float(moment_scale(bits));
}

// --- The moment problem ---

// What moments say about the depths nearer than some d.
struct MomentBlockers {
  float share;  // of the box: a lower bound
  float depth;  // their mean depth in [0, 1]; d where there are none
};

// A distribution's mean and spread, and its moments once both are taken out.
struct MomentShape {
  float mean;       // of u
  float deviation;  // > 0
  float skewness;   // third moment of x = (u - mean) / deviation
  float excess;     // fourth moment of x, less 1 + skewness^2: 0 for two depths, never negative
};

// From mean polynomials t, pulled by `bias` towards the moments (0, 3/8, 0, 3/8) of a distribution over -1, 0 and 1 so that
// quantised moments stay those of a distribution (Peters and Klein 2015, section 4.2). What rounding makes impossible
// becomes the nearest possible shape: then the answer errs no farther than mean and deviation allow.
LIMN_FN MomentShape moment_shape(vec4 t, float bias) {
  float keep = 1.0f - bias;
  float m1 = keep * t.x;
  float m2 = keep * (0.5f * (t.y + 1.0f)) + 0.375f * bias;
  float m3 = keep * (0.25f * (t.z + 3.0f * t.x));
  float m4 = keep * (0.125f * (t.w + 4.0f * t.y + 3.0f)) + 0.375f * bias;
  float second = max(m2 - m1 * m1, 0.3f * bias);
  float third = m3 - m1 * (3.0f * m2 - 2.0f * m1 * m1);
  float fourth = m4 - m1 * (4.0f * m3 - m1 * (6.0f * m2 - 3.0f * m1 * m1));
  MomentShape shape;
  shape.mean = m1;
  shape.deviation = sqrt(second);
  shape.skewness = third / (second * shape.deviation);
  shape.excess = max(fourth / (second * second) - 1.0f - shape.skewness * shape.skewness, 1e-3f);
  return shape;
}

// Two roots of c2 x^2 + c1 x + c0 in ascending order, real ones assumed; a root that lies far away is cut at +-limit.
LIMN_FN vec2 moment_roots(float c2, float c1, float c0, float limit) {
  float discriminant = max(c1 * c1 - 4.0f * c2 * c0, 0.0f);
  float q = -0.5f * (c1 + (c1 < 0.0f ? -sqrt(discriminant) : sqrt(discriminant)));
  float first = abs(c2) * limit > abs(q) ? q / c2 : ((q < 0.0f) == (c2 < 0.0f) ? limit : -limit);
  float second = abs(q) * limit > abs(c0) ? c0 / q : ((q < 0.0f) == (c0 < 0.0f) ? limit : -limit);
  return vec2(min(first, second), max(first, second));
}

// Hamburger's problem (Peters and Klein 2015, algorithm 2): of the one distribution over x = d and two other points that
// has all four moments, (share of what is nearer than d, that times its mean x). With the orthonormal polynomials 1, x,
// p = (x^2 - s x - 1) / sqrt(e) of a shape of skewness s and excess e, the other points are the roots of the kernel
// 1 + d x + p(d) p(x).
LIMN_FN vec2 moment_hamburger(float d, float skewness, float excess) {
  float p = d * d - skewness * d - 1.0f;
  vec2 x = moment_roots(p, d * excess - p * skewness, excess - p, 1e6f);
  float apart = max(x.y - x.x, 1e-6f);
  vec2 found = vec2(0.0f);
  // The weight of x.x, (1 + d x.y) / ((d - x.x) (x.y - x.x)), makes the first two moments 0 and 1.
  if (x.x < d) {
    float weight = clamp((1.0f + d * x.y) / max((d - x.x) * apart, 1e-30f), 0.0f, 1.0f);
    found = vec2(weight, weight * x.x);
  }
  if (x.y < d) {
    float weight = clamp(-(1.0f + d * x.x) / max((d - x.y) * apart, 1e-30f), 0.0f, 1.0f);
    found += vec2(weight, weight * x.y);
  }
  return found;
}

// t: means of T1 to T4 over a box; d: a depth in [0, 1]; nearest: the least depth in the box, or 0.
LIMN_FN MomentBlockers moment_blockers(vec4 t, float d, float nearest, float bias) {
  MomentBlockers result;
  result.share = 0.0f;
  result.depth = d;
  if (d <= nearest) return result;
  MomentShape shape = moment_shape(t, bias);
  float limit = (2.0f * d - 1.0f - shape.mean) / shape.deviation;
  vec2 found = moment_hamburger(limit, shape.skewness, shape.excess);
  result.share = clamp(found.x, 0.0f, 1.0f);
  if (found.x > 0.0f) {
    float u = shape.mean + shape.deviation * found.y / found.x;
    result.depth = clamp(0.5f * (u + 1.0f), nearest, d);
  }
  return result;
}

// --- Boxes whose edges cut texels ---

// One axis of a box is made of parts: a texel that an edge cuts, or all whole texels. Prefix sums are never interpolated.
struct MomentPart {
  float begin;   // texels, whole
  float end;     // likewise: where the next part begins
  float weight;  // the share of its texels that the box covers
};

// The part of a box that begins at `low`, which is an edge of the box or the end of another part, and reaches up to `high`.
LIMN_FN MomentPart moment_part(float low, float high) {
  MomentPart part;
  float last = floor(high);
  part.begin = floor(low);
  bool cut = low > part.begin || last <= part.begin;
  part.end = cut ? part.begin + 1.0f : last;
  part.weight = cut ? min(high, part.end) - low : 1.0f;
  return part;
}

// --- Boxes in cells ---

// Where cell `place` of `parts` begins along one axis of a box, 0 <= place <= parts: at a whole texel, except the first and the end
// of the last, and nowhere outside of the box, in which few texels may leave cells without any.
LIMN_FN float moment_cell_edge(float low, float high, int place, int parts) {
  float edge = clamp(round(mix(low, high, float(place) / float(parts))), low, high);
  return place == 0 ? low : place == parts ? high : edge;
}

LIMN_END

#ifndef __cplusplus
// Sums over all texels left of at.x and above at.y, 0 <= at <= size.
uvec4 moment_sums(usampler2DArray table, ivec2 at, int layer) {
  return at.x <= 0 || at.y <= 0 ? uvec4(0u) : texelFetch(table, ivec3(at - 1, layer), 0);
}

// Sums over the texels of a part of the x axis and above y.
uvec4 moment_edge(usampler2DArray table, MomentPart x, float y, int layer) {
  return moment_sums(table, ivec2(x.end, y), layer) - moment_sums(table, ivec2(x.begin, y), layer);
}

// Means of T1 to T4 over the box lo..hi in texels, which lies in the map and is at most moment_largest_side() wide: 4
// fetches where the edges are whole, else up to 24. Loops end in their condition: software renderers run a body once more
// where it comes first.
vec4 moment_lookup(usampler2DArray table, vec2 lo, vec2 hi, int layer, int bits) {
  vec4 sums = vec4(0.0);
  MomentPart x;
  x.end = lo.x;
  do {
    x = moment_part(x.end, hi.x);
    MomentPart y;
    y.end = lo.y;
    uvec4 below = moment_edge(table, x, floor(lo.y), layer);
    do {
      y = moment_part(y.end, hi.y);
      uvec4 above = below;
      below = moment_edge(table, x, y.end, layer);
      sums += (x.weight * y.weight) * moment_box(below, above, bits);
    } while (y.end < hi.y);
  } while (x.end < hi.x);
  return sums / ((hi.x - lo.x) * (hi.y - lo.y));
}
#endif

#endif  // LIMN_MOMENT_SHADOW_GLSL
