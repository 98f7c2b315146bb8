// What a row was measured with, so that a later run can tell whether it still holds.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/export.h"

namespace limn::bench {

struct Provenance {
  struct Module {
    std::string technique, file, hash;
  };
  std::string program;          ///< hash of the program and liblimn; "" in rows of earlier versions
  std::string scene;            ///< hash of the scene with every file it names, environment map and grid
  std::vector<Module> modules;  ///< of the case's techniques, in its order
};

/// Why what `then` measured does not answer for `now`: "the program has changed", "the scene has changed",
/// "technique pcss has changed", or that a row of an earlier version does not say. "" if it does. Contents
/// count, not where the files lie.
LIMN_API std::string staleness(const Provenance& then, const Provenance& now);

/// 32 hexadecimal digits: of the contents of files, in this order. Throws Error for what cannot be read.
LIMN_API std::string hashOfFiles(std::span<const std::filesystem::path> files);

/// The file of liblimn that is running.
LIMN_API std::filesystem::path libraryFile();

}  // namespace limn::bench
