#include "core/technique/registry.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "core/base/error.h"
#include "core/base/text.h"

namespace limn {
namespace fs = std::filesystem;
namespace {

/// Empty when the plug-in was built against the same interface as this core.
std::string mismatch(const Handshake& theirs) {
  const Handshake ours = handshake();
  if (theirs.interfaceNumber != ours.interfaceNumber)
    return fmt::format("it was built for interface {}, this limn has interface {}", theirs.interfaceNumber,
                       ours.interfaceNumber);
  if (std::strncmp(theirs.compiler, ours.compiler, sizeof ours.compiler) != 0)
    return fmt::format("it was built with compiler {:.63}, this limn with {:.63}", theirs.compiler,
                       ours.compiler);
  if (std::strncmp(theirs.headers, ours.headers, sizeof ours.headers) != 0)
    return fmt::format("it was built against headers {:.32}, this limn has {:.32}; rebuild it",
                       theirs.headers, ours.headers);
  return {};
}

}  // namespace

const char* name(Term term) {
  switch (term) {
    case Term::visibility:
      return "visibility";
    case Term::direct:
      return "direct";
    case Term::indirect:
      return "indirect";
    case Term::caustic:
      return "caustic";
    case Term::media:
      return "media";
    case Term::environment:
      return "environment";
    case Term::specular:
      return "specular";
  }
  return "";
}

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
  Dl_info self{};
  if (dladdr(reinterpret_cast<void*>(&TechniqueRegistry::defaultFolders), &self) != 0 && self.dli_fname)
    folders.push_back(fs::absolute(self.dli_fname).parent_path() / "limn" / "techniques");
  return folders;
}

TechniqueRegistry::TechniqueRegistry(std::span<const fs::path> folders) {
  for (const fs::path& folder : folders) {
    std::error_code ignored;  // a folder that is not there holds no techniques
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
      if (entry.path().extension() == ".so") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) loadModule(file);
  }
  std::sort(plugins_.begin(), plugins_.end(),
            [](const auto* a, const auto* b) { return std::strcmp(a->info->name, b->info->name) < 0; });
}

TechniqueRegistry::~TechniqueRegistry() {
  for (void* module : modules_) dlclose(module);
}

void TechniqueRegistry::loadModule(const fs::path& file) {
  const std::string stem = file.stem().string();
  const auto known = [&](const TechniquePlugin* p) { return stem == p->info->name; };
  if (std::any_of(plugins_.begin(), plugins_.end(), known)) return;
  void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!module) {
    refused_.push_back({stem, dlerror()});
    return;
  }
  std::string reason;
  using EntryPoint = const TechniquePlugin* (*)();
  const auto entry = reinterpret_cast<EntryPoint>(dlsym(module, "limnTechniquePlugin"));
  const TechniquePlugin* plugin = entry ? entry() : nullptr;
  if (!plugin) {
    reason = "it has no entry point limnTechniquePlugin";
  } else if (reason = mismatch(plugin->handshake); reason.empty() && stem != plugin->info->name) {
    reason = fmt::format("it calls itself {}", plugin->info->name);
  }
  if (!reason.empty()) {
    refused_.push_back({stem, reason});
    dlclose(module);
    return;
  }
  modules_.push_back(module);
  plugins_.push_back(plugin);
}

const TechniquePlugin& TechniqueRegistry::find(std::string_view name) const {
  std::vector<std::string> names;
  for (const TechniquePlugin* plugin : plugins_) {
    if (name == plugin->info->name) return *plugin;
    names.emplace_back(plugin->info->name);
  }
  for (const Refusal& refusal : refused_)
    if (name == refusal.name) throw Error(fmt::format("technique {} was refused: {}", name, refusal.reason));
  throw UsageError(fmt::format("unknown technique '{}'{}; known are {}", name, didYouMean(name, names),
                               names.empty() ? "none" : joined(names)));
}

fs::path TechniqueRegistry::fileOf(std::string_view name) const {
  Dl_info module{};
  if (dladdr(&find(name), &module) == 0 || !module.dli_fname)
    throw Error(fmt::format("technique {} comes from no file", name));
  return module.dli_fname;
}

}  // namespace limn
