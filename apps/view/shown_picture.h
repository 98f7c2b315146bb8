// Holds one picture of the view: a renderer and what the panels show about its last frame.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/gpu/device.h"
#include "core/render/renderer.h"
#include "core/session/view.h"

namespace limn::app {

class ShownPicture {
 public:
  ShownPicture(gpu::Device& device, const session::View& view, std::filesystem::path shaders)
      : device_(device), renderer_(device, view.scene, std::move(shaders)) {}

  /// Sets what the next render() shows, if the settings have changed.
  void configure(const render::Settings& settings);
  enum class Outcome {
    done,
    failed,     ///< problem() says why; there is no picture then
    cancelled,  ///< the picture is unchanged
  };
  /// Renders one frame. `cancelled` is asked between its passes.
  Outcome render(const scene::CameraPose& camera, double time, int animation, bool timed,
                 const frame::FrameGraph::Cancelled& cancelled);
  /// Compiles the shaders that changed on disk and returns whether any file did. Where a shader does not
  /// compile, its last good version stays in use, and shaderProblem() says why.
  bool reloadShaders();
  /// Says that the scene's environment, or anything else that the renderer keeps, may have changed.
  void forget() { configured_ = false; }

  /// Returns the tone-mapped picture, bottom row first; null before the first one.
  const gpu::Texture* display() const { return shown_ ? &renderer_.display() : nullptr; }
  Image read() const { return renderer_.read(); }
  /// Returns whether a picture with aa x aa samples in each pixel takes more than the frame of render():
  /// also where techniques average over several frames.
  bool takesMoreFrames(int aa) const;
  /// Returns the picture as seen by `camera` with aa x aa samples in each pixel (render::supersample), the
  /// first of a sequence; nothing where `cancelled`, asked before each of its frames, said so.
  std::optional<Image> read(const scene::CameraPose& camera, int aa,
                            const std::function<bool()>& cancelled = {});
  /// Renders and returns the picture of a sequence that follows the one of read() or next() before. `light`
  /// is the number that the chosen light has at that time (render::Settings::light).
  Image next(const scene::CameraPose& camera, double time, int animation, int light, int aa);
  const std::string& problem() const { return problem_; }
  const std::string& shaderProblem() const { return shaderProblem_; }
  double frameMs() const { return frameMs_; }
  const std::vector<frame::PassReport>& passes() const { return passes_; }
  const std::vector<frame::PassTime>& times() const { return times_; }
  render::Renderer& renderer() { return renderer_; }

 private:
  gpu::Device& device_;
  render::Renderer renderer_;
  render::Settings settings_;
  bool configured_ = false, shown_ = false;
  std::string problem_, shaderProblem_;
  double frameMs_ = 0;
  std::vector<frame::PassReport> passes_;
  std::vector<frame::PassTime> times_;
};

}  // namespace limn::app
