// limn explain-cost: measures what it saves to leave out work that a scene does not need.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/markdown_text.h"
#include "core/bench/savings.h"
#include "core/gpu/device.h"
#include "core/reference/reference.h"
#include "core/render/renderer.h"
#include "core/session/view.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

struct ExplainCostArguments {
  SceneQuestion scene;
  session::TechniqueChoice technique;
  BackendOptions backend;
  bench::SavingOptions savings;
  int spp = 0;
  fs::path out, json;
};

/// The reference of what the techniques show.
Image referenceImage(const ExplainCostArguments& options, const session::View& view,
                     const std::vector<render::TechniqueUse>& techniques) {
  reference::Request request =
      session::referenceRequest(view, view.pose, view.camera, parseTerm(options.scene.term));
  request.spp = options.spp;
  request.bounces = render::bouncesOf(request.term, techniques);
  request.interfaces = render::interfacesOf(request.term, techniques);
  Progress progress("reference", kProgressPatience);
  request.progress = [&](const reference::Progress& state) {
    progress.update(state.fraction, fmt::format("{} spp", state.spp));
    return true;
  };
  return reference::render(request).image;
}

int runExplainCost(const ExplainCostArguments& options) {
  for (const fs::path& file : {options.out, options.json})
    if (!file.empty()) checkWritable(file);
  checkApart({options.out, options.json}, filesRead(options.scene));
  const TechniqueRegistry registry(TechniqueRegistry::defaultFolders(), warn);
  render::Settings settings;
  settings.techniques = options.technique.resolve(registry);
  settings.term = parseTerm(options.scene.term);
  render::checkTechniques(settings.techniques, settings.term);
  const session::View view = session::open(options.scene, warn);
  if (view.aa > 1)
    throw UsageError(fmt::format("--aa {}: explain-cost compares single frames; 1 is accepted", view.aa));
  settings.size = view.size;
  settings.light = view.light;
  Image reference;
  if (options.spp > 0) reference = referenceImage(options, view, settings.techniques);

  const auto context = Context::create(options.backend.contextOptions());
  gpu::Device device(*context);
  render::Renderer renderer(device, view.scene);
  renderer.setTime(view.time, view.animation);
  std::vector<bench::SavingResult> results;
  {
    Progress progress("explain-cost", kProgressPatience);
    bench::SavingOptions savings = options.savings;
    savings.progress = [&](double fraction, const std::string& name) { progress.update(fraction, name); };
    results = bench::measureSavings(renderer, view.camera, settings, options.spp > 0 ? &reference : nullptr,
                                    savings);
  }
  context->throwErrors();
  const std::string what =
      fmt::format("{}, {}, {}, {}x{}, {}", fs::path(options.scene.scene).filename().string(),
                  options.technique.techniques.empty() ? "no technique" : options.technique.techniques,
                  options.scene.term, view.size.x, view.size.y, context->info().renderer);
  const std::string text = bench::markdownText(what) + "\n\n" + toMarkdown(results);
  fmt::print("{}", text);
  const auto write = [](const fs::path& file, const std::string& content) {
    if (file.empty()) return;
    writeTextFile(file, content);
    sayWritten(file);
  };
  write(options.out, text);
  write(options.json, toJson(results) + "\n");
  return std::ranges::all_of(results, &bench::SavingResult::holds) ? 0 : 1;
}

}  // namespace

Action addExplainCostCommand(CLI::App& command) {
  auto options = std::make_shared<ExplainCostArguments>();
  addSceneFlags(command, options->scene);
  addSceneFlag(command, options->scene, "term");
  addTechniqueFlags(command, options->technique);
  options->backend.addTo(command);
  command
      .add_option("--repeat", options->savings.frames,
                  "Number of frames to time with, and again without, each kind of work")
      ->capture_default_str()
      ->transform(wholeRange(1, 100000));
  command
      .add_option("--spp", options->spp,
                  "Also report the errors against a reference with this many samples per pixel")
      ->transform(wholeRange(1, 1 << 22));
  command.add_option("-o,--out", options->out, "Also write the table to this Markdown file");
  command.add_option("--json", options->json, "Write all time samples to this JSON file");
  return [options] { return runExplainCost(*options); };
}

}  // namespace limn::app
