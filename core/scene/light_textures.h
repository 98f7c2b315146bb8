// Textures that spots shine through, on the GPU: uploaded, and read by passes.
#pragma once

#include <map>
#include <string>

#include "core/frame/frame_graph.h"
#include "core/scene/scene.h"
#include "core/technique/technique.h"

namespace limn::scene {

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
