// Records what a row was measured with, so that a later run can tell whether the row is still valid.
#pragma once

#include <filesystem>
#include <map>
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

/// Tells measurements that stand beside newer ones of another version: of the program, of their scene's files
/// or of one of their techniques.
class LIMN_API NewestProvenance {
 public:
  /// Takes what the next newer measurement in that scene was made with; one of an earlier version, which does
  /// not record it, changes nothing.
  void add(const std::string& scene, const Provenance& provenance);
  /// Returns whether a measurement in that scene was made with something else than the newest one: with
  /// another program, with other files than the newest in the scene, or with another module than the newest
  /// of one of its techniques. False where none records it.
  bool differs(const std::string& scene, const Provenance& provenance) const;

 private:
  std::string program_;
  std::map<std::string, std::string> scenes_, modules_;  ///< hashes by scene, by technique
};

/// Returns a hash of 32 hexadecimal digits of the files' contents, in this order. Throws Error when a file
/// cannot be read.
LIMN_API std::string hashOfFiles(std::span<const std::filesystem::path> files);

/// Returns the program or library that a function of this process comes from. Throws Error when there is
/// none.
LIMN_API std::filesystem::path fileOfFunction(const void* function);

}  // namespace limn::bench
