// The one place that sees OpenVDB's headers.
#include "core/scene_io/readers/vdb_grid.h"

#include <fmt/format.h>
#include <openvdb/tools/Dense.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/error.h"

namespace limn::scene {
namespace {

using openvdb::CoordBBox;
using openvdb::FloatGrid;

/// The library adds up to a node's size to coordinates, in 32 bits.
constexpr int kFarthestVoxel = 1 << 30;

void checkBox(const CoordBBox& box, const GridLimits& limits) {
  std::array<int64_t, 3> dim{};
  for (int axis = 0; axis < 3; ++axis) dim[axis] = int64_t{box.max()[axis]} - box.min()[axis] + 1;
  if (*std::ranges::min_element(dim) < 1)
    throw Error("its grid has no voxel that is set; one at least is needed");
  for (int axis = 0; axis < 3; ++axis)
    if (box.min()[axis] < -kFarthestVoxel || box.max()[axis] > kFarthestVoxel)
      throw Error(fmt::format("its grid has voxels at {} to {} along an axis; -2^30 to 2^30 is accepted",
                              box.min()[axis], box.max()[axis]));
  const auto refuse = [&](const std::string& accepted) {
    throw Error(fmt::format("its grid spans {} x {} x {} voxels; {}", dim[0], dim[1], dim[2], accepted));
  };
  if (*std::ranges::max_element(dim) > limits.side)
    refuse(fmt::format("at most {} a side are accepted", limits.side));
  if (static_cast<uint64_t>(dim[0] * dim[1] * dim[2]) > limits.voxels)
    refuse(fmt::format("at most {} together are accepted", limits.voxels));
}

/// Voxels fill half their size around their centres.
glm::mat4 toBox(const FloatGrid& grid, const CoordBBox& box, const glm::dvec3& origin) {
  const openvdb::Mat4R toIndex = grid.transform().baseMap()->getAffineMap()->getMat4().inverse();
  const openvdb::Coord dim = box.dim();
  glm::mat4 result(1);
  for (int column = 0; column < 4; ++column)
    for (int axis = 0; axis < 3; ++axis) {
      // OpenVDB multiplies row vectors from the left.
      double offset = column == 3 ? 0.5 - box.min()[axis] : 0;
      for (int from = 0; column == 3 && from < 3; ++from) offset += toIndex[from][axis] * origin[from];
      const double value = (toIndex[column][axis] + offset) / dim[axis];
      if (!(std::abs(value) <= 1e30)) throw Error("its grid has a transform that cannot be inverted");
      result[column][axis] = static_cast<float>(value);
    }
  return result;
}

/// By the name that is unique in the file, which has a suffix where grids share one.
std::string chooseGrid(openvdb::io::File& file, const GridLimits& limits) {
  std::optional<std::string> chosen;
  CoordBBox box;
  for (auto name = file.beginName(); name != file.endName(); ++name) {
    const openvdb::GridBase::Ptr grid = file.readGridMetadata(*name);
    const bool wanted = grid->getName() == "density";
    if (!grid->isType<FloatGrid>() || (chosen && !wanted)) continue;
    chosen = *name;
    // What the file says of itself comes first: it costs nothing.
    const auto low = grid->getMetadata<openvdb::Vec3IMetadata>(openvdb::GridBase::META_FILE_BBOX_MIN);
    const auto high = grid->getMetadata<openvdb::Vec3IMetadata>(openvdb::GridBase::META_FILE_BBOX_MAX);
    box = low && high ? CoordBBox(openvdb::Coord(low->value()), openvdb::Coord(high->value()))
                      : CoordBBox(openvdb::Coord(0), openvdb::Coord(0));
    if (wanted) break;
  }
  if (!chosen) throw Error("no grid of floats; one named 'density' is accepted");
  checkBox(box, limits);
  return *chosen;
}

}  // namespace

DensityGrid denseGrid(const FloatGrid& grid, const GridLimits& limits, const glm::dvec3& origin) {
  const CoordBBox box = grid.evalActiveVoxelBoundingBox();
  checkBox(box, limits);
  if (!grid.transform().isLinear())
    throw Error("its grid has a perspective transform; an affine one is accepted");
  DensityGrid result;
  const openvdb::Coord dim = box.dim();
  result.size = {dim[0], dim[1], dim[2]};
  result.worldToBox = toBox(grid, box, origin);
  result.values.resize(box.volume());
  openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, result.values.data());
  openvdb::tools::copyToDense(grid, dense);
  return result;
}

DensityGrid readVdbGrid(const std::filesystem::path& file, const GridLimits& limits,
                        const glm::dvec3& origin) {
  openvdb::initialize();
  openvdb::io::File vdb(file.string());
  vdb.open(/*delayLoad=*/false);
  const std::string chosen = chooseGrid(vdb, limits);
  return denseGrid(*openvdb::gridPtrCast<FloatGrid>(vdb.readGrid(chosen)), limits, origin);
}

}  // namespace limn::scene
