// The density of an inhomogeneous medium on the GPU, and how passes read the scene's medium.
#pragma once

#include <map>
#include <string>

#include "core/frame/frame_graph.h"
#include "core/scene/scene.h"
#include "core/technique/technique.h"
#include "glsl/smoke.glsl"

namespace limn::scene {

/// A volume of densities: a grid, uploaded once, or smoke, filled anew by a pass when time has changed.
/// Nothing where the medium is homogeneous.
class GpuMedium {
 public:
  GpuMedium(gpu::Device& device, const Medium& medium);
  /// Smoke as it is at that time; true: it changed.
  bool update(double time);
  /// The volume, behind the pass "smoke" if it is; empty: homogeneous.
  frame::TextureHandle addPass(frame::FrameGraph& graph);
  /// In the graph of the last addPass().
  void touch(frame::FrameGraph& graph) const;
  void forget() { block_ = {}; }

 private:
  const Medium& medium_;
  gpu::Texture volume_;
  gpu::Buffer smoke_;
  glsl::SmokeBlock current_{};
  frame::BufferHandle block_;
};

/// Points along a way across the grid's box at which the passes of core look up the density.
constexpr int coreMediumSteps = 32;

/// What a pass needs whose shaders include glsl/medium_input.glsl, besides the frame block.
class LIMN_API MediumInput {
 public:
  /// `steps`: points along a way across the grid's box at which the density is looked up; a compile-time
  /// constant.
  explicit MediumInput(const SceneHandles& handles, int steps = coreMediumSteps)
      : density_(handles.density), steps_(steps) {}
  /// Adds MEDIUM_STEPS.
  void define(std::map<std::string, std::string>& defines) const;
  void declare(frame::PassBuilder& pass) const;
  void bind(const frame::PassContext& context) const;

 private:
  frame::TextureHandle density_;
  int steps_;
};

/// The parameter of techniques that march through a medium.
constexpr Parameter mediumStepsParameter() {
  return integer("medium_steps", 16, {1, 256}, "points",
                 "Points of a way across a medium's grid at which it is looked up, evenly as many of others")
      .quality()
      .logScale();
}

}  // namespace limn::scene
