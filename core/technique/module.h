// Declares how a technique's shared object is loaded and checked.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/base/foreign_exception.h"
#include "core/base/whereabouts.h"
#include "core/technique/technique.h"

namespace limn {

/// Holds a loaded module; it stays loaded as long as this object lives.
class LIMN_API Module {
 public:
  /// Loads the technique `name` from `file` and checks the file, the handshake and everything that it
  /// declares. Throws Error that begins with the file and says what is wrong.
  Module(const std::filesystem::path& file, const std::string& name);

  const TechniquePlugin& plugin() const { return *plugin_; }

 private:
  struct Closer {
    void operator()(void* handle) const;
  };
  std::unique_ptr<void, Closer> handle_;
  const TechniquePlugin* plugin_;
};

/// Loads the module in a separate process, so that a module that crashes, aborts, ends its process or hangs,
/// while it is loaded or when the program ends, does so there. Throws Error that begins with the file when
/// that process ends in such a way; otherwise returns, even when the module was refused.
LIMN_API void tryModule(const std::filesystem::path& file, const std::string& name);

/// Returns the file that liblimn was loaded from.
LIMN_API std::filesystem::path limnFile();

/// Returns "technique NAME (FILE)", for messages about a plug-in that is running.
LIMN_API std::string described(const TechniquePlugin& plugin);

/// Calls into a plug-in and returns the result. Exceptions that are not limn's own become an Error that names
/// technique and file.
template <class Call>
decltype(auto) inTechnique(const TechniquePlugin& plugin, Call&& call) {
  const Whereabouts here(plugin.info->name, nullptr);
  try {
    return call();
  } catch (...) {
    rethrowAsError(described(plugin));
  }
}

/// Returns an instance of the technique. Throws Error that names it and its file when it makes none.
LIMN_API std::unique_ptr<Technique> createTechnique(const TechniquePlugin& plugin);

}  // namespace limn
