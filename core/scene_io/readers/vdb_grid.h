// Declares the reader of OpenVDB files. The library may crash, hang or use up all memory on damaged files, so
// only the program limn-read-grid uses it.
#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>

#include "core/scene_io/density_grid_file.h"

namespace limn::scene {

/// Returns what readDensityGrid returns, and throws as it does, except that messages do not name the file and
/// that the densities are not checked.
DensityGrid readVdbGrid(const std::filesystem::path& file, const GridLimits& limits,
                        const glm::dvec3& origin);

/// Returns the voxels of the box around the active ones, placed relative to `origin`. Throws Error when the
/// box is empty, exceeds the limits or the library's range of coordinates, or when the transform is not
/// affine.
DensityGrid denseGrid(const openvdb::FloatGrid& grid, const GridLimits& limits, const glm::dvec3& origin);

}  // namespace limn::scene
