// Box filters between the levels of mip chains.
#ifndef LIMN_MIP_WEIGHTS_GLSL
#define LIMN_MIP_WEIGHTS_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Weights of texels 2 i .. 2 i + 2 of the finer level in texel i. Where its size is odd, a texel is as wide as
// 2 + 1 / coarse finer ones, so that the mean of the whole map is the same on every level.
LIMN_FN vec3 mip_weights(int i, int fine, int coarse) {
  if (fine == 1) return vec3(1.0f, 0.0f, 0.0f);
  if (fine == 2 * coarse) return vec3(0.5f, 0.5f, 0.0f);
  return vec3(float(coarse - i), float(coarse), float(i + 1)) / float(fine);
}

LIMN_END
#endif  // LIMN_MIP_WEIGHTS_GLSL
