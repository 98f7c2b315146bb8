#include "core/technique/module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/foreign_exception.h"
#include "core/technique/private/plugin_check.h"
#include "core/technique/private/shared_object.h"

namespace limn {
namespace fs = std::filesystem;
namespace {

using EntryPoint = const TechniquePlugin* (*)();

/// The file that holds an address; empty if none is known.
fs::path fileOf(const void* address) {
  Dl_info info{};
  if (dladdr(address, &info) == 0 || !info.dli_fname) return {};
  return fs::absolute(info.dli_fname).lexically_normal();
}

const TechniquePlugin* callEntryPoint(void* handle) {
  const auto entry = reinterpret_cast<EntryPoint>(dlsym(handle, "limnTechniquePlugin"));
  if (!entry) throw Error("it has no entry point limnTechniquePlugin");
  try {
    return entry();
  } catch (...) {
    rethrowAsError("its entry point failed");
  }
}

void* load(const fs::path& file) {
  if (const std::string problem = sharedObjectProblem(readFile(file)); !problem.empty()) throw Error(problem);
  try {
    if (void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) return handle;
  } catch (...) {
    rethrowAsError("its initialisation failed");
  }
  throw Error(dlerror());
}

std::string declarationProblem(const TechniquePlugin& plugin, const std::string& name) {
  try {
    return pluginProblem(plugin, name);
  } catch (...) {
    rethrowAsError("it cannot be looked over");
  }
}

/// `what`, behind the name of the file unless that stands there already.
Error named(const fs::path& file, const std::string& what) {
  return Error(what.find(file.string()) == std::string::npos ? fmt::format("{}: {}", file.string(), what)
                                                             : what);
}

}  // namespace

void Module::Closer::operator()(void* handle) const {
  dlclose(handle);
}

Module::Module(const fs::path& file, const std::string& name) {
  try {
    handle_.reset(load(file));
    plugin_ = callEntryPoint(handle_.get());
    if (!plugin_) throw Error("its entry point gives no plug-in");
    if (const std::string difference = mismatch(plugin_->handshake, handshake(interfaceHash()));
        !difference.empty())
      throw Error(
          fmt::format("{} (limn: {}); rebuild it against this limn", difference, limnFile().string()));
    if (const std::string problem = declarationProblem(*plugin_, name); !problem.empty())
      throw Error(problem);
  } catch (const Error& error) {
    throw named(file, error.what());
  }
}

fs::path limnFile() {
  return fileOf(reinterpret_cast<const void*>(&limnFile));
}

std::string described(const TechniquePlugin& plugin) {
  return fmt::format("technique {} ({})", plugin.info->name, fileOf(&plugin).string());
}

std::unique_ptr<Technique> createTechnique(const TechniquePlugin& plugin) {
  std::unique_ptr<Technique> technique = inTechnique(plugin, plugin.create);
  if (!technique) throw Error(described(plugin) + ": it makes no instance of itself");
  return technique;
}

}  // namespace limn
