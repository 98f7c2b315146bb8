// OpenVDB files for tests.
#pragma once

#include <openvdb/openvdb.h>

#include "core/scene_io/density_grid_file.h"
#include "tests/support/scene_files.h"

namespace limn::test {

class VdbFile : public SceneFiles {
 protected:
  std::filesystem::path file() const { return folder_ / "scene" / "cloud.vdb"; }

  using SceneFiles::write;
  /// `stats`: the file says of each grid which box its voxels span, as OpenVDB does unless told otherwise.
  void write(const openvdb::GridPtrVec& grids, bool stats = true) const {
    openvdb::io::File out(file().string());
    out.setGridStatsMetadataEnabled(stats);
    out.write(grids);
    out.close();
  }
  void write(const openvdb::GridBase::Ptr& grid) const { write(openvdb::GridPtrVec{grid}); }

  /// Density x + 10 y + 100 z at the voxels of a box.
  static openvdb::FloatGrid::Ptr ramp(openvdb::Coord low, openvdb::Coord high) {
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(0.f);
    grid->setName("density");
    auto accessor = grid->getAccessor();
    for (int x = low.x(); x <= high.x(); ++x)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int z = low.z(); z <= high.z(); ++z) accessor.setValue({x, y, z}, float(x + 10 * y + 100 * z));
    return grid;
  }

  /// A grid without voxels, of the type that OpenVDB calls so. The library makes it, since each type of tree
  /// that a test makes itself takes seconds to compile.
  static openvdb::GridBase::Ptr emptyGrid(const std::string& type) {
    openvdb::initialize();
    return openvdb::GridBase::createGrid(type);
  }

  std::string error(const scene::GridLimits& limits = {}) const {
    try {
      scene::readDensityGrid(file(), limits);
    } catch (const Error& thrown) {
      EXPECT_EQ(std::string(thrown.what()).find('\n'), std::string::npos);
      EXPECT_THAT(thrown.what(), testing::HasSubstr("cloud.vdb"));
      return thrown.what();
    }
    return {};
  }
};

}  // namespace limn::test
