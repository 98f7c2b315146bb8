// limn stress: every technique on the extremes it declares and on those that all techniques meet.
#include <fmt/format.h>

#include <algorithm>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/stress.h"
#include "core/gpu/objects.h"
#include "core/scene/load.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

struct Options {
  std::string techniques, filter;
  fs::path out;
  BackendOptions backend;
};

struct Case {
  const TechniquePlugin* technique;
  const StressCase* stressCase;
  bool own;
};

std::vector<const TechniquePlugin*> chosen(const TechniqueRegistry& registry, const std::string& names) {
  if (names.empty()) return {registry.all().begin(), registry.all().end()};
  std::vector<const TechniquePlugin*> plugins;
  for (const std::string& name : CLI::detail::split(names, ',')) plugins.push_back(&registry.find(name));
  return plugins;
}

/// A technique may declare a common case with settings of its own, where its defaults would take hours.
bool declares(const TechniquePlugin& technique, std::string_view name) {
  return std::ranges::any_of(technique.info->stress, [&](const StressCase& c) { return name == c.name; });
}

std::vector<Case> chosenCases(const TechniqueRegistry& registry, const Options& options) {
  std::vector<Case> cases;
  const auto add = [&](const TechniquePlugin* technique, const StressCase& c, bool own) {
    if (std::string_view(c.name).find(options.filter) != std::string_view::npos)
      cases.push_back({technique, &c, own});
  };
  for (const TechniquePlugin* technique : chosen(registry, options.techniques)) {
    for (const StressCase& c : bench::commonStressCases())
      if (!declares(*technique, c.name)) add(technique, c, false);
    for (const StressCase& c : technique->info->stress) add(technique, c, true);
  }
  if (cases.empty()) throw UsageError(fmt::format("no stability case has '{}' in its name", options.filter));
  return cases;
}

int run(const Options& options) {
  if (!options.out.empty()) {
    createFolder(options.out);
    checkWritable(options.out / "stress.md");
  }
  const TechniqueRegistry registry(TechniqueRegistry::defaultFolders());
  const std::vector<Case> cases = chosenCases(registry, options);
  const auto context = Context::create(options.backend.contextOptions());
  gpu::Device device(*context);
  bench::StressRun stress(device, [](const std::string& name) { return scene::load(findScene(name)); });

  std::vector<bench::StressResult> results;
  int failed = 0;
  Progress progress("stress");
  for (const Case& c : cases) {
    progress.update(double(results.size()) / double(cases.size()),
                    fmt::format("{}: {}", c.technique->info->name, c.stressCase->name));
    results.push_back(stress.run(*c.technique, *c.stressCase, c.own));
    failed += results.back().verdict == bench::Verdict::failed;
  }
  const std::string table = toMarkdown(results);
  fmt::print("{}", table);
  if (!options.out.empty()) {
    writeTextFile(options.out / "stress.md", table);
    writeTextFile(options.out / "stress.json", toJson(results, context->info().renderer));
  }
  return failed > 0 ? 1 : 0;
}

}  // namespace

Action addStressCommand(CLI::App& command) {
  auto options = std::make_shared<Options>();
  command.add_option("--technique", options->techniques, "Techniques, comma-separated; default: all");
  command.add_option("--filter", options->filter, "Only cases whose name contains this text");
  command.add_option("--out", options->out, "Folder for stress.md and stress.json");
  options->backend.addTo(command);
  return [options] { return run(*options); };
}

}  // namespace limn::app
