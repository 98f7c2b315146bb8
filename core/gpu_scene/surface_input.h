// Declares how passes that reflect light read the surfaces of the G-buffer and the models of their materials.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/gpu_scene/scene_handles.h"

namespace limn::scene {

/// Describes how a technique answers Term::surface: instead of exactly, with textures of its own.
struct SurfaceAnswer {
  struct Texture {
    const char* name;  ///< of the sampler
    frame::TextureHandle texture;
    const char* why;  ///< as for PassBuilder::read()
  };
  /// Names the shader file that defines material_response() as glsl/materials/response.glsl has it.
  std::string file;
  std::map<std::string, std::string> defines;  ///< that it needs; names that no pass uses itself
  std::vector<Texture> textures;
  int steps = 0;  ///< that the loops of material_response() take, at most: software renderers count them
};

/// Provides what a pass needs if its shaders include glsl/surface/surface_response.glsl, besides the frame
/// block. A scene whose materials are all metallic-roughness declares the G-buffer alone, and its programs
/// know no other model.
class LIMN_API SurfaceInput {
 public:
  SurfaceInput(const SceneHandles& handles, const GBuffer& gbuffer) : handles_(handles), gbuffer_(gbuffer) {}
  /// Adds MATERIAL_MODELS (bit 1 << kind of each model of the scene, glsl/materials/model.glsl),
  /// SURFACE_TANGENTS, SURFACE_PLACES and, where a technique answers Term::surface, SURFACE_ANSWER with the
  /// defines of that.
  void define(std::map<std::string, std::string>& defines) const;
  void declare(frame::PassBuilder& pass) const;

 private:
  SceneHandles handles_;
  GBuffer gbuffer_;
};

}  // namespace limn::scene
