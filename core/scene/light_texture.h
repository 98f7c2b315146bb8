// A texture that a spot shines through: made from an image, and looked up on the CPU.
#pragma once

#include "core/scene/scene.h"

namespace limn::scene {

/// An image as a light texture: averaged over each texel of LightTexture::side squared, in linear light.
LightTexture makeLightTexture(const TextureImage& image);

/// The factor on what a light sends to `receiver`, world; 1 without a texture. Bilinear, as OpenGL does it.
LIMN_API glm::vec3 lightTextureAt(const Scene& scene, const glsl::Light& light, const glm::vec3& receiver);

}  // namespace limn::scene
