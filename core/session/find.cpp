#include "core/session/find.h"

#include <fmt/format.h>

#include <array>
#include <set>
#include <system_error>

#include "core/base/error.h"
#include "core/base/text.h"

namespace limn::session {
namespace fs = std::filesystem;

namespace {

/// Where files of the build and of an installation lie.
std::array<fs::path, 2> sharedFolders() {
  std::error_code ignored;
  const fs::path prefix = fs::read_symlink("/proc/self/exe", ignored).parent_path().parent_path();
  return {prefix, prefix / "share/limn"};
}

/// Returns the sorted stems of the entries of `folder` for which `accepts` holds.
template <class Accepts>
std::vector<std::string> stemsIn(const fs::path& folder, const Accepts& accepts) {
  std::set<std::string> names;
  std::error_code ignored;
  for (const fs::path& share : sharedFolders())
    for (const auto& entry : fs::directory_iterator(share / folder, ignored))
      if (accepts(entry.path())) names.insert(entry.path().stem().string());
  return {names.begin(), names.end()};
}

}  // namespace

fs::path findShared(const fs::path& folder, const fs::path& file) {
  std::error_code ignored;
  for (const fs::path& share : sharedFolders())
    if (fs::exists(share / folder / file, ignored)) return share / folder / file;
  return {};
}

std::vector<std::string> sceneNames() {
  return stemsIn("assets", [](const fs::path& path) {
    std::error_code ignored;
    return fs::exists(path / path.filename().concat(".glb"), ignored);
  });
}

std::vector<std::string> environmentNames() {
  return stemsIn("assets/environments", [](const fs::path& path) { return path.extension() == ".exr"; });
}

std::vector<std::string> suiteNames() {
  return stemsIn("benchmarks", [](const fs::path& path) { return path.extension() == ".toml"; });
}

namespace {

/// Returns the map of that name; empty when it was not built or installed with limn.
fs::path ownEnvironment(const std::string& name) {
  return findShared("assets/environments", name + ".exr");
}

}  // namespace

fs::path findScene(const fs::path& nameOrFile) {
  std::error_code ignored;
  if (fs::exists(nameOrFile, ignored)) return nameOrFile;
  const std::string name = nameOrFile.string();
  if (name.find('/') == std::string::npos)
    if (const fs::path file = findShared("assets", fs::path(name) / (name + ".glb")); !file.empty())
      return file;
  throw Error(
      fmt::format("scene '{}' does not exist{}; expected a .gltf or .glb file, or the name of one of limn's "
                  "scenes (limn list scenes)",
                  name, didYouMean(name, sceneNames())));
}

fs::path findEnvironment(const fs::path& nameOrFile) {
  std::error_code ignored;
  if (fs::exists(nameOrFile, ignored)) return nameOrFile;
  const fs::path name = nameOrFile.filename();
  if (name == nameOrFile)
    if (const fs::path file = ownEnvironment(name.string()); !file.empty()) return file;
  throw Error(
      fmt::format("environment '{}' does not exist{}; expected an equirectangular .exr or .hdr file, or the "
                  "name of one of limn's maps (limn list environments)",
                  nameOrFile.string(), didYouMean(nameOrFile.string(), environmentNames())));
}

fs::path findDefaultEnvironment() {
  const fs::path file = ownEnvironment("studio");
  if (file.empty())
    throw Error(
        "limn's environment 'studio', which belongs to the default lights, is not installed; choose another "
        "with --environment, or --default-lights off");
  return file;
}

fs::path findSuite(const fs::path& nameOrFile) {
  std::error_code ignored;
  if (fs::exists(nameOrFile, ignored)) return nameOrFile;
  const fs::path file = findShared("benchmarks", fs::path(nameOrFile).concat(".toml"));
  if (file.empty())
    throw Error(
        fmt::format("suite '{}' does not exist{}; expected a TOML file, or the name of one of limn's suites "
                    "(limn list suites)",
                    nameOrFile.string(), didYouMean(nameOrFile.string(), suiteNames())));
  return file;
}

}  // namespace limn::session
