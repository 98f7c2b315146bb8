// Finds the technique plug-ins on disk and loads those that fit this build.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/technique/technique.h"

namespace limn {

class LIMN_API TechniqueRegistry {
 public:
  /// Loads every *.so in `folders`, the first of a name wins. A module that does not fit is not an error
  /// until it is asked for by name.
  explicit TechniqueRegistry(std::span<const std::filesystem::path> folders);
  ~TechniqueRegistry();
  TechniqueRegistry(const TechniqueRegistry&) = delete;
  TechniqueRegistry& operator=(const TechniqueRegistry&) = delete;

  /// The folders of LIMN_TECHNIQUE_PATH (separated by ':'), then limn/techniques beside liblimn.
  static std::vector<std::filesystem::path> defaultFolders();

  /// Sorted by name.
  std::span<const TechniquePlugin* const> all() const { return plugins_; }
  /// Throws UsageError for an unknown name (with the nearest known ones), Error for a module that was
  /// refused.
  const TechniquePlugin& find(std::string_view name) const;

  /// The module file that find(name) comes from; throws as find() does.
  std::filesystem::path fileOf(std::string_view name) const;

  struct Refusal {
    std::string name;  ///< file name without extension
    std::string reason;
  };
  std::span<const Refusal> refused() const { return refused_; }

 private:
  void loadModule(const std::filesystem::path& file);
  std::vector<void*> modules_;
  std::vector<const TechniquePlugin*> plugins_;
  std::vector<Refusal> refused_;
};

}  // namespace limn
