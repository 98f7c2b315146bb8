// The fitted table of linearly transformed cosines as the CPU reads it (glsl::ltc_texel) and as a texture.
#pragma once

#include "core/base/export.h"
#include "core/gpu/objects.h"
#include "glsl/ltc.glsl"

namespace limn::shading {

/// RGBA32F 2D array, ltc_size x ltc_size, two layers: what GLSL's ltc_texel reads at unit glsl::ltc_unit.
LIMN_API gpu::Texture makeLtcTexture(gpu::Device& device);

}  // namespace limn::shading
