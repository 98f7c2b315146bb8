// limn flicker: how much more a technique's pictures change from frame to frame than the truth does.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/limn/commands.h"
#include "apps/limn/interruption.h"
#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/gpu/device.h"
#include "core/image/flicker.h"
#include "core/reference/reference.h"
#include "core/render/renderer.h"
#include "core/render/supersample.h"
#include "core/session/view.h"

namespace limn::app {
namespace {

struct FlickerArguments {
  SceneQuestion scene{.term = name(Term::indirect)};
  session::TechniqueChoice technique;
  BackendOptions backend;
  std::string frames = "0:59";
  double fps = 30;
  std::optional<double> atMost;
  int spp = 128;
  std::optional<int> bounces;
  bool json = false;
};

/// One frame: the technique's picture and the truth with two seeds. The seeds are those of every frame, so
/// that what is noise changes little; what it does change, the two tell.
struct Frame {
  Image picture, truth, twin;
};

/// Sums over the sequence.
struct Sums {
  Change picture, truth, noise;

  void add(const Frame& before, const Frame& after) {
    const std::vector<bool> still = stillPixels(before.truth, after.truth);
    picture.add(before.picture, after.picture, still);
    truth.add(before.truth, after.truth, still);
    noise.add(difference(before.truth, before.twin), difference(after.truth, after.twin), still);
  }
  /// Of one of the two: their difference has twice its variance.
  double noiseOfTruth() const { return noise.mean() / std::sqrt(2.0); }
  double trueChange() const { return withoutNoise(truth.mean(), noiseOfTruth()); }

 private:
  static Image difference(const Image& a, const Image& b) {
    Image result = Image::rgb(a.width(), a.height());
    for (int y = 0; y < a.height(); ++y)
      for (int x = 0; x < a.width(); ++x)
        for (int c = 0; c < 3; ++c) result.at(x, y, c) = a.at(x, y, c) - b.at(x, y, c);
    return result;
  }
};

class Sequence {
 public:
  Sequence(const FlickerArguments& options, const std::vector<render::TechniqueUse>& techniques)
      : options_(options),
        view_(session::open(options.scene, warn)),
        context_(Context::create(options.backend.contextOptions())),
        device_(*context_),
        renderer_(device_, view_.scene) {
    settings_.techniques = techniques;
    settings_.term = parseTerm(options.scene.term);
    settings_.size = view_.size;
    settings_.light = view_.light;
    interfaces_ = render::interfacesOf(settings_.term, techniques);
    bounces_ = options.bounces.value_or(render::bouncesOf(settings_.term, techniques));
    renderer_.configure(settings_);
  }

  Frame at(double time) {
    session::moveTo(view_, options_.scene, time);
    session::chooseLight(view_, options_.scene);
    if (settings_.light != view_.light) {
      settings_.light = view_.light;
      renderer_.configure(settings_);
    }
    renderer_.setTime(view_.time, view_.animation);
    Image picture = render::supersample(renderer_, view_.camera, view_.size, view_.aa);
    context_->throwErrors();
    return {std::move(picture), truth(0), truth(1)};
  }

 private:
  Image truth(uint64_t seed) {
    reference::Request request =
        session::referenceRequest(view_, view_.pose, view_.camera, parseTerm(options_.scene.term));
    request.bounces = bounces_;
    request.interfaces = interfaces_;
    request.spp = options_.spp;
    request.seed = seed;
    return reference::render(request).image;
  }

  const FlickerArguments& options_;
  int interfaces_ = 0, bounces_ = 0;  ///< of the reference
  session::View view_;
  std::unique_ptr<Context> context_;
  gpu::Device device_;
  render::Renderer renderer_;
  render::Settings settings_;
};

void print(const FlickerArguments& options, int frames, const Sums& sums, double ratio) {
  if (options.json) {
    fmt::print("{}\n", nlohmann::json{{"frames", frames},
                                      {"change", sums.picture.mean()},
                                      {"reference_change", sums.trueChange()},
                                      {"reference_noise", sums.noiseOfTruth()},
                                      {"ratio", ratio}}
                           .dump());
    return;
  }
  fmt::print(
      "{} frames: mean absolute change of still surfaces {:.3e} a frame, of the reference {:.3e} (its noise "
      "{:.3e} subtracted): {:.2f} times as much\n",
      frames, sums.picture.mean(), sums.trueChange(), sums.noiseOfTruth(), ratio);
}

int runFlicker(const FlickerArguments& options) {
  const auto range = parseFrames(options.frames);
  if (!range || range->first == range->last)
    throw UsageError(fmt::format("--frames '{}' is not accepted; expected a:b with a < b", options.frames));
  if (options.bounces && !reference::hasBounces(parseTerm(options.scene.term)))
    throw UsageError(fmt::format("--bounces: the term {} has none", options.scene.term));
  const TechniqueRegistry registry(TechniqueRegistry::defaultFolders(), warn);
  const auto techniques = options.technique.resolve(registry);
  render::checkTechniques(techniques, parseTerm(options.scene.term));
  Sequence sequence(options, techniques);
  Sums sums;
  std::optional<Frame> before;
  const int frames = range->last - range->first + 1;
  {
    Progress progress("flicker");
    const LastWords words("interrupted; flicker keeps nothing before its last frame");
    for (int frame = range->first; frame <= range->last; ++frame) {
      Frame now = sequence.at(frame / options.fps);
      if (before) sums.add(*before, now);
      before = std::move(now);
      progress.update(double(frame - range->first + 1) / frames);
    }
  }
  if (!(sums.trueChange() > 0))
    throw Error("flicker: the reference does not change beyond its noise; let the light move or raise --spp");
  const double ratio = sums.picture.mean() / sums.trueChange();
  print(options, frames, sums, ratio);
  if (options.atMost && ratio > *options.atMost)
    throw Error(fmt::format("flicker: {:.2f} times the reference's change; at most {} is asked for", ratio,
                            *options.atMost));
  return 0;
}

}  // namespace

Action addFlickerCommand(CLI::App& command) {
  auto options = std::make_shared<FlickerArguments>();
  addSceneFlags(command, options->scene);
  command.remove_option(command.get_option("--time"));  // --frames takes its place
  addSceneFlag(command, options->scene, "term");
  addTechniqueFlags(command, options->technique);
  options->backend.addTo(command);
  command.add_option("--frames", options->frames, "Frames of the animation to compare, a:b, both included")
      ->capture_default_str();
  command.add_option("--fps", options->fps, "Frames per second of the animation")
      ->capture_default_str()
      ->check(realRange(0.001, 1e5));
  command.add_option("--spp", options->spp, "Samples per pixel of the reference, which is rendered twice")
      ->capture_default_str()
      ->transform(wholeRange(2, 1 << 22));
  command
      .add_option("--bounces", options->bounces,
                  "Bounces of the reference, as in limn reference --bounces; default: those of the "
                  "technique that\nanswers indirect, or the term's")
      ->transform(wholeRange(0, reference::kMaxBounces));
  command.add_option("--at-most", options->atMost, "Exit with status 1 if the ratio exceeds this value")
      ->check(realRange(0.0, 1e9));
  command.add_flag("--json", options->json, "Print JSON");
  return [options] { return runFlicker(*options); };
}

}  // namespace limn::app
