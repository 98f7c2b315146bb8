// Declares texture lookups on the CPU: the trilinear filter of OpenGL on the same texels and mip levels.
#pragma once

#include <glm/glm.hpp>

#include "core/base/export.h"
#include "core/relief/slopes.h"
#include "core/scene/scene.h"

namespace limn::scene {

/// Returns linear RGBA at `uv` ((0, 0) is the first texel's outer corner) and level of detail `lod` (0: full
/// size; clamped to the existing levels). There is no anisotropic filtering. A texture without an image is
/// white.
LIMN_API glm::vec4 sampleTexture(const Scene& scene, const TextureRef& texture, glm::vec2 uv, float lod);

/// Returns the size of the full-size level in texels; (1, 1) when there is no image.
LIMN_API glm::vec2 textureSize(const Scene& scene, const TextureRef& texture);

/// Returns how textures of a height map go on beyond its edges, along both axes.
inline Wrap wrapOf(const relief::HeightField& field) {
  return field.wrap() == relief::Wrap::clamped ? Wrap::clamp : Wrap::repeat;
}

/// Returns slopes along u and v at `uv` and `lod`, by the same filter. `levels` are those of
/// relief::slopeLevels().
LIMN_API glm::vec2 sampleSlopes(const std::vector<relief::SlopeLevel>& levels, Wrap wrap, glm::vec2 uv,
                                float lod);

}  // namespace limn::scene
