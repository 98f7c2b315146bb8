#include "core/render/frame_stats.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/render/renderer.h"

namespace limn::render {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

// A GPU that was idle is several times as slow until its clock has risen, and waiting for it takes as long as
// some frames do.
constexpr double kLeastWarmUpMs = 300;
constexpr double kLeastSampleMs = 20;
constexpr int kMostFramesOfSample = 256;

Json toJsonValue(const Quartiles& q) {
  return {{"median", q.median}, {"q1", q.q1}, {"q3", q.q3}, {"n", q.n}};
}

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// The mean of `frames` frames that follow each other as in a program that shows them.
double meanMilliseconds(Renderer& renderer, int frames) {
  const auto start = Clock::now();
  for (int i = 0; i < frames; ++i) renderer.render();
  renderer.finish();
  return millisecondsSince(start) / frames;
}

void show(Renderer& renderer, const Playback& playback, int frame) {
  if (playback.beforeFrame) playback.beforeFrame();
  if (playback.fps > 0) renderer.setTime(playback.start + frame / playback.fps, playback.animation);
}

/// Returns what a frame takes at the end, on a GPU; else 0.
double warmUp(Renderer& renderer, int frames, const Playback& playback) {
  const auto start = Clock::now();
  for (int i = 0; i < frames; ++i) {
    show(renderer, playback, i);
    renderer.render();
  }
  renderer.finish();
  if (renderer.describe().software) return 0;
  double ms = 0;
  int together = 1;
  do {
    ms = meanMilliseconds(renderer, together);
    together = std::min(2 * together, 32);
  } while (millisecondsSince(start) < kLeastWarmUpMs);
  return ms;
}

double ofSorted(const std::vector<double>& samples, double p) {
  const double position = p * static_cast<double>(samples.size() - 1);
  const auto low = static_cast<size_t>(position);
  const size_t high = std::min(low + 1, samples.size() - 1);
  return std::lerp(samples[low], samples[high], position - static_cast<double>(low));
}

/// Samples of each pass by technique and name: frames may differ in which passes they run.
struct PassSamples {
  std::map<std::pair<std::string, std::string>, std::vector<double>> ms;
  std::vector<double> sums;

  void add(const std::vector<frame::PassTime>& times) {
    double sum = 0;
    for (const frame::PassTime& time : times) {
      ms[{time.technique, time.name}].push_back(time.milliseconds);
      sum += time.milliseconds;
    }
    sums.push_back(sum);
  }
};

}  // namespace

Quartiles quartiles(std::vector<double> samples) {
  if (samples.empty()) return {};
  std::sort(samples.begin(), samples.end());
  return {ofSorted(samples, 0.5), ofSorted(samples, 0.25), ofSorted(samples, 0.75),
          static_cast<int>(samples.size())};
}

double quantile(std::vector<double> samples, double p) {
  if (samples.empty()) return 0;
  std::sort(samples.begin(), samples.end());
  return ofSorted(samples, p);
}

std::vector<double> timeFrames(Renderer& renderer, int frames, int warmup, const Playback& playback) {
  const double ms = warmUp(renderer, warmup, playback);
  const bool single = ms == 0 || playback.fps > 0;
  const int together =
      single ? 1 : static_cast<int>(std::clamp(kLeastSampleMs / ms, 1.0, 1.0 * kMostFramesOfSample));
  std::vector<double> samples;
  for (int i = 0; i < frames; ++i) {
    show(renderer, playback, i);
    samples.push_back(meanMilliseconds(renderer, together));
  }
  return samples;
}

std::vector<double> timeOwnPasses(Renderer& renderer, std::string_view technique, int frames, int warmup,
                                  const Playback& playback) {
  warmUp(renderer, warmup, playback);
  const frame::Timing timer = renderer.describe().timer;
  std::vector<double> samples;
  for (int i = 0; i < frames; ++i) {
    show(renderer, playback, i);
    renderer.render(timer);
    renderer.finish();
    double sum = 0;
    for (const frame::PassTime& pass : renderer.graph().passTimes())
      if (pass.technique == technique && pass.role == frame::PassRole::technique) sum += pass.milliseconds;
    samples.push_back(sum);
  }
  return samples;
}

FrameStats measure(Renderer& renderer, int frames, int warmup, const Playback& playback) {
  FrameStats stats = renderer.describe();
  // Without any frame there would be no graph to describe.
  const std::vector<double> wall =
      timeFrames(renderer, frames, std::max(warmup, frames > 0 ? 0 : 1), playback);
  stats.frameMs = quartiles(wall);
  stats.frameSamplesMs = wall;

  PassSamples samples;
  for (int i = 0; i < frames; ++i) {
    show(renderer, playback, i);
    renderer.render(stats.timer);
    renderer.finish();
    samples.add(renderer.graph().passTimes());
  }
  stats.passSumMs = quartiles(samples.sums).median;
  for (const frame::PassReport& report : renderer.explain()) {
    PassStats pass{report.name, report.technique, report.role,     report.state, report.reason,
                   {},          report.bytes,     report.triangles};
    const auto found = samples.ms.find({report.technique, report.name});
    if (report.state == frame::PassState::run && found != samples.ms.end())
      pass.ms = quartiles(found->second);
    stats.passes.push_back(std::move(pass));
  }
  stats.memoryBytes = renderer.memoryBytes();
  renderer.describeShadowMaps(stats);
  return stats;
}

std::string toJson(const FrameStats& stats) {
  Json parameters = Json::object();
  for (const auto& [name, value] : stats.parameters) parameters[name] = value;
  Json passes = Json::array();
  for (const PassStats& pass : stats.passes)
    passes.push_back({{"name", pass.name},
                      {"technique", pass.technique},
                      {"role", frame::name(pass.role)},
                      {"state", frame::name(pass.state)},
                      {"reason", pass.reason},
                      {"ms", toJsonValue(pass.ms)},
                      {"bytes", pass.bytes},
                      {"triangles", pass.triangles}});
  Json shadowMaps = Json::array();
  for (const ShadowMapFit& fit : stats.shadowMaps)
    shadowMaps.push_back({{"light", fit.light},
                          {"projection", fit.projection},
                          {"layers", fit.layers},
                          {"near", fit.near},
                          {"far", fit.far},
                          {"half_angle", fit.halfAngle}});
  return Json{{"renderer", stats.renderer},
              {"backend", stats.backend},
              {"software", stats.software},
              {"timer", frame::name(stats.timer)},
              {"dynamic", stats.dynamic},
              {"size", {stats.width, stats.height}},
              {"frames_per_picture", stats.framesPerPicture},
              {"scene", stats.scene},
              {"technique", stats.technique},
              {"parameters", parameters},
              {"frame_ms", toJsonValue(stats.frameMs)},
              {"frame_samples_ms", stats.frameSamplesMs},
              {"pass_sum_ms", stats.passSumMs},
              {"memory_bytes", stats.memoryBytes},
              {"passes", passes},
              {"shadow_maps", shadowMaps},
              {"uncovered_pixels", stats.uncoveredPixels}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace limn::render
