// Lookups in the N-buffer of a shadow map (Decoret 2005, N-Buffers for efficient depth map query; shadow::DerivedMaps):
// texel x of level l holds the least and the greatest depth of the map's texels [x, x + 2^l) along each axis, as far as
// the map reaches. All levels are as large as the map: layers of an array, the levels of one layer of the map in a row.
#ifndef LIMN_N_BUFFER_GLSL
#define LIMN_N_BUFFER_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// The lowest level of which two windows cover this many texels: ceil(log2(extent)) - 1, but not below 0. findMSB() is never
// asked for 0, here and elsewhere: its -1 passes for a large unsigned number in NVIDIA's compiler, and max() with 0 keeps it.
LIMN_FN int n_buffer_level(int extent) { return findMSB(uint(max(extent - 1, 1))); }

// Levels of a map of `size` texels along its longer side: what the largest box in it needs.
LIMN_FN int n_buffer_levels(int size) { return n_buffer_level(size) + 1; }

// Where two windows of a level begin that cover the texels low..high (both included), which are at most twice as many as
// a window has. The windows hold no others, unless these are fewer than a window has: then both are one window, placed
// so that the min-max pyramid's level above, which has to take at least as many, never gives tighter bounds.
LIMN_FN int n_buffer_first(int low, int high, int level) {
  int aligned = (low >> level) << level;
  return high < aligned + (1 << level) ? aligned : low;
}
LIMN_FN int n_buffer_second(int high, int first, int level) { return max(high + 1 - (1 << level), first); }

LIMN_END

#ifndef __cplusplus
#include "glsl/shadow/depth_bounds.glsl"

// Bounds of the depths in texels low..high (both included) of one layer, low <= high. Windows go by the longer side of
// what of the box lies in the map. Bounds are exact where the shorter side is no shorter than a window: of squares and
// where the sides differ by one texel; else at least as wide as the truth. The part outside the map has depth 1.
vec2 n_buffer_depth(sampler2DArray windows, ivec2 low, ivec2 high, int layer) {
  ivec2 size = textureSize(windows, 0).xy;
  ivec2 a = max(low, ivec2(0));
  ivec2 b = min(high, size - 1);
  if (any(greaterThan(a, b))) return vec2(1.0);
  int level = n_buffer_level(max(b.x - a.x, b.y - a.y) + 1);
  int slice = layer * n_buffer_levels(max(size.x, size.y)) + level;
  ivec2 first = ivec2(n_buffer_first(a.x, b.x, level), n_buffer_first(a.y, b.y, level));
  ivec2 second = ivec2(n_buffer_second(b.x, first.x, level), n_buffer_second(b.y, first.y, level));
  return depth_bounds_of_four(windows, first, second, slice, 0, a == low && b == high);
}
#endif

#endif  // LIMN_N_BUFFER_GLSL
