#include "core/session/find.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "core/base/error.h"
#include "core/base/file.h"
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

/// Files of one kind that come with limn.
struct FileKind {
  const char* what;
  const char* folder;
  const char* ending;
  bool inOwnFolder;      ///< NAME/NAME.ENDING
  const char* expected;  ///< what may be given
};

constexpr FileKind kSceneFiles{
    "scene", "assets", ".glb", true,
    "a .gltf or .glb file, or the name of one of limn's scenes (limn list scenes)"};
constexpr FileKind kEnvironmentFiles{
    "environment", "assets/environments", ".exr", false,
    "an equirectangular .exr or .hdr file, or the name of one of limn's maps (limn list environments)"};
constexpr FileKind kSuiteFiles{"suite", "benchmarks", ".toml", false,
                               "a TOML file, or the name of one of limn's suites (limn list suites)"};

/// Where the file of that name lies in the folder of its kind.
fs::path placeOf(const FileKind& kind, const std::string& name) {
  const fs::path file = name + kind.ending;
  return kind.inOwnFolder ? name / file : file;
}

/// Returns the sorted names of all files of the kind.
std::vector<std::string> namesOf(const FileKind& kind) {
  std::set<std::string> names;
  std::error_code ignored;
  for (const fs::path& share : sharedFolders())
    for (const auto& entry : fs::directory_iterator(share / kind.folder, ignored)) {
      const std::string name = entry.path().stem().string();
      if (fs::exists(share / kind.folder / placeOf(kind, name), ignored)) names.insert(name);
    }
  return {names.begin(), names.end()};
}

/// Returns what limn-make-scenes says of scenes or environments, by name.
std::map<std::string, std::string> aboutOf(const char* key) {
  const fs::path file = findShared(kSceneFiles.folder, "about.json");
  if (file.empty()) return {};
  try {
    return nlohmann::json::parse(readTextFile(file, 1 << 20))
        .at(key)
        .get<std::map<std::string, std::string>>();
  } catch (const nlohmann::json::exception& error) {
    throw Error(fmt::format("{}: {}", file.string(), oneLine(error.what())));
  }
}

/// Returns the file itself, or that of the name. A folder is neither: results often go into one that has the
/// name of what they are of.
fs::path findFile(const FileKind& kind, const fs::path& nameOrFile) {
  std::error_code ignored;
  const bool isFolder = fs::is_directory(nameOrFile, ignored);
  if (!isFolder && fs::exists(nameOrFile, ignored)) return nameOrFile;
  const std::string name = nameOrFile.string();
  if (nameOrFile.filename() == nameOrFile)
    if (const fs::path file = findShared(kind.folder, placeOf(kind, name)); !file.empty()) return file;
  throw Error(fmt::format("{} '{}' {}{}; expected {}", kind.what, name,
                          isFolder ? "is a folder" : "does not exist", didYouMean(name, namesOf(kind)),
                          kind.expected));
}

}  // namespace

fs::path findShared(const fs::path& folder, const fs::path& file) {
  std::error_code ignored;
  for (const fs::path& share : sharedFolders())
    if (fs::exists(share / folder / file, ignored)) return share / folder / file;
  return {};
}

std::vector<std::string> sceneNames() {
  return namesOf(kSceneFiles);
}

std::vector<std::string> environmentNames() {
  return namesOf(kEnvironmentFiles);
}

std::vector<std::string> suiteNames() {
  return namesOf(kSuiteFiles);
}

std::map<std::string, std::string> aboutScenes() {
  return aboutOf("scenes");
}

std::map<std::string, std::string> aboutEnvironments() {
  return aboutOf("environments");
}

fs::path findScene(const fs::path& nameOrFile) {
  return findFile(kSceneFiles, nameOrFile);
}

fs::path findEnvironment(const fs::path& nameOrFile) {
  return findFile(kEnvironmentFiles, nameOrFile);
}

fs::path findDefaultEnvironment() {
  const fs::path file = findShared(kEnvironmentFiles.folder, placeOf(kEnvironmentFiles, "studio"));
  if (file.empty())
    throw Error(
        "limn's environment 'studio', which belongs to the default lights, is not installed; choose another "
        "with --environment, or --default-lights off");
  return file;
}

fs::path findSuite(const fs::path& nameOrFile) {
  return findFile(kSuiteFiles, nameOrFile);
}

}  // namespace limn::session
