// Writes a Scene as binary glTF 2.0, with its textures and its environment beside it.
#pragma once

#include <filesystem>

#include "assets/generator/scene.h"

namespace limn::assets {

/// Writes FOLDER/NAME.glb and the pictures it names. Every file is written beside and renamed. Throws
/// std::runtime_error that names the file.
void writeScene(const Scene& scene, const std::filesystem::path& folder);

}  // namespace limn::assets
