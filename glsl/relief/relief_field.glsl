// How relief_maps::ReliefMapService stores height maps and what it makes of them: a table of fields, and words.
//
// Values are found by the number of their texel and not as textures, because the maps of a scene differ in size and wrap as
// their fields do, and texels of a mean or of a table by azimuths are combined by rules of their own.
#ifndef LIMN_RELIEF_FIELD_GLSL
#define LIMN_RELIEF_FIELD_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/relief/ellipse.glsl"
LIMN_BEGIN

// One height map (storage buffer element). x runs fastest.
struct ReliefField {
  uint first;     // word of its first value
  uint clamped;   // 1: the last texels go on for ever; 0: periodic
  ivec2 size;     // texels
  vec2 spacing;   // metres from texel to texel
  float highest;  // metres
  int levels;     // of means, one after the other, each of half as many texels along a side (relief_level_size())
};

LIMN_CONST int relief_ellipse_words = 3;

// Words of a texel's tangents, two to a word.
LIMN_FN int relief_horizon_words(int azimuths) { return (azimuths + 1) / 2; }

LIMN_FN ivec2 relief_level_size(ivec2 size, int level) {
  return ivec2(max(size.x >> level, 1), max(size.y >> level, 1));
}

// The texel along one side that stands for texel i, a whole number, of a map of `size` texels. Rays that graze the base get
// farther than floats or integers count texels: from 2^23 texels on, or where i is no number, it may be any texel of the map.
LIMN_FN int relief_wrapped(float i, int size, bool clamped) {
  float side = float(size);
  float inside = i - side * floor(i / side);  // within a side of [0, side) where division rounds
  inside = inside < 0.0f ? inside + side : inside >= side ? inside - side : inside;
  if (clamped) inside = min(i, side - 1.0f);
  return inside > 0.0f && inside < side ? int(inside) : 0;
}

// An ellipse in 16 bits a number: no covariance is above 1/2, no spread above 2.
LIMN_FN uvec3 relief_ellipse_pack(ReliefEllipse e) {
  return uvec3(packSnorm2x16(e.centre), packSnorm2x16(vec2(2.0f * e.xx, 2.0f * e.xy)),
               packSnorm2x16(vec2(2.0f * e.yy, 0.5f * e.spread)));
}
LIMN_FN ReliefEllipse relief_ellipse_unpack(uvec3 words) {
  vec2 second = unpackSnorm2x16(words.y);
  vec2 third = unpackSnorm2x16(words.z);
  ReliefEllipse e;
  e.centre = unpackSnorm2x16(words.x);
  e.xx = 0.5f * second.x;
  e.xy = 0.5f * second.y;
  e.yy = 0.5f * third.x;
  e.spread = 2.0f * third.y;
  return e;
}

// e + weight * other, number by number: sums of weighted ellipses.
LIMN_FN ReliefEllipse relief_ellipse_add(ReliefEllipse e, float weight, ReliefEllipse other) {
  e.centre += weight * other.centre;
  e.xx += weight * other.xx;
  e.xy += weight * other.xy;
  e.yy += weight * other.yy;
  e.spread += weight * other.spread;
  return e;
}

LIMN_END
#endif  // LIMN_RELIEF_FIELD_GLSL
