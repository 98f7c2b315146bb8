// Declares the registry, which finds the technique plug-ins on disk and loads those that are requested.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/technique/technique.h"

namespace limn {

/// Knows techniques by the names of their files and loads a module when it is first requested, so that a
/// broken module affects no other. A module outside limn's own folder is first tried in a separate process.
/// May be used from several threads.
class LIMN_API TechniqueRegistry {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// Looks for *.so in `folders`; of two with one name the one in the earlier folder is used. `warn` receives
  /// one line each for a folder without techniques (limn's own may be empty) and, when a technique is first
  /// requested, for a file that is used instead of another of its name.
  explicit TechniqueRegistry(std::span<const std::filesystem::path> folders, Warn warn = {});
  ~TechniqueRegistry();
  TechniqueRegistry(const TechniqueRegistry&) = delete;
  TechniqueRegistry& operator=(const TechniqueRegistry&) = delete;

  /// Returns the folders of LIMN_TECHNIQUE_PATH (separated by ':'), then builtInFolder().
  static std::vector<std::filesystem::path> defaultFolders();
  /// Returns the folder limn/techniques beside liblimn.
  static std::filesystem::path builtInFolder();

  /// Returns every technique that can be loaded, sorted by name.
  std::span<const TechniquePlugin* const> all() const;
  /// Returns the technique of that name. Throws UsageError for an unknown name (with the nearest known ones),
  /// and Error for a module that is refused.
  const TechniquePlugin& find(std::string_view name) const;

  /// Returns the module file that find(name) loads or refuses, without loading it. Throws UsageError for an
  /// unknown name.
  std::filesystem::path fileOf(std::string_view name) const;

  struct Refusal {
    std::string name;    ///< file name without extension
    std::string reason;  ///< begins with the file
  };
  /// Returns every technique that cannot be loaded, sorted by name.
  std::span<const Refusal> refused() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace limn
