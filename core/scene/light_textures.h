// Textures that spots shine through: made from images, looked up on the CPU, and read by passes.
#pragma once

#include <map>
#include <string>

#include "core/frame/frame_graph.h"
#include "core/scene/scene.h"
#include "core/technique/technique.h"

namespace limn::scene {

/// An image as a light texture: averaged over each texel of LightTexture::side squared, in linear light.
LightTexture makeLightTexture(const TextureImage& image);

/// The factor on what a light sends to `receiver`, world; 1 without a texture. Bilinear, as OpenGL does it.
LIMN_API glm::vec3 lightTextureAt(const Scene& scene, const glsl::Light& light, const glm::vec3& receiver);

/// All of a scene in one array texture; empty where there is none.
gpu::Texture makeLightTextures(gpu::Device& device, const Scene& scene);

/// What a pass needs whose shaders include glsl/light_texture.glsl.
class LIMN_API LightTextureInput {
 public:
  explicit LightTextureInput(const SceneHandles& handles) : textures_(handles.lightTextures) {}
  /// Adds LIGHT_TEXTURES.
  void define(std::map<std::string, std::string>& defines) const;
  void declare(frame::PassBuilder& pass) const;
  void bind(const frame::PassContext& context) const;

 private:
  frame::TextureHandle textures_;
};

}  // namespace limn::scene
