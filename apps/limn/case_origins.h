// What each case of a bench is measured with: hashes of the program, of files and of technique modules.
#pragma once

#include <map>
#include <string>

#include "core/bench/provenance.h"
#include "core/bench/suite.h"
#include "core/technique/registry.h"

namespace limn::app {

/// Reads every file once, so that what changes during a run counts for the next.
class CaseOrigins {
 public:
  /// `registry` must outlive the object.
  explicit CaseOrigins(const TechniqueRegistry& registry);

  /// Files that cannot be read, and techniques that are not there, have the hash "missing".
  bench::Provenance of(const bench::Case& c);

 private:
  const std::string& sceneHash(const bench::Case& c);
  bench::Provenance::Module module(const std::string& technique);

  const TechniqueRegistry& registry_;
  std::string program_;
  std::map<std::string, std::string> scenes_;                 ///< by the names that the case has
  std::map<std::string, bench::Provenance::Module> modules_;  ///< by technique
};

}  // namespace limn::app
