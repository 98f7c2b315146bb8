// Bitmask soft shadows (Schwarz and Stamminger 2007): V = the share of sample points on the light that no micro-patch
// covers. The samples are the bits of WORDS words (glsl/shadow/coverage_mask.glsl).
#define DISC_SIDE 1.0
#define PATCH_SPREAD 1.0
#define LIMN_PATCH_UNION 1
#include "glsl/shadow/coverage_mask.glsl"
#include "glsl/shadow/micro_patch_walk.glsl"
#include "glsl/shadow/visibility_main.glsl"

uint covered[WORDS];

void add_patch(PatchProjection projection, MicroPatch found) {
  MicroPatch placed = found;
  if (!patches_aligned()) placed = patch_in_light(projection, found);
  ivec4 ranks = coverage_ranks(placed.low, placed.high, WORDS);
  for (int i = 0; i < WORDS; ++i) covered[i] |= found.blocks ? coverage_word(ranks, i, WORDS) : 0u;
}

bool patches_suffice() {
  uint all = 0xffffffffu;
  for (int i = 0; i < WORDS; ++i) all &= covered[i];
  return all == 0xffffffffu;
}

// The samples of a word that count: on the disc, above the tangent plane.
uint counted_samples(LightView light, vec3 height, int word) {
  uint counted = 0u;
  for (int i = 0; i < 32; ++i) {
    vec2 p = coverage_sample(word, i, WORDS) - 0.5;
    bool counts = (!light.cone || dot(p, p) <= 0.25) && height.z + dot(height.xy, p) > 0.0;
    counted |= counts ? 1u << uint(i) : 0u;
  }
  return counted;
}

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  for (int i = 0; i < WORDS; ++i) covered[i] = 0u;
  int answer = walk_patches(cursor, q);
  if (answer != search_partial) return answer == search_lit ? 1.0 : 0.0;
  vec3 height = light_height(cursor.view, q.light, DISC_SIDE);
  int seen = 0;
  int all = 0;
  for (int i = 0; i < WORDS; ++i) {
    uint counted = 0xffffffffu;
    if (q.light.cone || !q.light.whole) counted = counted_samples(q.light, height, i);
    seen += bitCount(counted & ~covered[i]);
    all += bitCount(counted);
  }
  return all > 0 ? float(seen) / float(all) : 1.0;
}
