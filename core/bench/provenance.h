// Records what a row was measured with, so that a later run can tell whether the row is still valid.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/export.h"

namespace limn::bench {

struct Provenance {
  struct Module {
    std::string technique;
    std::string file;  ///< its name, which says nothing of the machine; in rows of earlier versions its path
    std::string hash;
  };
  std::string program;          ///< hash of the program and limn's libraries; "" in rows of earlier versions
  std::string scene;            ///< hash of the scene with every file it names, environment map and grid
  std::vector<Module> modules;  ///< of the case's techniques, in its order
};

/// Returns why a measurement made with `then` is not valid for `now`: "the program has changed", "the scene
/// has changed", "technique pcss has changed", or that a row of an earlier version does not record it.
/// Returns "" if it is valid. Only contents count, not the paths of the files.
LIMN_API std::string staleness(const Provenance& then, const Provenance& now);

/// Returns a hash of 32 hexadecimal digits of the files' contents, in this order. Throws Error when a file
/// cannot be read.
LIMN_API std::string hashOfFiles(std::span<const std::filesystem::path> files);

/// Returns the program or library that a function of this process comes from. Throws Error when there is
/// none.
LIMN_API std::filesystem::path fileOfFunction(const void* function);

}  // namespace limn::bench
