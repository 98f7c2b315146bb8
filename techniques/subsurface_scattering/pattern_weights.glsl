// The pattern of interleaved pixels that draw different points, and the mean over it. Its size follows how far light gets, since a
// mean blurs; in it each place of the pattern counts once, so that none of the pattern is left to be seen.
#ifndef PATTERN_WEIGHTS_GLSL
#define PATTERN_WEIGHTS_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Where light of the channel that gets farthest gets less far than so many pixels, all pixels draw the same points: a blur over a
// pattern of points would take away more than it is worth, and without it the pattern shows.
LIMN_CONST float least_patterned_reach = 0.8f;

// Pixels along a side of the pattern: all of `block` where light gets nearly as far as that, and 2 where it gets less far. `reach`:
// of each channel, pixels.
LIMN_FN int pattern_side(vec3 reach, int block) {
  float farthest = max(reach.x, max(reach.y, reach.z));
  if (farthest < least_patterned_reach) return 1;
  return farthest < 0.85f * float(block) ? min(block, 2) : block;
}

// Whether light gets so little farther than the pattern that a mean without weights below 0 would blur it.
LIMN_FN bool pattern_narrow(vec3 reach, int side) {
  return side > 3 && max(reach.x, max(reach.y, reach.z)) < 1.125f * float(side);
}

// Which of the block x block sets of points a pixel draws. A smaller pattern has sets that lie evenly among all.
LIMN_FN int pattern_set(ivec2 pixel, int side, int block) {
  return (pixel.x % side + side * (pixel.y % side)) * (block * block) / (side * side);
}

// How much of the mean each channel has, 0 to 1: none where its light gets less far than least_patterned_reach, all of it from
// twice as far on.
LIMN_FN vec3 pattern_shares(vec3 reach) { return clamp(reach / least_patterned_reach - 1.0f, vec3(0.0f), vec3(1.0f)); }

// In the mean, of a pixel `t` away along a row or column, on either side, and of the pixel itself at 0. Those of all pixels sum up
// to 1, and those of each place of the pattern to 1 / side. With an even `side` the pixels at both ends share a place. A narrow
// mean weighs two pixels more, and takes that from others at the same places of the pattern: of the variance of 1.5 pixels squared
// that it has with a side of 4, 0.5 is left.
LIMN_FN float pattern_weight(int side, bool narrow, int t) {
  float weight = t <= side / 2 ? (2 * t == side ? 0.5f : 1.0f) / float(side) : 0.0f;
  if (!narrow) return weight;
  int inner = (side - 1) / 2;
  float moved = 0.25f / float(side);
  return weight + (t == inner ? moved : t == side - inner ? -moved : 0.0f);
}

// How many pixels away the last one is that has a weight.
LIMN_FN int pattern_end(int side, bool narrow) { return narrow ? side - (side - 1) / 2 : side / 2; }

// Side, narrowness and shares in the 24 digits of one float: 5 bits, 1 and 6 for each channel.
LIMN_FN float pattern_pack(int side, bool narrow, vec3 shares) {
  return dot(floor(shares * 63.0f + 0.5f), vec3(4096.0f, 64.0f, 1.0f)) + 262144.0f * float(side) + (narrow ? 8388608.0f : 0.0f);
}
LIMN_FN bool pattern_packed_narrow(float pattern) { return pattern >= 8388608.0f; }
LIMN_FN int pattern_packed_side(float pattern) { return int(pattern) >> 18 & 31; }
LIMN_FN vec3 pattern_packed_shares(float pattern) {
  int bits = int(pattern);
  return vec3(float(bits >> 12 & 63), float(bits >> 6 & 63), float(bits & 63)) / 63.0f;
}

LIMN_END
#endif  // PATTERN_WEIGHTS_GLSL
