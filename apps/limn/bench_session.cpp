#include "apps/limn/bench_session.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/bench/machine.h"
#include "core/render/frame_stats.h"

namespace limn::app {
namespace fs = std::filesystem;

struct BenchSession::Loaded {
  SceneOptions options;
  View view;
  render::Renderer renderer;

  Loaded(gpu::Device& device, SceneOptions chosen)
      : options(std::move(chosen)), view(open(options, true)), renderer(device, view.scene) {}
};

SceneOptions sceneOptions(const bench::Case& c) {
  SceneOptions options;
  options.scene = findScene(c.scene);
  options.camera = c.camera;
  options.light = c.light;
  options.lightSize = c.lightSize;
  options.environment = c.environment.map;
  options.environmentLights = {.threshold = c.environment.lights,
                               .resolution = c.environment.resolution,
                               .shape = c.environment.shape};
  options.environmentReflection = c.environment.reflection;
  options.sigmaA = c.medium.sigmaA;
  options.sigmaS = c.medium.sigmaS;
  options.g = c.medium.g;
  options.eye = c.changes.eye;
  options.target = c.changes.target;
  options.fov = c.changes.fov;
  options.animation = c.changes.animation;
  options.lightSettings = c.changes.setLight;
  options.defaultLights = c.changes.defaultLights;
  options.environmentRotation = c.changes.environmentRotation;
  options.environmentScale = c.changes.environmentScale;
  options.grid = c.changes.grid;
  options.time = c.time;
  options.size = fmt::format("{}x{}", c.width, c.height);
  return options;
}

TechniqueOptions techniqueOptions(const bench::Case& c) {
  TechniqueOptions options;
  options.techniques = c.technique;
  for (const auto& [name, value] : c.parameters)
    options.settings.push_back(fmt::format("{}={}", name, value));
  return options;
}

namespace {

/// But for what load() sets of a scene that is there: size, camera and the light that shines.
bool sameScene(const SceneOptions& a, SceneOptions b) {
  b.size = a.size;
  b.camera = a.camera;
  b.eye = a.eye;
  b.target = a.target;
  b.fov = a.fov;
  b.light = a.light;
  return a == b;
}

render::Settings baseSettings(const View& view, render::Output output, int light) {
  render::Settings settings;
  settings.size = view.size;
  settings.output = output;
  settings.light = light;
  settings.channels = true;
  return settings;
}

bench::CostSplit costSplit(const render::FrameStats& stats) {
  bench::CostSplit split;
  for (const render::PassStats& pass : stats.passes) {
    double& part = pass.technique == "core"     ? split.rest
                   : pass.triangles > 0         ? split.maps
                   : pass.technique == "shadow" ? split.filters
                                                : split.technique;
    part += pass.ms.median;
  }
  return split;
}

}  // namespace

BenchSession::BenchSession(const BackendOptions& backend, const fs::path& out, std::function<void()> alive)
    : out_(out),
      alive_(std::move(alive)),
      cache_(out / "references", warn),
      context_(Context::create(backend.contextOptions())),
      device_(*context_),
      registry_(TechniqueRegistry::defaultFolders(), warn) {}

BenchSession::~BenchSession() = default;

void BenchSession::forgetScene() {
  loaded_.reset();
}

BenchSession::Loaded& BenchSession::load(const bench::Case& c) {
  SceneOptions options = sceneOptions(c);
  if (!loaded_ || !sameScene(loaded_->options, options)) {
    loaded_.reset();
    loaded_ = std::make_unique<Loaded>(device_, std::move(options));
    loaded_->renderer.setTime(loaded_->view.time, loaded_->view.animation);
    return *loaded_;
  }
  View& view = loaded_->view;
  view.size = {c.width, c.height};
  if (view.defaultLights) {
    moveTo(view, options, view.time);
    loaded_->renderer.setTime(view.time, view.animation);
  } else {
    view.camera = chooseCamera(options, view.pose);
  }
  view.light = c.light.empty() ? scene::none : findNamed("light", c.light, view.pose.lightNames);
  return *loaded_;
}

reference::Request BenchSession::request(const bench::Case& c, reference::Term term, int light) {
  const View& view = load(c).view;
  reference::Request request = referenceRequest(view, view.pose, view.camera, term);
  request.light = light == scene::none ? reference::allLights : light;
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
  const reference::Request asked = request(c, reference::termFromName(c.term), load(c).view.light);
  reference::Result result = cache_.render(asked);
  const fs::path file = cache_.pathOf(reference::contentHash(asked));
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
  loaded.renderer.configure(baseSettings(loaded.view, render::Output::direct, light));
  loaded.renderer.setCamera(loaded.view.camera);
  loaded.renderer.render();
  return loaded.renderer.read();
}

/// Sum over the lights of L_u * V_reference: what no visibility technique can beat.
Image BenchSession::separationFloor(const bench::Case& c) {
  const int chosen = load(c).view.light;
  const size_t lights = load(c).view.pose.lights.size();
  Image sum;
  for (size_t light = 0; light < lights; ++light) {
    if (chosen != scene::none && static_cast<size_t>(chosen) != light) continue;
    const Image v = cache_.render(request(c, reference::Term::visibility, static_cast<int>(light))).image;
    Image lit = unshadowed(c, static_cast<int>(light));
    for (int y = 0; y < lit.height(); ++y)
      for (int x = 0; x < lit.width(); ++x)
        for (int i = 0; i < 3; ++i) lit.at(x, y, i) *= v.at(x, y, v.channel("R"));
    if (sum.empty()) {
      sum = std::move(lit);
      continue;
    }
    for (int y = 0; y < sum.height(); ++y)
      for (int x = 0; x < sum.width(); ++x)
        for (int i = 0; i < 3; ++i) sum.at(x, y, i) += lit.at(x, y, i);
  }
  if (sum.empty()) throw Error(fmt::format("scene {} has no light to separate", c.scene));
  return sum;
}

render::Settings BenchSession::settingsOf(const bench::Case& c) {
  Loaded& loaded = load(c);
  render::Settings settings = baseSettings(loaded.view, render::parseOutput(c.term), loaded.view.light);
  settings.techniques = techniqueOptions(c).resolve(registry_);
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
  loaded.renderer.setTime(loaded.view.time, loaded.view.animation);
  return samples;
}

bench::Measurement BenchSession::measure(const bench::Case& c) {
  if (c.technique == bench::kSeparationFloor) {
    bench::Measurement floor{separationFloor(c), {}};
    floor.cost.renderer = rendererName();
    floor.cost.software = context_->info().software;
    return floor;
  }
  Loaded& loaded = load(c);
  render::Settings settings = settingsOf(c);
  settings.channels = true;
  loaded.renderer.configure(settings);
  loaded.renderer.setCamera(loaded.view.camera);
  loaded.renderer.render();
  bench::Measurement result{loaded.renderer.read(), {}};

  configureTimed(loaded, c, settings);
  render::FrameStats stats = render::measure(loaded.renderer, c.frames, c.warmup, playback(loaded, c));
  loaded.renderer.setTime(loaded.view.time, loaded.view.animation);
  stats.scene = c.scene;
  result.cost.renderer = stats.renderer;
  result.cost.backend = stats.backend;
  result.cost.timer = frame::name(stats.timer);
  result.cost.software = stats.software;
  result.cost.frameMs = {stats.frameMs.median, stats.frameMs.q1, stats.frameMs.q3, stats.frameMs.n,
                         stats.frameSamplesMs};
  result.cost.split = costSplit(stats);
  result.cost.memoryBytes = stats.memoryBytes;
  result.cost.details = render::toJson(stats);
  result.cost.driver = context_->info().vendor + ", " + context_->info().version;
  result.cost.machine = bench::machineName();
  result.cost.lights =
      loaded.view.light == scene::none ? static_cast<int>(loaded.view.pose.lights.size()) : 1;
  for (const render::TechniqueUse& use : settings.techniques)
    for (const Parameter& parameter : use.plugin->info->parameters)
      if (parameter.tradesErrorForTime)
        result.cost.qualityParameters.push_back(fmt::format("{}.{}", use.plugin->info->name, parameter.name));
  return result;
}

}  // namespace limn::app
