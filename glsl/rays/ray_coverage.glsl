// The alpha masks of what rays meet, at their textures' full size, as words of one buffer: a header for each mask, the corners
// of its triangles and its texels. Tables are made by core/rays/coverage.h.
#ifndef LIMN_RAY_COVERAGE_GLSL
#define LIMN_RAY_COVERAGE_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Words of a header, in this order.
LIMN_CONST uint ray_mask_corners = 0u;  // first word of the first triangle's corners
LIMN_CONST uint ray_mask_texels = 1u;   // first word of the texels
LIMN_CONST uint ray_mask_width = 2u;    // texels, 0: no texture
LIMN_CONST uint ray_mask_height = 3u;
LIMN_CONST uint ray_mask_wraps = 4u;    // along u, and times 4 along v
LIMN_CONST uint ray_mask_factor = 5u;   // of the material, as a float's bits
LIMN_CONST uint ray_mask_cutoff = 6u;   // likewise
LIMN_CONST uint ray_mask_words = 7u;

// Words of a triangle: three pairs of texture coordinates, and the vertices' alpha as three halfs.
LIMN_CONST uint ray_corner_words = 8u;

LIMN_CONST uint ray_wrap_repeat = 0u;
LIMN_CONST uint ray_wrap_clamp = 1u;
LIMN_CONST uint ray_wrap_mirror = 2u;

// The texel that stands at i of a texture of `size` texels, i at most `size` below 0: GLSL leaves % of negative numbers open.
LIMN_FN int ray_wrap(int i, int size, uint wrap) {
  if (wrap == ray_wrap_clamp) return clamp(i, 0, size - 1);
  int period = wrap == ray_wrap_mirror ? 2 * size : size;
  i = (i + period) % period;
  return i < size ? i : 2 * size - 1 - i;
}

// A coordinate brought near 0, so that texels keep their precision.
LIMN_FN float ray_wrap_near(float u, uint wrap) {
  if (!(abs(u) < 1e30f)) return 0.0f;
  if (wrap == ray_wrap_clamp) return clamp(u, -1.0f, 2.0f);
  return wrap == ray_wrap_mirror ? u - 2.0f * floor(0.5f * u) : u - floor(u);
}

LIMN_END
#endif  // LIMN_RAY_COVERAGE_GLSL
