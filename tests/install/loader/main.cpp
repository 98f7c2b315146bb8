// load_technique FOLDER NAME: loads the techniques of FOLDER with an installed limn and makes one.
#include <cstdio>
#include <filesystem>
#include <span>
#include <string_view>

#include "core/base/error.h"
#include "core/technique/registry.h"
#include "glsl/numeric/language.glsl"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: load_technique FOLDER NAME\n");
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    const limn::TechniqueRegistry registry(std::span(&folder, 1));
    const limn::TechniquePlugin& plugin = registry.find(argv[2]);
    const auto technique = plugin.create();
    const size_t files = plugin.sources().size();
    std::printf("%s: %s, %zu shader files\n", plugin.info->name, plugin.info->title, files);
    return technique != nullptr && files > 0 && limn::glsl::pi > 3 ? 0 : 1;
  } catch (const limn::Error& error) {
    std::fprintf(stderr, "load_technique: %s\n", error.what());
    return 1;
  }
}
