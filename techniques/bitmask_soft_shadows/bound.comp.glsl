// The bound of bitmask soft shadows: the texels and the decisions of visibility.comp.glsl, and the bits of each patch that blocks.
// One view sees all of the light, which is a rectangle. The samples are the bits of WORDS words.
#define LIMN_PATCH_UNION 1
#include "glsl/shadow/coverage_mask.glsl"
#include "glsl/shadow/patch_taps.glsl"
#include "glsl/shadow/visibility_main.glsl"

uint covered[WORDS];

void add_patch(MicroPatch found) {
  ivec4 ranks = coverage_ranks(found.low, found.high, WORDS);
  for (int i = 0; i < WORDS; ++i) covered[i] |= found.blocks ? coverage_word(ranks, i, WORDS) : 0u;
}

bool patches_suffice() {
  uint all = 0xffffffffu;
  for (int i = 0; i < WORDS; ++i) all &= covered[i];
  return all == 0xffffffffu;
}

// The samples of a word that lie above the tangent plane.
uint counted_samples(vec3 height, int word) {
  uint counted = 0u;
  for (int i = 0; i < 32; ++i) {
    bool counts = height.z + dot(height.xy, coverage_sample(word, i, WORDS) - 0.5) > 0.0;
    counted |= counts ? 1u << uint(i) : 0u;
  }
  return counted;
}

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  for (int i = 0; i < WORDS; ++i) covered[i] = 0u;
  int answer = tap_patches(cursor, q);
  if (answer != search_partial) return answer == search_lit ? 1.0 : 0.0;
  vec3 height = light_height(cursor.view, q.light, DISC_SIDE);
  int seen = 0;
  int all = 0;
  for (int i = 0; i < WORDS; ++i) {
    uint counted = q.light.whole ? 0xffffffffu : counted_samples(height, i);
    seen += bitCount(counted & ~covered[i]);
    all += bitCount(counted);
  }
  return all > 0 ? float(seen) / float(all) : 1.0;
}
