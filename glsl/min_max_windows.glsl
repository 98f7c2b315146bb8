// Lookups in the overlapping min-max windows of a shadow map (shadow::DerivedMaps), between the min-max pyramid, whose
// texels do not overlap, and the N-buffer, whose windows start at every texel: texel i of level l holds the least and the
// greatest depth of the map's texels [i 2^l, i 2^l + min_max_window(l)) along each axis, as far as the map reaches. A mip
// chain, so it takes no more memory than the pyramid.
#ifndef LIMN_MIN_MAX_WINDOWS_GLSL
#define LIMN_MIN_MAX_WINDOWS_GLSL
#include "glsl/language.glsl"
LIMN_BEGIN

// log2 of how many windows begin in the width of one.
LIMN_CONST int min_max_overlap = 2;

LIMN_FN int min_max_window(int level) { return 1 << (level + min_max_overlap); }

// The least level at which two windows cover this many texels where they begin with a window: further ones start in time
// only at the next.
LIMN_FN int min_max_windows_level(int extent) {
  return max(findMSB(uint(max(extent, 1) - 1)) - min_max_overlap, 0);
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
  int x0 = min_max_windows_first(a.x, level, size.x);
  int x1 = min_max_windows_second(b.x, x0, level);
  int y0 = min_max_windows_first(a.y, level, size.y);
  int y1 = min_max_windows_second(b.y, y0, level);
  vec2 t00 = texelFetch(windows, ivec3(x0, y0, layer), level).xy;
  vec2 t10 = texelFetch(windows, ivec3(x1, y0, layer), level).xy;
  vec2 t01 = texelFetch(windows, ivec3(x0, y1, layer), level).xy;
  vec2 t11 = texelFetch(windows, ivec3(x1, y1, layer), level).xy;
  float least = min(min(t00.x, t10.x), min(t01.x, t11.x));
  float greatest = max(max(t00.y, t10.y), max(t01.y, t11.y));
  bool inside = a == low && b == high;
  return vec2(least, inside ? greatest : 1.0);
}
#endif

#endif  // LIMN_MIN_MAX_WINDOWS_GLSL
