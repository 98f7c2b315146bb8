#include "core/session/case_origins.h"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/version.h"
#include "core/question/technique_names.h"
#include "core/reference/reference.h"
#include "core/session/view.h"

namespace limn::session {
namespace fs = std::filesystem;
namespace {

constexpr const char* kMissing = "missing";

/// Returns the program and limn's libraries, each of which is told by a function that it has.
std::vector<fs::path> programFiles() {
  std::vector<fs::path> files{"/proc/self/exe"};
  for (const void* function :
       {reinterpret_cast<const void*>(&version), reinterpret_cast<const void*>(&reference::contentHash),
        reinterpret_cast<const void*>(&bench::hashOfFiles), reinterpret_cast<const void*>(&open)})
    files.push_back(bench::fileOfFunction(function));
  return files;
}

}  // namespace

CaseOrigins::CaseOrigins(const TechniqueRegistry& registry) : registry_(registry) {
  program_ = bench::hashOfFiles(programFiles());
}

const std::string& CaseOrigins::sceneHash(const bench::Case& c) {
  const std::string name =
      fmt::format("{}\x1f{}\x1f{}\x1f{}", c.scene, c.environment, c.grid, c.defaultLights);
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
    found->second = {technique, file.filename(), bench::hashOfFiles(std::vector<fs::path>{file})};
  } catch (const Error&) {
    // likewise
  }
  return found->second;
}

bench::Provenance CaseOrigins::of(const bench::Case& c) {
  bench::Provenance result{program_, sceneHash(c), {}};
  if (c.technique == bench::kSeparationFloor) return result;
  for (const NamedTechnique& named : namedTechniques(c.technique))
    if (!named.name.empty()) result.modules.push_back(module(std::string(named.name)));
  return result;
}

}  // namespace limn::session
