// Declares the provenance of each case of a bench: hashes of the program, of files and of technique modules.
#pragma once

#include <map>
#include <string>

#include "core/base/export.h"
#include "core/bench/provenance.h"
#include "core/bench/suite.h"
#include "core/technique/registry.h"

namespace limn::session {

/// Finds the provenance of cases. Every file is read once, so that a change during a run counts only for the
/// next run.
class LIMN_API CaseOrigins {
 public:
  /// Uses `registry`, which must outlive the object.
  explicit CaseOrigins(const TechniqueRegistry& registry);

  /// Returns the provenance of the case. Files that cannot be read and techniques that do not exist have the
  /// hash "missing".
  bench::Provenance of(const bench::Case& c);

 private:
  const std::string& sceneHash(const bench::Case& c);
  bench::Provenance::Module module(const std::string& technique);

  const TechniqueRegistry& registry_;
  std::string program_;
  std::map<std::string, std::string> scenes_;                 ///< by the names in the case
  std::map<std::string, bench::Provenance::Module> modules_;  ///< by technique
};

}  // namespace limn::session
