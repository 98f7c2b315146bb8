// Reading scenes and environments from files. Every input is untrusted.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace limn::scene {

struct LoadLimits {
  uint64_t vertices = 200'000'000;  ///< elements of all attributes, indices, morph targets and animations
  uint64_t imageTexels = 1ull << 28;
  int nodes = 1'000'000;
  uint64_t instances = 10'000'000;  ///< drawn primitives, and joint matrices
};

/// Loads glTF 2.0 (.gltf, .glb). Throws Error of one line naming file, place, value and what would be
/// accepted. Files named by the scene are read from its folder or below, nowhere else.
LIMN_API Scene load(const std::filesystem::path& file, const LoadLimits& limits = {});
/// The same from memory (GLB or JSON), without access to any file: the fuzzer's entry.
LIMN_API Scene loadMemory(std::span<const std::byte> bytes, const LoadLimits& limits = {});
/// The scene's own file, and every file in its folder or below that a text of the document names: buffers,
/// images, grids, environments. Documents that cannot be read name none.
LIMN_API std::vector<std::filesystem::path> filesOf(const std::filesystem::path& scene);
/// Equirectangular .hdr or .exr; negative pixels are clamped to 0, NaN and infinities are an Error.
LIMN_API Environment loadEnvironment(const std::filesystem::path& file);

}  // namespace limn::scene
