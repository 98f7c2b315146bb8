// OpenVDB files: the one place that sees the library's headers.
#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <new>
#include <system_error>

#include "core/base/error.h"
#include "core/scene/density_grid.h"

namespace limn::scene {
namespace {

using openvdb::CoordBBox;
using openvdb::FloatGrid;

class Reader {
 public:
  Reader(const std::filesystem::path& file, const GridLimits& limits, const glm::dvec3& origin)
      : file_(file), limits_(limits), origin_(origin) {}

  DensityGrid read() {
    std::error_code error;
    const auto bytes = std::filesystem::file_size(file_, error);
    if (error) fail(fmt::format("cannot be read: {}", error.message()));
    if (bytes > limits_.fileBytes)
      fail(fmt::format("{} bytes; at most {} are accepted", bytes, limits_.fileBytes));
    try {
      return convert(*load());
    } catch (const openvdb::Exception& exception) {
      fail(fmt::format("not an OpenVDB file that can be read ({})", exception.what()));
    } catch (const std::bad_alloc&) {
      fail("not an OpenVDB file that can be read (it asks for more memory than there is)");
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    std::string text = fmt::format("{}: {}", file_.string(), what);
    std::ranges::replace_if(
        text, [](char c) { return static_cast<unsigned char>(c) < 32; }, ' ');
    throw Error(text.substr(0, 600));
  }

  void checkBox(const CoordBBox& box) const {
    if (box.empty()) fail("its grid has no voxel that is set; one at least is needed");
    std::array<int64_t, 3> dim{};
    for (int axis = 0; axis < 3; ++axis) dim[axis] = int64_t{box.max()[axis]} - box.min()[axis] + 1;
    const auto refuse = [&](const std::string& accepted) {
      fail(fmt::format("its grid spans {} x {} x {} voxels; {}", dim[0], dim[1], dim[2], accepted));
    };
    if (*std::ranges::max_element(dim) > limits_.side)
      refuse(fmt::format("at most {} a side are accepted", limits_.side));
    if (static_cast<uint64_t>(dim[0] * dim[1] * dim[2]) > limits_.voxels)
      refuse(fmt::format("at most {} together are accepted", limits_.voxels));
  }

  FloatGrid::Ptr load() const {
    static std::once_flag initialised;
    std::call_once(initialised, [] { openvdb::initialize(); });
    openvdb::io::File file(file_.string());
    file.open(/*delayLoad=*/false);
    std::string chosen;
    const openvdb::GridPtrVecPtr grids = file.readAllGridMetadata();
    for (const openvdb::GridBase::Ptr& grid : *grids) {
      if (!grid->isType<FloatGrid>() || (!chosen.empty() && grid->getName() != "density")) continue;
      chosen = grid->getName();
      // What the file says of itself comes first: it costs nothing.
      const auto low = grid->getMetadata<openvdb::Vec3IMetadata>(openvdb::GridBase::META_FILE_BBOX_MIN);
      const auto high = grid->getMetadata<openvdb::Vec3IMetadata>(openvdb::GridBase::META_FILE_BBOX_MAX);
      if (low && high) checkBox(CoordBBox(openvdb::Coord(low->value()), openvdb::Coord(high->value())));
      if (chosen == "density") break;
    }
    if (chosen.empty()) fail("no grid of floats; one named 'density' is accepted");
    return openvdb::gridPtrCast<FloatGrid>(file.readGrid(chosen));
  }

  DensityGrid convert(const FloatGrid& grid) const {
    const CoordBBox box = grid.evalActiveVoxelBoundingBox();
    checkBox(box);
    if (!grid.transform().isLinear()) fail("its grid has a perspective transform; an affine one is accepted");
    DensityGrid result;
    const openvdb::Coord dim = box.dim();
    result.size = {dim[0], dim[1], dim[2]};
    openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box);
    openvdb::tools::copyToDense(grid, dense);
    result.values.assign(dense.data(), dense.data() + box.volume());
    for (const float v : result.values)
      if (!(v >= 0 && v <= 1e30f)) fail(fmt::format("a density of {}; 0 to 1e30 is accepted", v));
    result.worldToBox = toBox(grid, box);
    return result;
  }

  /// Voxels fill half their size around their centres.
  glm::mat4 toBox(const FloatGrid& grid, const CoordBBox& box) const {
    const openvdb::Mat4R toIndex = grid.transform().baseMap()->getAffineMap()->getMat4().inverse();
    const openvdb::Coord dim = box.dim();
    glm::mat4 result(1);
    for (int column = 0; column < 4; ++column)
      for (int axis = 0; axis < 3; ++axis) {
        // OpenVDB multiplies row vectors from the left.
        double offset = column == 3 ? 0.5 - box.min()[axis] : 0;
        for (int from = 0; column == 3 && from < 3; ++from) offset += toIndex[from][axis] * origin_[from];
        const double value = (toIndex[column][axis] + offset) / dim[axis];
        if (!(std::abs(value) <= 1e30)) fail("its grid has a transform that cannot be inverted");
        result[column][axis] = static_cast<float>(value);
      }
    return result;
  }

  const std::filesystem::path& file_;
  const GridLimits& limits_;
  const glm::dvec3 origin_;
};

}  // namespace

DensityGrid readDensityGrid(const std::filesystem::path& file, const GridLimits& limits,
                            const glm::dvec3& origin) {
  return Reader(file, limits, origin).read();
}

}  // namespace limn::scene
