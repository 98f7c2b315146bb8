// How much light is averaged over the pattern of interleaved pixels that draw different points, for each channel by how far its
// light gets: a mean blurs, and what blurs red light little would take most of blue away.
#ifndef PATTERN_WEIGHTS_GLSL
#define PATTERN_WEIGHTS_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Where light of the channel that gets farthest gets less far than so many pixels, all pixels draw the same points: a blur over a
// pattern of points would take away more than it is worth, and without it the pattern shows.
LIMN_CONST float least_patterned_reach = 0.8f;

// Light that gets twice as far as least_patterned_reach counts pixels side by side in full, and light that gets from 0.75 to 1.5
// times as far as the pattern is wide counts more and more of the pattern.
LIMN_CONST float pattern_widths = 0.75f;

// From 0, nothing is averaged, over 1, a mean of 1/4, 1/2 and 1/4 along rows and columns, to 2, a mean over the whole pattern of
// block x block pixels. `reach`: of each channel, pixels; 0 for all where the farthest is below least_patterned_reach.
LIMN_FN vec3 pattern_spread(vec3 reach, int block) {
  if (max(reach.x, max(reach.y, reach.z)) < least_patterned_reach) return vec3(0.0f);
  vec3 pairs = clamp(reach / least_patterned_reach - 1.0f, vec3(0.0f), vec3(1.0f));
  float width = pattern_widths * float(block);
  vec3 all = block > 2 ? clamp(reach / width - 1.0f, vec3(0.0f), vec3(1.0f)) : vec3(0.0f);
  return pairs + all;
}

// Of a pixel `t` away along a row or column, on either side, and of the pixel itself at 0. Those of all pixels sum up to 1. In a
// mean over the whole pattern each place counts once: with an even `block` the pixels at both ends share one.
LIMN_FN vec3 pattern_weights(vec3 spread, int block, int t) {
  float pairs = t == 0 ? 0.5f : t == 1 ? 0.25f : 0.0f;
  float all = t <= block / 2 ? (2 * t == block ? 0.5f : 1.0f) / float(block) : 0.0f;
  vec3 mean = mix(vec3(pairs), vec3(all), clamp(spread - 1.0f, vec3(0.0f), vec3(1.0f)));
  return mix(vec3(t == 0 ? 1.0f : 0.0f), mean, min(spread, vec3(1.0f)));
}

// The pixels to either side that have weights.
LIMN_FN int pattern_reach(vec3 spread, int block) {
  float most = max(spread.x, max(spread.y, spread.z));
  return most > 1.0f ? block / 2 : most > 0.0f ? 1 : 0;
}

// In the 24 digits of one float, 8 for each channel.
LIMN_FN float pattern_spread_pack(vec3 spread) {
  return dot(floor(spread * 127.0f + 0.5f), vec3(65536.0f, 256.0f, 1.0f));
}
LIMN_FN vec3 pattern_spread_unpack(float spread) {
  uint bits = uint(spread);
  return vec3(float(bits >> 16u), float(bits >> 8u & 0xffu), float(bits & 0xffu)) / 127.0f;
}

LIMN_END
#endif  // PATTERN_WEIGHTS_GLSL
