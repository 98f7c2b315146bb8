// One technique's shared object, from file to plug-in.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/base/foreign_exception.h"
#include "core/base/whereabouts.h"
#include "core/technique/technique.h"

namespace limn {

class LIMN_API Module {
 public:
  /// Loads the technique `name` from `file` and looks it over: the file, the handshake, everything it
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

/// Tries the same in a process of its own, so that a module which crashes, aborts, ends its process or hangs
/// while it is loaded does so there. Throws Error that begins with the file if that process came to such an
/// end; otherwise returns, even if the module was refused.
LIMN_API void tryModule(const std::filesystem::path& file, const std::string& name);

/// The file that liblimn was loaded from.
LIMN_API std::filesystem::path limnFile();

/// "technique NAME (FILE)": for messages about a plug-in at work.
LIMN_API std::string described(const TechniquePlugin& plugin);

/// Calls into a plug-in. What it throws that is not limn's own becomes an Error that names technique and
/// file.
template <class Call>
decltype(auto) inTechnique(const TechniquePlugin& plugin, Call&& call) {
  const Whereabouts here(plugin.info->name, nullptr);
  try {
    return call();
  } catch (...) {
    rethrowAsError(described(plugin));
  }
}

/// An instance of the technique. Throws Error that names it and its file where it makes none.
LIMN_API std::unique_ptr<Technique> createTechnique(const TechniquePlugin& plugin);

}  // namespace limn
