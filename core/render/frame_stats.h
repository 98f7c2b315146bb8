// Declares what a frame cost: the output of `limn render --stats` and part of every bench row.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/scene/scene.h"

namespace limn::render {

class Renderer;

struct Quartiles {
  double median = 0, q1 = 0, q3 = 0;
  int n = 0;
};
/// Returns the quartiles by linear interpolation between order statistics; n = 0 for no samples.
LIMN_API Quartiles quartiles(std::vector<double> samples);
/// Returns, by the same interpolation, the value below which a share p of the samples, 0 to 1, lies; 0 for no
/// samples.
LIMN_API double quantile(std::vector<double> samples, double p);

struct PassStats {
  std::string name, technique;
  frame::PassRole role = frame::PassRole::core;
  frame::PassState state = frame::PassState::run;
  std::string reason;
  Quartiles ms;
  int64_t bytes = 0;
  uint64_t triangles = 0;  ///< drawn in a frame, views counted
};

/// Describes how the shadow maps of one light were placed in the last frame.
struct ShadowMapFit {
  std::string light;
  std::string projection;  ///< perspective, orthographic, cube or hemicube
  int layers = 0;
  double near = 0, far = 0;  ///< metres, of the first layer that shows something
  double halfAngle = 0;      ///< radians; perspective only
};

struct FrameStats {
  std::string renderer, backend;
  frame::Timing timer = frame::Timing::finish;  ///< how the passes were timed
  bool software = false;
  bool dynamic = true;
  int width = 0, height = 0;
  int framesPerPicture = 1;  ///< that supersample() averages; all times are those of one
  std::string scene, technique;
  std::vector<std::pair<std::string, std::string>> parameters;  ///< "technique.parameter", value
  Quartiles frameMs;                   ///< as timeFrames(), in a run of its own without pass timing
  std::vector<double> frameSamplesMs;  ///< what frameMs comes from, in the order measured
  double passSumMs = 0;                ///< median over frames of the passes' sum, in the run with pass timing
  int64_t memoryBytes = 0;
  std::vector<PassStats> passes;
  std::vector<ShadowMapFit> shadowMaps;
  uint32_t uncoveredPixels = 0;  ///< whose receiver no map of a light covers: V = 1 there
};

/// Declares the scene's time in timed frames.
struct Playback {
  double start = 0;              ///< seconds, of the first frame
  double fps = 0;                ///< frames per second of the scene's time; 0: it stands still, at whatever
                                 ///< Renderer::setTime said
  int animation = scene::kNone;  ///< as Renderer::setTime
  std::function<void()> beforeFrame{};  ///< called before each sample, outside of its time; may be empty
};

/// Returns the wall-clock milliseconds of each of `frames` frames between two glFinish, after `warmup`
/// others, which show the same times as the first timed ones. On a GPU the others are at least as many as
/// take 300 ms, which is when its clock has risen, and where the scene stands still each sample is the mean
/// of as many frames as fill 20 ms, one after the other without waiting for the GPU, as a program shows them.
LIMN_API std::vector<double> timeFrames(Renderer& renderer, int frames, int warmup,
                                        const Playback& playback = {});

/// Returns the milliseconds that a technique's own passes (frame::PassRole::technique) take together in each
/// of `frames` frames with pass timing, after `warmup` others.
LIMN_API std::vector<double> timeOwnPasses(Renderer& renderer, std::string_view technique, int frames,
                                           int warmup, const Playback& playback = {});

/// Renders `warmup` frames, then `frames` timed ones as a whole, then as many with pass timing. Everything is
/// computed in every frame; where the renderer is configured static, what depends on geometry, lights or the
/// camera alone is kept as long as these do not change.
LIMN_API FrameStats measure(Renderer& renderer, int frames, int warmup = 3, const Playback& playback = {});

LIMN_API std::string toJson(const FrameStats& stats);

}  // namespace limn::render
