// Declares the fitted table of linearly transformed cosines as a texture and as the CPU reads it
// (glsl::ltc_texel).
#pragma once

#include "core/base/export.h"
#include "core/gpu/objects.h"
#include "glsl/light/ltc.glsl"

namespace limn::shading {

/// Returns the table as an RGBA32F 2D array, ltc_size x ltc_size, two layers, which GLSL's ltc_texel reads as
/// "ltc_table".
LIMN_API gpu::Texture makeLtcTexture(gpu::Device& device);

}  // namespace limn::shading
