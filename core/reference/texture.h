// Texture lookups on the CPU: the trilinear filter of OpenGL on the same texels and mip levels.
#pragma once

#include <glm/glm.hpp>

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::reference {

/// Linear RGBA at `uv` ((0, 0) is the first texel's outer corner), level of detail `lod` (0: full size;
/// clamped to the levels there are). No anisotropy. A texture without image is white.
LIMN_API glm::vec4 sampleTexture(const scene::Scene& scene, const scene::TextureRef& texture, glm::vec2 uv,
                                 float lod);

/// Size of the full-size level in texels; (1, 1) without image.
glm::vec2 textureSize(const scene::Scene& scene, const scene::TextureRef& texture);

}  // namespace limn::reference
