// Declares the density of an inhomogeneous medium on the GPU, and how passes read the scene's medium.
#pragma once

#include <map>
#include <string>

#include "core/base/parameters.h"
#include "core/frame/frame_graph.h"
#include "core/gpu_scene/scene_handles.h"
#include "core/scene/scene.h"
#include "glsl/media/smoke.glsl"

namespace limn::scene {

/// Holds a volume of densities: a grid, which is uploaded once, or smoke, which a pass fills again when time
/// has changed. Empty where the medium is homogeneous.
class GpuMedium {
 public:
  GpuMedium(gpu::Device& device, const Medium& medium);
  /// Sets the smoke's state to that at `time`; returns true if it changed.
  bool update(double time);
  /// Returns the volume, for smoke after adding the pass "smoke" that fills it; empty if the medium is
  /// homogeneous.
  frame::TextureHandle addPass(frame::FrameGraph& graph);
  /// Marks the smoke as changed in the graph of the last addPass().
  void touch(frame::FrameGraph& graph) const;
  void forget() { block_ = {}; }

 private:
  const Medium& medium_;
  gpu::Texture volume_;
  gpu::Buffer smoke_;
  glsl::SmokeBlock current_{};
  frame::BufferHandle block_;
};

/// Number of points along a path through the grid's box at which core's passes look up the density.
constexpr int kCoreMediumSteps = 32;

/// Provides what a pass needs if its shaders include glsl/media/medium_input.glsl, besides the frame block.
class LIMN_API MediumInput {
 public:
  /// Sets the number of points along a path through the grid's box at which the density is looked up
  /// (`steps`, a compile-time constant of the shaders).
  explicit MediumInput(const SceneHandles& handles, int steps = kCoreMediumSteps)
      : density_(handles.density), steps_(steps) {}
  /// Adds MEDIUM_STEPS.
  void define(std::map<std::string, std::string>& defines) const;
  void declare(frame::PassBuilder& pass) const;

 private:
  frame::TextureHandle density_;
  int steps_;
};

/// Returns the parameter of techniques that march through a medium.
constexpr Parameter mediumStepsParameter() {
  return integer(
             "medium_steps", 16, {1, 256}, "points",
             "Sets at how many points the density of the medium's grid is looked up along a ray that crosses "
             "the grid's box from one face to the opposite one; longer and shorter rays get points in "
             "proportion. More points are slower and more accurate. The value has no effect in a homogeneous "
             "medium, which has no grid")
      .quality()
      .logScale();
}

}  // namespace limn::scene
