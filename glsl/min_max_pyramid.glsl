// Lookups in the min-max pyramid of a shadow map (shadow::DerivedMaps): texel i of level l holds the least and the
// greatest depth of the map's texels [i 2^l, (i + 1) 2^l) along each axis, and the last texel also those up to the
// map's edge, so that maps of any size are covered without gaps.
#ifndef LIMN_MIN_MAX_PYRAMID_GLSL
#define LIMN_MIN_MAX_PYRAMID_GLSL
#include "glsl/language.glsl"
LIMN_BEGIN

// The lowest level of which 2 x 2 texels cover any box of this many texels along its longer side:
// ceil(log2(extent)). One texel of any level would not be conservative.
LIMN_FN int min_max_level(int extent, int levels) {
  return min(findMSB(uint(max(extent, 1) - 1)) + 1, levels - 1);
}

// The texel of `level` that covers texel x of a map of `size` texels, 0 <= x < size.
LIMN_FN int min_max_texel(int x, int level, int size) {
  return min(x >> level, max(size >> level, 1) - 1);
}

LIMN_END

#ifndef __cplusplus
// Bounds of the depths in texels lo..hi (both included) of one layer, lo <= hi: at least as wide as the truth. The
// part outside the map is unoccluded (depth 1).
vec2 min_max_depth(sampler2DArray pyramid, ivec2 lo, ivec2 hi, int layer) {
  ivec2 size = textureSize(pyramid, 0).xy;
  ivec2 a = max(lo, ivec2(0));
  ivec2 b = min(hi, size - 1);
  if (any(greaterThan(a, b))) return vec2(1.0);
  int level = min_max_level(max(b.x - a.x, b.y - a.y) + 1, textureQueryLevels(pyramid));
  int x0 = min_max_texel(a.x, level, size.x);
  int x1 = min_max_texel(b.x, level, size.x);
  int y0 = min_max_texel(a.y, level, size.y);
  int y1 = min_max_texel(b.y, level, size.y);
  vec2 t00 = texelFetch(pyramid, ivec3(x0, y0, layer), level).xy;
  vec2 t10 = texelFetch(pyramid, ivec3(x1, y0, layer), level).xy;
  vec2 t01 = texelFetch(pyramid, ivec3(x0, y1, layer), level).xy;
  vec2 t11 = texelFetch(pyramid, ivec3(x1, y1, layer), level).xy;
  float least = min(min(t00.x, t10.x), min(t01.x, t11.x));
  float greatest = max(max(t00.y, t10.y), max(t01.y, t11.y));
  bool inside = a == lo && b == hi;
  return vec2(least, inside ? greatest : 1.0);
}
#endif

#endif  // LIMN_MIN_MAX_PYRAMID_GLSL
