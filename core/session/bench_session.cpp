#include "core/session/bench_session.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/cost_split.h"
#include "core/bench/machine.h"
#include "core/render/frame_stats.h"
#include "core/render/supersample.h"
#include "core/session/view.h"
#include "core/technique/bound.h"

namespace limn::session {
namespace fs = std::filesystem;

struct BenchSession::Loaded {
  SceneQuestion question;
  View view;
  render::Renderer renderer;

  Loaded(gpu::Device& device, const SceneQuestion& asked)
      : question(asked), view(open(question)), renderer(device, view.scene) {
    renderer.setTime(view.time, view.animation);
  }

  /// Shows another question about the same openedScene(). Where it throws, lights may be set in part.
  void show(const SceneQuestion& asked) {
    if (session::show(view, question, asked)) renderer.setTime(view.time, view.animation);
    question = asked;
  }
};

TechniqueChoice techniqueChoice(const bench::Case& c) {
  return choiceOf(c.technique, c.parameters);
}

namespace {

render::Settings baseSettings(const View& view, Term term, int light) {
  render::Settings settings;
  settings.size = view.size;
  settings.term = term;
  settings.light = light;
  settings.channels = true;
  return settings;
}

}  // namespace

BenchSession::BenchSession(const ContextOptions& context, const fs::path& out, std::function<void()> alive,
                           const Warn& warn)
    : out_(out),
      alive_(std::move(alive)),
      cache_(out / "references", warn, bench::machineName()),
      context_(Context::create(context)),
      device_(*context_),
      registry_(TechniqueRegistry::defaultFolders(), warn) {}

BenchSession::~BenchSession() = default;

void BenchSession::forgetScene() {
  loaded_.reset();
}

BenchSession::Loaded& BenchSession::load(const bench::Case& c) {
  std::unique_ptr<Loaded> kept = std::move(loaded_);  // nothing is loaded where what follows throws
  if (!kept || openedScene(kept->question) != openedScene(c)) {
    kept.reset();  // before the next one takes its memory
    kept = std::make_unique<Loaded>(device_, c);
  } else {
    kept->show(c);
  }
  loaded_ = std::move(kept);
  return *loaded_;
}

reference::Request BenchSession::request(const bench::Case& c, Term term, int light) {
  const View& view = load(c).view;
  reference::Request request = referenceRequest(view, view.pose, view.camera, term);
  request.light = light == scene::kNone ? reference::kAllLights : light;
  request.spp = c.reference.spp;
  request.noise = c.reference.noise;
  if (reference::hasBounces(term)) request.bounces = c.reference.bounces;
  if (reference::acceptsInterfaces(term, c.reference.interfaces)) request.interfaces = c.reference.interfaces;
  request.progress = [this](const reference::Progress&) {
    alive_();
    return true;
  };
  return request;
}

bench::Reference BenchSession::reference(const bench::Case& c) {
  const reference::Request asked = request(c, parseTerm(c.term), load(c).view.light);
  reference::Result result = cache_.render(asked);
  const fs::path file = cache_.pathOf(result.image.metadata().at("content_hash"));
  if (c.picture) keepPicture(file.stem().string(), result.image);
  return {std::move(result.image), fs::path("references") / file.filename(), result.noiseRms, result.seconds};
}

std::string BenchSession::keepPicture(const std::string& name, const Image& image) {
  createFolder(out_ / "pictures");
  const fs::path file = fs::path("pictures") / (name + ".png");
  writePng(out_ / file, image);
  return file.string();
}

Image BenchSession::unshadowed(const bench::Case& c, int light) {
  Loaded& loaded = load(c);
  loaded.renderer.configure(baseSettings(loaded.view, Term::direct, light));
  return render::supersample(loaded.renderer, loaded.view.camera, loaded.view.size, loaded.view.aa);
}

/// All light without shadows, less what the reference's 1 - V takes of each light: what no visibility
/// technique can beat. Light that no technique shadows, as that of an environment without lights, stays
/// whole.
Image BenchSession::separationFloor(const bench::Case& c) {
  const int chosen = load(c).view.light;
  const size_t lights = load(c).view.pose.lights.size();
  if (lights == 0) throw Error(fmt::format("scene {} has no light to separate", c.scene));
  Image sum = unshadowed(c, chosen);
  for (size_t light = 0; light < lights; ++light) {
    if (chosen != scene::kNone && static_cast<size_t>(chosen) != light) continue;
    const Image v = cache_.render(request(c, Term::visibility, static_cast<int>(light))).image;
    const int visible = v.channel("R");
    const Image lit = chosen == scene::kNone ? unshadowed(c, static_cast<int>(light)) : sum;
    for (int y = 0; y < lit.height(); ++y)
      for (int x = 0; x < lit.width(); ++x)
        for (int i = 0; i < 3; ++i) sum.at(x, y, i) -= lit.at(x, y, i) * (1 - v.at(x, y, visible));
  }
  return sum;
}

render::Settings BenchSession::settingsOf(const bench::Case& c) {
  Loaded& loaded = load(c);
  render::Settings settings = baseSettings(loaded.view, parseTerm(c.term), loaded.view.light);
  settings.techniques = techniqueChoice(c).resolve(registry_);
  checkMeasurable(settings.techniques);
  settings.dynamic = c.dynamic;
  return settings;
}

void BenchSession::configureTimed(Loaded& loaded, const bench::Case& c, render::Settings settings) {
  if (c.timeWidth > 0) settings.size = {c.timeWidth, c.timeHeight};
  settings.channels = false;  // what a frame costs does not include what only the comparison needs
  loaded.renderer.configure(settings);
  loaded.renderer.setCamera(loaded.view.camera);
}

render::Playback BenchSession::playback(const Loaded& loaded, const bench::Case& c) const {
  return {loaded.view.time, c.fps, loaded.view.animation, alive_};
}

std::vector<double> BenchSession::time(const bench::Case& c) {
  const render::Settings settings = settingsOf(c);
  Loaded& loaded = load(c);
  configureTimed(loaded, c, settings);
  std::vector<double> samples = render::timeFrames(loaded.renderer, c.frames, c.warmup, playback(loaded, c));
  context_->throwErrors();
  loaded.renderer.setTime(loaded.view.time, loaded.view.animation);
  return samples;
}

std::optional<bench::BoundTime> BenchSession::bound(const bench::Case& c) {
  if (c.technique == bench::kSeparationFloor || c.frames == 0) return std::nullopt;
  render::Settings settings = settingsOf(c);
  if (std::ranges::none_of(settings.techniques,
                           [](const render::TechniqueUse& use) { return hasBound(*use.plugin); }))
    return std::nullopt;
  Loaded& loaded = load(c);
  const auto timed = [&](std::string_view technique, int frames, int warmup) {
    return render::timeOwnPasses(loaded.renderer, technique, frames, warmup, playback(loaded, c));
  };
  settings.bound = true;
  configureTimed(loaded, c, settings);
  loaded.renderer.render();  // makes the graph, which says whether the lights have a bound
  const std::vector<frame::PassReport> passes = loaded.renderer.explain();
  const auto found = std::ranges::find(passes, kBoundPass, &frame::PassReport::name);
  if (found == passes.end()) return std::nullopt;
  bench::BoundTime time;
  time.bound = timed(found->technique, c.frames, c.warmup);
  settings.bound = false;
  configureTimed(loaded, c, settings);
  time.own = timed(found->technique, c.frames, std::max(c.warmup, 1));
  context_->throwErrors();
  loaded.renderer.setTime(loaded.view.time, loaded.view.animation);
  return time;
}

bench::Measurement BenchSession::measure(const bench::Case& c) {
  if (c.technique == bench::kSeparationFloor) {
    bench::Measurement floor{separationFloor(c), {}};
    floor.cost.renderer = rendererName();
    floor.cost.backend = name(context_->info().backend);
    floor.cost.software = context_->info().software;
    return floor;
  }
  Loaded& loaded = load(c);
  render::Settings settings = settingsOf(c);
  settings.channels = true;
  loaded.renderer.configure(settings);
  bench::Measurement result{
      render::supersample(loaded.renderer, loaded.view.camera, loaded.view.size, loaded.view.aa), {}};

  configureTimed(loaded, c, settings);
  render::FrameStats stats = render::measure(loaded.renderer, c.frames, c.warmup, playback(loaded, c));
  context_->throwErrors();
  loaded.renderer.setTime(loaded.view.time, loaded.view.animation);
  stats.scene = c.scene;
  stats.framesPerPicture = c.aa * c.aa + render::historyOf(settings.term, settings.techniques) - 1;
  result.cost.framesPerPicture = stats.framesPerPicture;
  result.cost.renderer = stats.renderer;
  result.cost.backend = stats.backend;
  result.cost.timer = frame::name(stats.timer);
  result.cost.software = stats.software;
  result.cost.frameMs = {stats.frameMs.median, stats.frameMs.q1, stats.frameMs.q3, stats.frameMs.n,
                         stats.frameSamplesMs};
  result.cost.split = bench::costSplit(stats);
  result.cost.memoryBytes = stats.memoryBytes;
  result.cost.details = render::toJson(stats);
  result.cost.driver = driverName();
  result.cost.machine = bench::machineName();
  result.cost.lights =
      loaded.view.light == scene::kNone ? static_cast<int>(loaded.view.pose.lights.size()) : 1;
  for (const render::TechniqueUse& use : settings.techniques)
    for (const Parameter& parameter : use.plugin->info->parameters)
      if (parameter.tradesErrorForTime)
        result.cost.qualityParameters.push_back(fmt::format("{}.{}", use.plugin->info->name, parameter.name));
  return result;
}

}  // namespace limn::session
