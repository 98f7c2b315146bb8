// Sample points on a light as bits of words, and the bits that a rectangle covers (Schwarz and Stamminger 2007, Bitmask
// Soft Shadows). The points are the Hammersley set of n = 32 * words points in the unit square, sample i at
// ((i + 1/2) / n, (reversed bits of i + 1/2) / n): along both axes no two samples coincide, so that an edge parallel to
// the light's sides moves by 1 / n, not by the spacing of a grid. The bits of a rectangle follow from its sides without
// tables.
#ifndef LIMN_COVERAGE_MASK_GLSL
#define LIMN_COVERAGE_MASK_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// The word with its bits reversed, among as many as `words` (2, 4, 8, ...) needs.
LIMN_FN int coverage_reversed(int word, int words) {
  return int(bitfieldReverse(uint(word)) >> uint(32 - findMSB(uint(words))));
}

// Point of the sample that bit `bit` of a word stands for.
LIMN_FN vec2 coverage_sample(int word, int bit, int words) {
  float n = float(32 * words);
  int reversed = int(bitfieldReverse(uint(bit)) >> 27u) * words + coverage_reversed(word, words);
  return vec2((float(32 * word + bit) + 0.5f) / n, (float(reversed) + 0.5f) / n);
}

// How many of n samples lie below x along an axis.
LIMN_FN int coverage_rank(float x, int n) {
  return int(ceil(clamp(x, 0.0f, 1.0f) * float(n) - 0.5f));
}

// Bits of a word whose samples are among the first k along the first axis.
LIMN_FN uint coverage_columns(int k, int word) {
  int bits = clamp(k - 32 * word, 0, 32);
  return bits == 32 ? 0xffffffffu : (1u << uint(bits)) - 1u;
}

// The same along the second axis: bits j with reversed(j) * words + reversed(word) < k. The comparison runs through the
// five bits of reversed(j), the lowest first; each is the same in all words.
LIMN_FN uint coverage_rows(int k, int word, int words) {
  int least = (k - coverage_reversed(word, words) + words - 1) / words;
  uint limit = uint(clamp(least, 0, 32));
  uint below = 0u;
  uint set = 0u - (limit & 1u);
  below = 0x0000ffffu & set;
  set = 0u - ((limit >> 1u) & 1u);
  below = (set & below) | (0x00ff00ffu & (set | below));
  set = 0u - ((limit >> 2u) & 1u);
  below = (set & below) | (0x0f0f0f0fu & (set | below));
  set = 0u - ((limit >> 3u) & 1u);
  below = (set & below) | (0x33333333u & (set | below));
  set = 0u - ((limit >> 4u) & 1u);
  below = (set & below) | (0x55555555u & (set | below));
  return limit == 32u ? 0xffffffffu : below;
}

// Ranks of a rectangle's sides: of low.x, low.y, high.x, high.y.
LIMN_FN ivec4 coverage_ranks(vec2 low, vec2 high, int words) {
  int n = 32 * words;
  return ivec4(coverage_rank(low.x, n), coverage_rank(low.y, n), coverage_rank(high.x, n),
               coverage_rank(high.y, n));
}

// Bits of a word whose samples lie inside.
LIMN_FN uint coverage_word(ivec4 ranks, int word, int words) {
  return coverage_columns(ranks.z, word) & ~coverage_columns(ranks.x, word) &
         coverage_rows(ranks.w, word, words) & ~coverage_rows(ranks.y, word, words);
}

LIMN_END
#endif  // LIMN_COVERAGE_MASK_GLSL
