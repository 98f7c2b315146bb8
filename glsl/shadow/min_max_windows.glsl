// Lookups in the overlapping min-max windows of a shadow map (shadow::DerivedMaps), between the min-max pyramid, whose
// texels do not overlap, and the N-buffer, whose windows start at every texel: texel i of level l holds the least and the
// greatest depth of the map's texels [i 2^l, i 2^l + min_max_window(l)) along each axis, as far as the map reaches. A mip
// chain, so it takes no more memory than the pyramid.
#ifndef LIMN_MIN_MAX_WINDOWS_GLSL
#define LIMN_MIN_MAX_WINDOWS_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// log2 of how many windows begin in the width of one.
LIMN_CONST int min_max_overlap = 2;

LIMN_FN int min_max_window(int level) { return 1 << (level + min_max_overlap); }

// The least level at which two windows cover this many texels where they begin with a window: further ones start in time
// only at the next.
LIMN_FN int min_max_windows_level(int extent) {
  return max(findMSB(uint(max(extent - 1, 1))) - min_max_overlap, 0);
}

// Levels of a map of `size` texels along its longer side: what the largest box in it needs.
LIMN_FN int min_max_windows_levels(int size) { return min_max_windows_level(size) + 1; }

// Whether two windows of a level cover texels low..high (both included).
LIMN_FN bool min_max_windows_cover(int low, int high, int level) {
  return (high >> level) - (low >> level) < 2 << min_max_overlap;
}

// Two windows of a level that cover texels low..high of a map of `size` texels. They reach less than 2^level texels beyond
// either end, unless one holds more than all of them.
LIMN_FN int min_max_windows_first(int low, int level, int size) { return min(low >> level, max(size >> level, 1) - 1); }
LIMN_FN int min_max_windows_second(int high, int first, int level) {
  return max((high >> level) + 1 - (1 << min_max_overlap), first);
}

LIMN_END

#ifndef __cplusplus
#include "glsl/shadow/depth_bounds.glsl"

// Bounds of the depths in texels low..high (both included) of one layer, low <= high: at least as wide as the truth.
// Windows go by the longer side of what of the box lies in the map. The part outside the map has depth 1.
vec2 min_max_windows_depth(sampler2DArray windows, ivec2 low, ivec2 high, int layer) {
  ivec2 size = textureSize(windows, 0).xy;
  ivec2 a = max(low, ivec2(0));
  ivec2 b = min(high, size - 1);
  if (any(greaterThan(a, b))) return vec2(1.0);
  int level = min_max_windows_level(max(b.x - a.x, b.y - a.y) + 1);
  bool covered = min_max_windows_cover(a.x, b.x, level) && min_max_windows_cover(a.y, b.y, level);
  level += covered ? 0 : 1;
  ivec2 first = ivec2(min_max_windows_first(a.x, level, size.x), min_max_windows_first(a.y, level, size.y));
  ivec2 second = ivec2(min_max_windows_second(b.x, first.x, level), min_max_windows_second(b.y, first.y, level));
  return depth_bounds_of_four(windows, first, second, layer, level, a == low && b == high);
}
#endif

#endif  // LIMN_MIN_MAX_WINDOWS_GLSL
