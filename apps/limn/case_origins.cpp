#include "apps/limn/case_origins.h"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/scene/load.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

constexpr const char* kMissing = "missing";

/// Everything that is read from disk before the case can be seen.
std::vector<fs::path> inputFiles(const bench::Case& c) {
  std::vector<fs::path> files = scene::filesOf(findScene(c.scene));
  if (!c.environment.map.empty()) files.push_back(findEnvironment(c.environment.map));
  const std::string& grid = c.changes.grid;
  if (!grid.empty() && grid != "smoke" && grid != "none") files.emplace_back(grid);
  return files;
}

}  // namespace

CaseOrigins::CaseOrigins(const TechniqueRegistry& registry) : registry_(registry) {
  program_ = bench::hashOfFiles(std::vector<fs::path>{"/proc/self/exe", bench::libraryFile()});
}

const std::string& CaseOrigins::sceneHash(const bench::Case& c) {
  const std::string name = fmt::format("{}\x1f{}\x1f{}", c.scene, c.environment.map, c.changes.grid);
  const auto [found, isNew] = scenes_.try_emplace(name, kMissing);
  if (!isNew) return found->second;
  try {
    found->second = bench::hashOfFiles(inputFiles(c));
  } catch (const Error&) {
    // measuring the case says what is wrong
  }
  return found->second;
}

bench::Provenance::Module CaseOrigins::module(const std::string& technique) {
  const auto [found, isNew] = modules_.try_emplace(technique);
  if (!isNew) return found->second;
  found->second = {technique, "", kMissing};
  try {
    const fs::path file = registry_.fileOf(technique);
    found->second = {technique, file.string(), bench::hashOfFiles(std::vector<fs::path>{file})};
  } catch (const Error&) {
    // likewise
  }
  return found->second;
}

bench::Provenance CaseOrigins::of(const bench::Case& c) {
  bench::Provenance result{program_, sceneHash(c), {}};
  if (c.technique == bench::kSeparationFloor) return result;
  for (const std::string& name : CLI::detail::split(c.technique, ','))
    if (!name.empty()) result.modules.push_back(module(name));
  return result;
}

}  // namespace limn::app
