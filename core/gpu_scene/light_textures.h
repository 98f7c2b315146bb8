// Declares how the textures that spot lights shine through are uploaded to the GPU and read by passes.
#pragma once

#include <map>
#include <string>

#include "core/frame/frame_graph.h"
#include "core/gpu_scene/scene_handles.h"
#include "core/scene/scene.h"

namespace limn::scene {

/// Returns all light textures of a scene in one array texture; empty where there are none.
gpu::Texture makeLightTextures(gpu::Device& device, const Scene& scene);

/// Provides the define and the read that a pass needs if its shaders include glsl/light/light_texture.glsl.
class LIMN_API LightTextureInput {
 public:
  explicit LightTextureInput(const SceneHandles& handles) : textures_(handles.lightTextures) {}
  /// Adds LIGHT_TEXTURES.
  void define(std::map<std::string, std::string>& defines) const;
  void declare(frame::PassBuilder& pass) const;

 private:
  frame::TextureHandle textures_;
};

}  // namespace limn::scene
