#include "core/technique/registry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <mutex>
#include <optional>

#include "core/base/error.h"
#include "core/base/helper.h"
#include "core/base/text.h"
#include "core/technique/module.h"

namespace limn {
namespace fs = std::filesystem;
namespace {

/// A file that may hold a technique, and what became of it.
struct Candidate {
  fs::path file;
  std::vector<fs::path> unused;  ///< files of the same name in later folders
  bool builtIn = false;
  std::optional<Module> module;
  std::string refusal;

  bool opened() const { return module || !refusal.empty(); }

  void open(const std::string& name) {
    try {
      if (!builtIn) tryModule(file, name);
      module.emplace(file, name);
    } catch (const Error& error) {
      refusal = error.what();
    }
  }
};

}  // namespace

std::vector<fs::path> TechniqueRegistry::defaultFolders() {
  std::vector<fs::path> folders;
  if (const char* list = std::getenv("LIMN_TECHNIQUE_PATH")) {
    std::string_view rest = list;
    while (!rest.empty()) {
      const size_t colon = rest.find(':');
      if (colon != 0) folders.emplace_back(rest.substr(0, colon));
      rest = colon == std::string_view::npos ? std::string_view() : rest.substr(colon + 1);
    }
  }
  folders.push_back(builtInFolder());
  return folders;
}

fs::path TechniqueRegistry::builtInFolder() {
  return libraryFolder() / "limn" / "techniques";
}

struct TechniqueRegistry::Implementation {
  std::map<std::string, Candidate, std::less<>> candidates;
  Warn warn;
  std::mutex mutex;  // of what follows and of the candidates' states
  bool allOpened = false;
  std::vector<const TechniquePlugin*> plugins;
  std::vector<Refusal> refusals;

  void scan(const fs::path& folder) {
    std::error_code problem;
    const bool builtIn = fs::equivalent(folder, builtInFolder(), problem);
    bool any = false;
    fs::directory_iterator entry(folder, problem);
    for (; !problem && entry != fs::directory_iterator(); entry.increment(problem)) {
      if (entry->path().extension() != ".so") continue;
      any = true;
      add(fs::absolute(entry->path()).lexically_normal(), builtIn);
    }
    if (builtIn || !warn) return;
    if (problem)
      warn(fmt::format("technique folder '{}' cannot be read: {}; see LIMN_TECHNIQUE_PATH", folder.string(),
                       problem.message()));
    else if (!any)
      warn(fmt::format("technique folder '{}' holds no technique (*.so); see LIMN_TECHNIQUE_PATH",
                       folder.string()));
  }

  void add(const fs::path& file, bool builtIn) {
    const auto [known, isNew] = candidates.try_emplace(file.stem().string());
    Candidate& candidate = known->second;
    std::error_code ignored;  // what is not there cannot be the same
    if (isNew) {
      candidate.file = file;
      candidate.builtIn = builtIn;
    } else if (!fs::equivalent(candidate.file, file, ignored)) {
      candidate.unused.push_back(file);
    }
  }

  using Entry = std::pair<const std::string, Candidate>;

  /// Throws UsageError for an unknown name.
  Entry& known(std::string_view name) {
    const auto entry = candidates.find(name);
    if (entry != candidates.end()) return *entry;
    std::vector<std::string> names;
    for (const auto& [candidate, ignored] : candidates) names.push_back(candidate);
    throw UsageError(fmt::format("unknown technique '{}'{}; known are {}", name, didYouMean(name, names),
                                 names.empty() ? "none" : joined(names)));
  }

  void open(const std::string& name, Candidate& candidate) {
    if (candidate.opened()) return;
    if (warn)
      for (const fs::path& unused : candidate.unused)
        warn(fmt::format("technique {} is {}, not {}", name, candidate.file.string(), unused.string()));
    candidate.open(name);
  }

  void openAll() {
    const std::lock_guard lock(mutex);
    if (allOpened) return;
    for (auto& [name, candidate] : candidates) {
      open(name, candidate);
      if (candidate.module)
        plugins.push_back(&candidate.module->plugin());
      else
        refusals.push_back({name, candidate.refusal});
    }
    allOpened = true;
  }
};

TechniqueRegistry::TechniqueRegistry(std::span<const fs::path> folders, Warn warn)
    : implementation_(std::make_unique<Implementation>()) {
  implementation_->warn = std::move(warn);
  for (const fs::path& folder : folders) implementation_->scan(folder);
}

TechniqueRegistry::~TechniqueRegistry() = default;

std::span<const TechniquePlugin* const> TechniqueRegistry::all() const {
  implementation_->openAll();
  return implementation_->plugins;
}

std::span<const TechniqueRegistry::Refusal> TechniqueRegistry::refused() const {
  implementation_->openAll();
  return implementation_->refusals;
}

const TechniquePlugin& TechniqueRegistry::find(std::string_view name) const {
  Implementation& self = *implementation_;
  const std::lock_guard lock(self.mutex);
  auto& [known, candidate] = self.known(name);
  self.open(known, candidate);
  if (candidate.module) return candidate.module->plugin();
  throw Error(fmt::format("technique {} was refused: {}", name, candidate.refusal));
}

fs::path TechniqueRegistry::fileOf(std::string_view name) const {
  return implementation_->known(name).second.file;
}

}  // namespace limn
