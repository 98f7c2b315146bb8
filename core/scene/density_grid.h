// Densities of inhomogeneous media on the CPU: files, smoke at a time, lookups, integrals along rays.
#pragma once

#include <chrono>
#include <filesystem>

#include "core/base/export.h"
#include "core/scene/scene.h"
#include "glsl/smoke.glsl"

namespace limn::scene {

/// What a file's grid may be, and what reading it may take.
struct GridLimits {
  uint64_t fileBytes = uint64_t{1} << 29;
  uint64_t voxels = uint64_t{1} << 26;  ///< of the box around the voxels that are set
  int side = 2048;                      ///< voxels
  uint64_t memory = uint64_t{1} << 31;  ///< bytes of address space of the process that reads it
  std::chrono::milliseconds time{60'000};
};

/// The grid of floats `density` of an OpenVDB file; where none has that name the first, in the order of the
/// names, of which one may be empty. Its box is that of the voxels that are set, its unit the metre, and it is
/// placed from `origin` (Scene::origin). The file is read in a process of its own (limn-read-grid), since
/// damaged ones crash the library that does it. Throws Error of one line naming file and what would be
/// accepted: no such grid, too many voxels or voxels beyond +-2^30, a transform that is not affine, densities
/// that are negative or no numbers, a file that takes more than the limits or crashes its reader.
LIMN_API DensityGrid readDensityGrid(const std::filesystem::path& file, const GridLimits& limits = {},
                                     const glm::dvec3& origin = glm::dvec3(0));

/// Gives a medium a grid. One that is 0 everywhere is no medium: it takes the coefficients away.
LIMN_API void setGrid(Medium& medium, DensityGrid grid);

/// Density at a place, interpolated as OpenGL interpolates a volume; 0 outside the box.
LIMN_API float densityAt(const DensityGrid& grid, const glm::vec3& place);

/// Integral of the density over from < t < to along origin + t direction, in lengths of `direction`. Exact:
/// between the planes through voxel centres the density along a line is a cubic polynomial, which Gauss's
/// rule with two nodes integrates without error.
LIMN_API double densityLength(const DensityGrid& grid, const glm::vec3& origin, const glm::vec3& direction,
                              float from, float to);

/// Voxels of the grid that smoke is looked up in.
LIMN_API glm::ivec3 smokeVoxels(const Smoke& smoke);
/// What glsl/smoke.glsl is told of it at `time` seconds.
LIMN_API glsl::SmokeBlock smokeBlock(const Smoke& smoke, double time);
/// The grid at `time` seconds.
LIMN_API DensityGrid smokeAt(const Smoke& smoke, double time);
/// Smoke that fills the lower part of a scene of these bounds, with whirls of a quarter of its size.
LIMN_API Smoke smokeIn(const Bounds& bounds);

/// The map from world space into the unit cube of the medium's grid or smoke; the identity where there is
/// none.
LIMN_API glm::mat4 mediumToBox(const Medium& medium);

}  // namespace limn::scene
