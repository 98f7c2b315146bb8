// Declares the reader of density grids in OpenVDB files, which runs within limits in a separate process.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>

#include "core/base/export.h"
#include "core/scene/density_grid.h"

namespace limn::scene {

/// Limits the grid of a file and the resources that reading it may use.
struct GridLimits {
  uint64_t fileBytes = uint64_t{1} << 29;
  uint64_t voxels = uint64_t{1} << 26;  ///< of the box around the active voxels
  int side = 2048;                      ///< voxels
  uint64_t memory = uint64_t{1} << 31;  ///< bytes of address space of the process that reads it
  std::chrono::milliseconds time{60'000};
};

/// Returns the float grid `density` of an OpenVDB file or, when no grid has that name, the first grid in
/// order of name (one may be unnamed). Its box is that of the active voxels, its unit is the metre, and it is
/// placed relative to `origin` (Scene::origin). The file is read in a separate process (limn-read-grid),
/// because damaged files crash the library that reads them. Throws Error with one line that names the file
/// and what would be accepted when there is no such grid, there are too many voxels or voxels beyond +-2^30,
/// the transform is not affine, a density is negative or not a number, or the file exceeds the limits or
/// crashes its reader.
LIMN_API DensityGrid readDensityGrid(const std::filesystem::path& file, const GridLimits& limits = {},
                                     const glm::dvec3& origin = glm::dvec3(0));

}  // namespace limn::scene
