// Declares the readers of scenes and environments from files. Every input is untrusted.
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
  /// Drawn primitives; joint matrices; lights that emissive rectangles are; morph weights.
  uint64_t instances = 10'000'000;
};

/// Loads glTF 2.0 (.gltf, .glb). When the centre of the drawn geometry lies more than 64 of its radii from
/// the origin (on one axis), Scene::origin is a point amid the geometry, and translations of nodes keep the
/// file's double precision. Throws Error with one line that names file, place, value and what would be
/// accepted. Files that the scene names are read only from its folder or below.
LIMN_API Scene load(const std::filesystem::path& file, const LoadLimits& limits = {});
/// Loads the same from memory (GLB or JSON) without access to any file; the fuzzer calls it.
LIMN_API Scene loadMemory(std::span<const std::byte> bytes, const LoadLimits& limits = {});
/// Returns the scene's own file and every file in its folder or below that a string of the document names:
/// buffers, images, grids, environments. A document that cannot be read names none.
LIMN_API std::vector<std::filesystem::path> filesOf(const std::filesystem::path& scene);
/// Limits the radiance of an environment's pixels: fifty thousand times that of the sun's disc in W / (m^2
/// sr), six hundred times in cd / m^2. Sums over all pixels and products with the largest scale (1e9) stay
/// finite.
inline constexpr float kMostEnvironmentRadiance = 1e12f;

/// Returns whether the file is an environment map, by its name: .hdr or .exr, in capitals as well.
LIMN_API bool isEnvironmentFile(const std::filesystem::path& file);
/// Loads an equirectangular .hdr or .exr. Pixels below 0 or above kMostEnvironmentRadiance are clamped to
/// that range, and a line is added to `warnings` with their number. Throws Error for NaN and infinities.
LIMN_API Environment loadEnvironment(const std::filesystem::path& file, std::vector<std::string>& warnings);

}  // namespace limn::scene
