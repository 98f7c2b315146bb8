#include "apps/view/recent_scenes.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>

#include "core/base/error.h"
#include "core/base/file.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostScenes = 10;
constexpr std::uint64_t kMostBytes = 1 << 16;

/// The value of a variable that holds an absolute path; empty where it does not.
fs::path folderOf(const char* variable) {
  const char* value = std::getenv(variable);
  const fs::path folder = value ? value : "";
  return folder.is_absolute() ? folder : fs::path();
}

/// The file that holds them, one in a line; empty where the user has no folder.
fs::path memory() {
  const fs::path state = folderOf("XDG_STATE_HOME"), home = folderOf("HOME");
  if (!state.empty()) return state / "limn/scenes";
  return home.empty() ? fs::path() : home / ".local/state/limn/scenes";
}

}  // namespace

std::vector<fs::path> recentScenes() {
  std::vector<fs::path> scenes;
  const fs::path file = memory();
  std::error_code unknown;
  if (file.empty() || !fs::is_regular_file(file, unknown)) return scenes;
  try {
    std::istringstream lines(readTextFile(file, kMostBytes));
    for (std::string line; scenes.size() < kMostScenes && std::getline(lines, line);)
      if (fs::is_regular_file(line, unknown)) scenes.emplace_back(line);
  } catch (const Error&) {  // as if there were none
  }
  return scenes;
}

void noteRecentScene(const fs::path& scene) {
  std::error_code unknown;
  const fs::path file = memory(), absolute = fs::weakly_canonical(scene, unknown);
  if (file.empty() || !fs::is_regular_file(absolute, unknown) ||
      absolute.string().find('\n') != std::string::npos)
    return;
  const std::vector<fs::path> before = recentScenes();
  std::vector<fs::path> scenes = before;
  std::erase(scenes, absolute);
  scenes.insert(scenes.begin(), absolute);
  if (scenes == before) return;
  std::string text;
  for (size_t i = 0; i < std::min(scenes.size(), kMostScenes); ++i) text += scenes[i].string() + "\n";
  try {
    createFolder(file.parent_path());
    writeTextFile(file, text);
  } catch (const Error&) {  // nothing is remembered
  }
}

}  // namespace limn::app
