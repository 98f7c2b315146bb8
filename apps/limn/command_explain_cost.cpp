// limn explain-cost: what a scene lets limn leave out, and what that is worth.
#include <fmt/format.h>

#include <algorithm>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/savings.h"
#include "core/gpu/device.h"
#include "core/reference/reference.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

struct Options {
  SceneOptions scene;
  TechniqueOptions technique;
  BackendOptions backend;
  std::string outputTerm = "final";
  bench::SavingOptions savings;
  int spp = 0;
  fs::path out, json;
};

constexpr double kPatience = 1;  // seconds without a word where there is no terminal

Image referenceImage(const Options& options, const View& view, int interfaces) {
  reference::Request request =
      referenceRequest(view, view.pose, view.camera, reference::termFromName(options.outputTerm));
  request.spp = options.spp;
  request.interfaces = interfaces;
  Progress progress("reference", kPatience);
  request.progress = [&](const reference::Progress& state) {
    progress.update(state.fraction, fmt::format("{} spp", state.spp));
    return true;
  };
  return reference::render(request).image;
}

int run(const Options& options) {
  for (const fs::path& file : {options.out, options.json})
    if (!file.empty()) checkWritable(file);
  const TechniqueRegistry registry(TechniqueRegistry::defaultFolders(), warn);
  render::Settings settings;
  settings.techniques = options.technique.resolve(registry);
  settings.output = render::parseOutput(options.outputTerm);
  render::checkTechniques(settings.techniques, settings.output);
  const View view = open(options.scene);
  settings.size = view.size;
  settings.light = view.light;
  Image reference;
  if (options.spp > 0)
    reference = referenceImage(options, view, render::interfacesOf(settings.output, settings.techniques));

  const auto context = Context::create(options.backend.contextOptions());
  gpu::Device device(*context);
  render::Renderer renderer(device, view.scene);
  renderer.setTime(view.time, view.animation);
  std::vector<bench::SavingResult> results;
  {
    Progress progress("explain-cost", kPatience);
    bench::SavingOptions savings = options.savings;
    savings.progress = [&](double fraction, const std::string& name) { progress.update(fraction, name); };
    results = bench::measureSavings(renderer, view.camera, settings, options.spp > 0 ? &reference : nullptr,
                                    savings);
  }
  const std::string text = fmt::format(
      "{}, {}, {}, {}x{}, {}\n\n{}", options.scene.scene.filename().string(),
      options.technique.techniques.empty() ? "no technique" : options.technique.techniques,
      options.outputTerm, view.size.x, view.size.y, context->info().renderer, toMarkdown(results));
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
  auto options = std::make_shared<Options>();
  options->scene.addTo(command);
  options->technique.addTo(command);
  options->backend.addTo(command);
  command
      .add_option("--output-term", options->outputTerm,
                  "final, visibility, direct, indirect, caustic, media or specular")
      ->capture_default_str();
  command.add_option("--repeat", options->savings.frames, "Frames timed with and without each kind of work")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  command
      .add_option("--spp", options->spp,
                  "Also tell the errors against a reference of this many samples per pixel")
      ->check(CLI::Range(1, 1 << 22));
  command.add_option("-o,--out", options->out, "Write the table to a file, too (Markdown)");
  command.add_option("--json", options->json, "Write all samples as JSON");
  return [options] { return run(*options); };
}

}  // namespace limn::app
