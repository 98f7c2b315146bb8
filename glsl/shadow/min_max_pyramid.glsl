// Lookups in the min-max pyramid of a shadow map (shadow::DerivedMaps): texel i of level l holds the least and the
// greatest depth of the map's texels [i 2^l, (i + 1) 2^l) along each axis, and the last texel also those up to the
// map's edge, so that maps of any size are covered without gaps.
#ifndef LIMN_MIN_MAX_PYRAMID_GLSL
#define LIMN_MIN_MAX_PYRAMID_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// The lowest level of which 2 x 2 texels cover any box of this many texels along its longer side:
// ceil(log2(extent)). One texel of any level would not be conservative.
LIMN_FN int min_max_level(int extent, int levels) {
  return min(findMSB(uint(2 * max(extent, 1) - 1)), levels - 1);
}

// The texel of `level` that covers texel x of a map of `size` texels, 0 <= x < size.
LIMN_FN int min_max_texel(int x, int level, int size) {
  return min(x >> level, max(size >> level, 1) - 1);
}

LIMN_END

#ifndef __cplusplus
#include "glsl/shadow/depth_bounds.glsl"

// Bounds of the depths in texels low..high (both included) of one layer, low <= high: at least as wide as the truth. The
// part outside the map is unoccluded (depth 1).
vec2 min_max_depth(sampler2DArray pyramid, ivec2 low, ivec2 high, int layer) {
  ivec2 size = textureSize(pyramid, 0).xy;
  ivec2 a = max(low, ivec2(0));
  ivec2 b = min(high, size - 1);
  if (any(greaterThan(a, b))) return vec2(1.0);
  int level = min_max_level(max(b.x - a.x, b.y - a.y) + 1, textureQueryLevels(pyramid));
  ivec2 first = ivec2(min_max_texel(a.x, level, size.x), min_max_texel(a.y, level, size.y));
  ivec2 second = ivec2(min_max_texel(b.x, level, size.x), min_max_texel(b.y, level, size.y));
  return depth_bounds_of_four(pyramid, first, second, layer, level, a == low && b == high);
}
#endif

#endif  // LIMN_MIN_MAX_PYRAMID_GLSL
