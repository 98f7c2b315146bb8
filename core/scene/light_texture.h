// Declares textures that spot lights project: made from an image, and looked up on the CPU.
#pragma once

#include "core/scene/scene.h"

namespace limn::scene {

/// Returns an image as a light texture: averaged, in linear light, over each of the LightTexture::side
/// squared texels.
LightTexture makeLightTexture(const TextureImage& image);

/// Returns the factor on the light's radiation towards `receiver` (world space); 1 when there is no texture.
/// The lookup is bilinear, as in OpenGL.
LIMN_API glm::vec3 lightTextureAt(const Scene& scene, const glsl::Light& light, const glm::vec3& receiver);

}  // namespace limn::scene
