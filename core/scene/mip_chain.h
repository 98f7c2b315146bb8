// Declares mip chains built on the CPU, so that the GPU and the reference filter the same texels.
#pragma once

#include "core/scene/scene.h"

namespace limn::scene {

/// Appends levels down to 1 x 1 to `texture`, whose level 0 is filled. Each level has half the size of the
/// previous one, rounded down, at least 1. Each texel is the area-weighted average of the texels that it
/// covers: 2 x 2, or 3 along an odd side (with weights that preserve the mean of the previous level). sRGB
/// colour is averaged in linear light; alpha is averaged unconverted.
LIMN_API void buildMipChain(TextureImage& texture);

}  // namespace limn::scene
