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
  uint first = (1u << uint(k & 31)) - 1u;
  int whole = k >> 5;  // words
  return whole == word ? first : whole > word ? 0xffffffffu : 0u;
}

// The same along the second axis. The sample of bit 8 a + b has place (4 reversed(b) + reversed(a)) words + reversed(word)
// there, with 3 bits of b, 2 of a: of each byte the first bits in the order of reversed(b) are among them, in all words the
// same, and the next one in some of the bytes.
LIMN_FN uint coverage_rows(int k, int word, int words) {
  uint first = uint(k) / uint(4 * words);  // 0 to 8 bits
  uint rest = uint(k) % uint(4 * words);
  // The comparison runs through the bits of reversed(b), the lowest first.
  uint set = 0u - (first & 1u);
  uint below = 0x0f0f0f0fu & set;
  set = 0u - ((first >> 1u) & 1u);
  below = (set & below) | (0x33333333u & (set | below));
  set = 0u - ((first >> 2u) & 1u);
  below = (set & below) | (0x55555555u & (set | below));
  below |= 0u - (first >> 3u);
  // Bytes whose place within those of one reversed(b) is less than `rest`: bit 7 of 127 - place + rest.
  uint places = uint(coverage_reversed(word, words)) * 0x01010101u + uint(words) * 0x03010200u;
  uint bytes = ((rest * 0x01010101u + (0x7f7f7f7fu - places)) >> 7u) & 0x01010101u;
  uint next = (0x73516240u >> (4u * (first & 7u))) & 7u;  // reversed(first)
  return below | (bytes << next);
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
