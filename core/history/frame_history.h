// Declares what frames leave to those after them: the light of a term, averaged over the last frames as far
// as they show the same surfaces.
//
// Each of the last k frames has a layer of its own, with its view. A place is followed into each of them by
// that frame's camera and by where its instance was then, and counts as far as the same surface is seen
// there. Light is thus fetched from the frame that made it, never from what was fetched before: it does not
// spread from frame to frame, and what no longer holds is gone after k - 1 frames. Surfaces that deform
// (skins, morph targets) are followed as their instances are.
//
// A technique whose samples of frame i are set i % k of k sets averages all sets wherever nothing was
// hidden: where neither light nor surfaces change, pictures do not change from frame to frame. The frame
// before the last k had the samples of this one. What differs between the two is therefore no noise but light
// that changed, and the more it is, the less older frames count. Where a pixel has a part of a frame's
// samples, this holds only of places that camera and instances leave at the same pixel.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string_view>
#include <vector>

#include "core/base/export.h"
#include "core/frame/frame_graph.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/technique/frame_service.h"

namespace limn::history {

/// Keeps frames. Those of a graph are forgotten when the next one is built.
class LIMN_API FrameHistoryService : public FrameService {
 public:
  static constexpr const char* serviceName = "frame history";
  static constexpr int kMostFrames = 16;

  /// `scene` must outlive the service.
  explicit FrameHistoryService(scene::GpuScene& scene);
  ~FrameHistoryService() override;

  /// Declares passes that average `light` over this frame and up to `frames` - 1 before it, and returns the
  /// result: an RGBA32F array of as many layers, rgb the sum over the frames that count and a their number, 0
  /// where nothing is lit. `light` is an RGBA32F array as large as the surfaces of `gbuffer`, of which rgb /
  /// a is the value and a is 0 where there is none, and below 1 in the first layer where it is of a part of
  /// the frame's samples. `technique` owns the passes. Throws Error where the frames exceed the device's
  /// limits, UsageError where the places of the scene's instances in these frames do.
  frame::TextureHandle average(const GBuffer& gbuffer, frame::TextureHandle light, int frames,
                               std::string_view technique);

 private:
  struct Kept;
  void begin() override;
  bool update(frame::FrameGraph& graph, const scene::Pose& pose) override;

  scene::GpuScene& scene_;
  std::vector<std::unique_ptr<Kept>> kept_;
  std::vector<glm::mat4> places_;  ///< of the instances in the last frame
  uint32_t placed_ = 0;            ///< index of the first frame with these
};

}  // namespace limn::history
