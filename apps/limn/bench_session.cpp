#include "apps/limn/bench_session.h"

#include <fmt/format.h>

#include <set>

#include "apps/limn/worker.h"
#include "core/base/error.h"
#include "core/bench/machine.h"
#include "core/bench/report.h"
#include "core/bench/tables.h"
#include "core/render/frame_stats.h"

namespace limn::app {
namespace fs = std::filesystem;

struct BenchSession::Loaded {
  SceneOptions options;
  View view;
  render::Renderer renderer;

  Loaded(gpu::Device& device, SceneOptions chosen)
      : options(std::move(chosen)), view(open(options)), renderer(device, view.scene) {}
};

namespace {

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

BenchSession::BenchSession(const BackendOptions& backend, const fs::path& out)
    : out_(out),
      cache_(out / "references"),
      context_(Context::create(backend.contextOptions())),
      device_(*context_),
      registry_(TechniqueRegistry::defaultFolders(), warn) {}

BenchSession::~BenchSession() = default;

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
  TechniqueOptions techniques;
  techniques.techniques = c.technique;
  for (const auto& [name, value] : c.parameters)
    techniques.settings.push_back(fmt::format("{}={}", name, value));
  render::Settings settings = baseSettings(loaded.view, render::parseOutput(c.term), loaded.view.light);
  settings.techniques = techniques.resolve(registry_);
  settings.dynamic = c.dynamic;
  return settings;
}

void BenchSession::configureTimed(Loaded& loaded, const bench::Case& c, render::Settings settings) {
  if (c.timeWidth > 0) settings.size = {c.timeWidth, c.timeHeight};
  settings.channels = false;  // what a frame costs does not include what only the comparison needs
  loaded.renderer.configure(settings);
  loaded.renderer.setCamera(loaded.view.camera);
}

render::Playback BenchSession::playback(const Loaded& loaded, const bench::Case& c) {
  return {loaded.view.time, c.fps, loaded.view.animation};
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

fs::path findSuite(const fs::path& nameOrFile) {
  std::error_code ignored;
  if (fs::exists(nameOrFile, ignored)) return nameOrFile;
  const fs::path file = findShared("benchmarks", fs::path(nameOrFile).concat(".toml"));
  if (file.empty())
    throw Error(
        fmt::format("suite '{}' does not exist; expected a TOML file, or the name of one of limn's suites",
                    nameOrFile.string()));
  return file;
}

namespace {

/// In the worker: measures what `out` has no row for.
void measureCases(const std::vector<bench::Case>& cases, const fs::path& out, const BackendOptions& backend,
                  WorkerReport& report) {
  bench::ResultsFile results(out / "results.jsonl");
  BenchSession session(backend, out);
  report.renderer(session.rendererName());
  Progress bar("bench");
  bench::Callbacks callbacks;
  callbacks.reference = [&](const bench::Case& c) { return session.reference(c); };
  callbacks.measure = [&](const bench::Case& c) { return session.measure(c); };
  callbacks.time = [&](const bench::Case& c) { return session.time(c); };
  callbacks.keepPicture = [&](const std::string& name, const Image& image) {
    return session.keepPicture(name, image);
  };
  callbacks.progress = [&](const bench::Progress& progress) {
    if (progress.state == bench::Progress::State::started) report.started(progress.index);
    bar.update((progress.turn - 1 + double(progress.index) / progress.count) / progress.turns,
               bench::label(progress.what));
    if (progress.state == bench::Progress::State::failed)
      fmt::print(stderr, "limn: {}: {}\n", bench::label(progress.what), progress.failure);
  };
  bench::runCases(cases, session.rendererName(), results, callbacks);
}

/// A row that says that measuring it ended the worker.
bench::Row crashRow(const bench::Case& c, const std::string& renderer, const std::string& failure) {
  bench::Row row;
  row.what = c;
  row.key = bench::rowKey(c, renderer);
  row.failure = failure;
  row.cost.renderer = renderer;
  return row;
}

/// Keys of the rows that need not be measured.
std::set<std::string> finishedRows(const fs::path& file) {
  std::set<std::string> keys;
  if (!fs::exists(file)) return keys;
  for (const bench::Row& row : bench::readRows(file))
    if (row.failure.empty()) keys.insert(row.key);
  return keys;
}

}  // namespace

bench::Summary runSuite(const fs::path& suite, const fs::path& out, const BackendOptions& backend,
                        const std::vector<std::string>& filters, bench::Shard shard) {
  const bench::Suite asked = bench::readSuite(suite);
  const auto cases = bench::selectCases(asked.cases, filters, shard);
  if (cases.empty())
    throw UsageError(fmt::format("suite {} has no case that fits the filter", suite.string()));
  createFolder(out);
  const fs::path file = out / "results.jsonl";
  const std::set<std::string> before = finishedRows(file);
  if (asked.minutes > 0)
    fmt::print(
        stderr,
        "limn: suite {} takes about {} minutes in all on 2 cores without a GPU; {} of its {} cases are asked "
        "for, the folder holds {} rows\n",
        asked.name, asked.minutes, cases.size(), asked.cases.size(), before.size());
  WorkerReport report;
  std::vector<bench::Case> left = cases;
  while (!left.empty()) {
    const auto crash = runInWorker(report, [&] { measureCases(left, out, backend, report); });
    if (!crash) break;
    const int index = report.caseIndex();
    if (index < 0) throw Error("no case could be started: the process that measures " + crash->what);
    const auto crashed = left.begin() + index;
    fmt::print(stderr, "limn: {}: {}\n", bench::label(*crashed), crash->what);
    bench::ResultsFile(file).append(crashRow(*crashed, report.renderer(), crash->what));
    left.erase(crashed);
  }
  const std::set<std::string> after = finishedRows(file);
  bench::Summary summary;
  for (const bench::Case& c : cases) {
    const std::string key = bench::rowKey(c, report.renderer());
    ++(before.contains(key) ? summary.skipped : after.contains(key) ? summary.done : summary.failed);
  }
  const std::vector<bench::Row> rows = bench::readRows(file);
  bench::writeTables(rows, out);
  bench::writeReport(rows, out);
  return summary;
}

}  // namespace limn::app
