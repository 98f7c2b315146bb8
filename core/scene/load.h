// Reading scenes and environments from files. Every input is untrusted.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace limn::scene {

struct LoadLimits {
  uint64_t vertices = 200'000'000;  ///< elements of all attributes, indices, morph targets and animations
  uint64_t imageTexels = 1ull << 28;
  int nodes = 1'000'000;
  uint64_t instances = 10'000'000;  ///< drawn primitives, and joint matrices
};

/// Loads glTF 2.0 (.gltf, .glb). Where the middle of what is drawn lies more than 64 of its radii from the
/// origin (on one axis), Scene::origin is a place in its midst and translations of nodes count as the file's
/// doubles. Throws Error of one line naming file, place, value and what would be
/// accepted. Files named by the scene are read from its folder or below, nowhere else.
LIMN_API Scene load(const std::filesystem::path& file, const LoadLimits& limits = {});
/// The same from memory (GLB or JSON), without access to any file: the fuzzer's entry.
LIMN_API Scene loadMemory(std::span<const std::byte> bytes, const LoadLimits& limits = {});
/// The scene's own file, and every file in its folder or below that a text of the document names: buffers,
/// images, grids, environments. Documents that cannot be read name none.
LIMN_API std::vector<std::filesystem::path> filesOf(const std::filesystem::path& scene);
/// The brightest that a pixel of an environment may be: fifty thousand times the sun's disc in W / (m^2 sr),
/// six hundred times in cd / m^2. Sums over all pixels and products with the largest scale (1e9) stay finite.
inline constexpr float mostEnvironmentRadiance = 1e12f;

/// Equirectangular .hdr or .exr. Pixels below 0 or above mostEnvironmentRadiance are clamped to that, and
/// one more line of `warnings` says how many there are; NaN and infinities are an Error.
LIMN_API Environment loadEnvironment(const std::filesystem::path& file, std::vector<std::string>& warnings);

}  // namespace limn::scene
