// OpenVDB files, read by a library that may crash, hang or take all memory on damaged ones: only in the
// program limn-read-grid.
#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>

#include "core/scene/density_grid.h"

namespace limn::scene {

/// What readDensityGrid promises, but the file's name in messages and the check of each density.
DensityGrid readVdbGrid(const std::filesystem::path& file, const GridLimits& limits,
                        const glm::dvec3& origin);

/// The voxels of the box around those that are set, placed from `origin`. Throws Error where that is empty, larger than the limits
/// or out of the range in which the library can count, or where the transform is not affine.
DensityGrid denseGrid(const openvdb::FloatGrid& grid, const GridLimits& limits, const glm::dvec3& origin);

}  // namespace limn::scene
