// limn stress: every technique on the extremes it declares and on those that all techniques meet.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "apps/limn/commands.h"
#include "apps/limn/interruption.h"
#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/file_lock.h"
#include "core/bench/stress.h"
#include "core/gpu/objects.h"
#include "core/scene_io/load.h"
#include "core/session/case_origins.h"
#include "core/session/find.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

struct StressArguments {
  std::string techniques, filter;
  fs::path out;
  BackendOptions backend;
};

struct Case {
  const TechniquePlugin* technique;
  StressCase stressCase;
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

std::vector<Case> chosenCases(const TechniqueRegistry& registry, const StressArguments& options) {
  std::vector<Case> cases;
  const auto add = [&](const TechniquePlugin* technique, const StressCase& c, bool own) {
    if (std::string_view(c.name).find(options.filter) != std::string_view::npos)
      cases.push_back({technique, bench::stressCaseFor(*technique->info, c), own});
  };
  for (const TechniquePlugin* technique : chosen(registry, options.techniques)) {
    for (const StressCase& c : bench::commonStressCases())
      if (!declares(*technique, c.name)) add(technique, c, false);
    for (const StressCase& c : technique->info->stress) add(technique, c, true);
  }
  if (cases.empty()) throw UsageError(fmt::format("no stability case has '{}' in its name", options.filter));
  return cases;
}

bool hasFailed(const bench::StressResult& result) {
  return result.worst().verdict == bench::StressVerdict::failed;
}

bool isOf(const bench::StressResult& result, const Case& c) {
  return result.technique == c.technique->info->name && result.name == c.stressCase.name &&
         result.scene == c.stressCase.scene;
}

/// The results in a folder: written after every case, so that a run that was stopped goes on where it was.
class Table {
 public:
  Table(fs::path folder, std::string renderer) : folder_(std::move(folder)), renderer_(std::move(renderer)) {
    if (folder_.empty()) return;
    createFolder(folder_);
    checkWritable(folder_ / "stress.md");
    lock_.emplace(folder_ / ".lock", fmt::format("folder {}", folder_.string()));
    removeAbandonedFiles(folder_);
    std::error_code ignored;
    const fs::path file = folder_ / "stress.json";
    if (!fs::is_regular_file(file, ignored)) return;
    try {
      results_ = bench::stressFromJson(readTextFile(file), renderer_);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", file.string(), error.what()));
    }
  }

  /// Whether the case has a result of what it asks for and is measured with now, and has not failed.
  bool holds(const Case& c, const bench::Provenance& now) const {
    return std::ranges::any_of(results_, [&](const bench::StressResult& r) {
      return isOf(r, c) && !hasFailed(r) && r.settings == c.stressCase.settings &&
             r.beside == c.stressCase.beside && r.allowed == c.stressCase.factor &&
             bench::staleness(r.provenance, now).empty();
    });
  }

  /// Takes a result in the place of the case's earlier ones.
  void add(bench::StressResult result) {
    std::erase_if(results_, [&](const bench::StressResult& r) {
      return r.technique == result.technique && r.name == result.name && r.scene == result.scene;
    });
    results_.push_back(std::move(result));
    write();
  }

  void write() const {
    if (folder_.empty()) return;
    writeTextFile(folder_ / "stress.md", text());
    writeTextFile(folder_ / "stress.json", toJson(results_, renderer_));
  }

  std::string text() const { return toMarkdown(results_); }
  /// Whether any of the cases has failed. Others may have in an earlier run, which stay in the table.
  bool failed(const std::vector<Case>& cases) const {
    return std::ranges::any_of(results_, [&](const bench::StressResult& r) {
      return hasFailed(r) && std::ranges::any_of(cases, [&](const Case& c) { return isOf(r, c); });
    });
  }

 private:
  fs::path folder_;
  std::optional<FileLock> lock_;
  std::string renderer_;
  std::vector<bench::StressResult> results_;
};

/// What the case is measured with now.
bench::Provenance provenanceOf(const Case& c, session::CaseOrigins& origins) {
  bench::Case what;
  what.scene = c.stressCase.scene;
  what.technique = c.technique->info->name;
  if (const std::string_view beside = c.stressCase.beside; !beside.empty())
    what.technique = fmt::format("{},{}", beside, what.technique);
  what.defaultLights = "off";
  return origins.of(what);
}

int runStress(const StressArguments& options) {
  const TechniqueRegistry registry(TechniqueRegistry::defaultFolders(), warn);
  const std::vector<Case> cases = chosenCases(registry, options);
  const auto context = Context::create(options.backend.contextOptions());
  gpu::Device device(*context);
  Table table(options.out, context->info().renderer);
  session::CaseOrigins origins(registry);
  bench::StressRun stress(device, registry,
                          [](const std::string& name) { return scene::load(session::findScene(name)); });
  {
    Progress progress("stress");
    const LastWords words(options.out.empty()
                              ? std::string("interrupted; nothing is kept without --out")
                              : fmt::format("interrupted; the cases so far are kept in {}, the same command "
                                            "goes on",
                                            options.out.string()));
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const Case& c = cases[i];
      progress.update(double(i) / double(cases.size()),
                      fmt::format("{}: {}", c.technique->info->name, c.stressCase.name));
      bench::Provenance now = provenanceOf(c, origins);
      if (table.holds(c, now)) continue;
      bench::StressResult result = stress.run(*c.technique, c.stressCase, c.own);
      result.provenance = std::move(now);
      context->throwErrors();
      table.add(std::move(result));
    }
  }
  table.write();  // also where the folder held everything
  fmt::print("{}", table.text());
  return table.failed(cases) ? 1 : 0;
}

}  // namespace

Action addStressCommand(CLI::App& command) {
  auto options = std::make_shared<StressArguments>();
  command.add_option("--technique,--techniques", options->techniques,
                     "Techniques, comma-separated; default: all");
  command.add_option("--filter", options->filter, "Only cases whose name contains this text");
  command.add_option(
      "-o,--out", options->out,
      "Folder for stress.md and stress.json; cases whose result in it still holds are skipped");
  options->backend.addTo(command);
  return [options] { return runStress(*options); };
}

}  // namespace limn::app
