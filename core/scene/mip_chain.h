// Texture levels built on the CPU, so that the GPU and the reference filter the same texels.
#pragma once

#include "core/scene/scene.h"

namespace limn::scene {

/// Appends levels to `texture`, whose level 0 is filled, down to 1 x 1. A level has half the size of the one
/// before, rounded down, at least 1. Each texel averages, by area, the texels it covers: 2 x 2, or 3 along an
/// odd side (weights that make the mean of a level that of the one before). sRGB colour is averaged in linear
/// light, alpha as it is.
LIMN_API void buildMipChain(TextureImage& texture);

}  // namespace limn::scene
