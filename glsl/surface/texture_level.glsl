// The mip level of a texture lookup, as the GPU and the reference both choose it.
#ifndef LIMN_TEXTURE_LEVEL_GLSL
#define LIMN_TEXTURE_LEVEL_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Level of detail for trilinear filtering without anisotropy: log2 of the longer side of the pixel's footprint in
// texels (OpenGL 4.5, 8.14.1, with the footprint's sides as scale factors). uv_dx, uv_dy: change of the texture
// coordinates to the right and to the upper neighbour within the 2x2 quad of the pixel; size: texels of level 0.
// Negative where the texture is magnified, at least -32.
LIMN_FN float texture_level(vec2 uv_dx, vec2 uv_dy, vec2 size) {
  vec2 across = uv_dx * size;
  vec2 up = uv_dy * size;
  return 0.5f * log2(max(max(dot(across, across), dot(up, up)), 5.421010862e-20f));
}

LIMN_END
#endif  // LIMN_TEXTURE_LEVEL_GLSL
