// limn-make-scenes: writes the scene library as glTF 2.0, and, unless scenes are named, the environment maps.
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>

#include "assets/generator/gltf_writer.h"
#include "assets/scenes/scenes.h"
#include "core/base/file.h"

namespace {

using limn::assets::allEnvironments;
using limn::assets::allScenes;
using limn::assets::EnvironmentEntry;
using limn::assets::SceneEntry;

std::string usage() {
  std::string names;
  for (const SceneEntry& entry : allScenes()) names += fmt::format(" {}", entry.name);
  return "usage: limn-make-scenes FOLDER [SCENE...] | --list; scenes:" + names;
}

int wrong(const std::string& problem) {
  fmt::print(stderr, "limn-make-scenes: {}; {}\n", problem, usage());
  return 2;
}

void report(const limn::assets::Scene& scene) {
  std::size_t stored = 0, shown = 0;
  for (const auto& mesh : scene.meshes) {
    for (const auto& primitive : mesh.primitives) stored += primitive.mesh.triangleCount();
  }
  for (const auto& node : scene.nodes) {
    if (node.mesh < 0) continue;
    for (const auto& primitive : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
      shown += primitive.mesh.triangleCount() * std::max<std::size_t>(1, node.instances.size());
    }
  }
  fmt::print("{}: {} triangles stored, {} shown\n", scene.name, stored, shown);
}

void writeEnvironments(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "environments");
  for (const EnvironmentEntry& entry : allEnvironments()) {
    const limn::assets::Image map = entry.make();
    limn::assets::writeExr(map, folder / "environments" / (std::string(entry.name) + ".exr"));
    fmt::print("environment {}: {} x {}\n", entry.name, map.width, map.height);
  }
}

/// Writes what each scene and environment is for, which `limn list` prints.
void writeAbout(const std::filesystem::path& folder) {
  nlohmann::ordered_json scenes, environments;
  for (const SceneEntry& entry : allScenes()) scenes[std::string(entry.name)] = entry.about;
  for (const EnvironmentEntry& entry : allEnvironments()) environments[std::string(entry.name)] = entry.about;
  const nlohmann::ordered_json about{{"scenes", scenes}, {"environments", environments}};
  limn::writeTextFile(folder / "about.json", about.dump(1) + "\n");
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.empty()) return wrong("no folder given");
  if (arguments[0] == "--help" || arguments[0] == "-h") {
    fmt::print("{}\n", usage());
    return 0;
  }
  if (arguments[0] == "--list") {
    for (const SceneEntry& entry : allScenes()) fmt::print("{}\n", entry.name);
    return 0;
  }
  if (arguments[0].starts_with('-')) return wrong(fmt::format("unknown option '{}'", arguments[0]));
  std::vector<SceneEntry> chosen;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const auto found = std::find_if(allScenes().begin(), allScenes().end(),
                                    [&](const SceneEntry& entry) { return entry.name == arguments[i]; });
    if (found == allScenes().end()) return wrong(fmt::format("no scene is called '{}'", arguments[i]));
    chosen.push_back(*found);
  }
  if (chosen.empty()) chosen = allScenes();
  try {
    if (arguments.size() == 1) {
      writeEnvironments(arguments[0]);
      writeAbout(arguments[0]);
    }
    for (const SceneEntry& entry : chosen) {
      limn::assets::Scene scene = entry.make();
      scene.name = entry.name;
      limn::assets::writeScene(scene, std::filesystem::path(arguments[0]) / entry.name);
      report(scene);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "limn-make-scenes: {}\n", error.what());
    return 1;
  }
  return 0;
}
