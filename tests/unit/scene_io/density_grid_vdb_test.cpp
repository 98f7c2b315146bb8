// Grids from OpenVDB files, good and bad ones.
#include <fstream>

#include "tests/support/vdb_file.h"

namespace limn::test {
namespace {

using scene::DensityGrid;
using scene::readDensityGrid;
using testing::AllOf;
using testing::HasSubstr;

TEST_F(VdbFile, HoldsDensitiesInItsPlace) {
  const auto grid = ramp({1, 2, 3}, {4, 6, 5});
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  grid->transform().postTranslate({10, 0, 0});
  write(grid);
  const DensityGrid read = readDensityGrid(file());
  EXPECT_EQ(read.size, glm::ivec3(4, 5, 3));
  // Voxel (i, j, k) has its centre at half these coordinates, 10 m further along x.
  EXPECT_NEAR(densityAt(read, {10 + 0.5f * 2, 0.5f * 3, 0.5f * 4}), 2 + 30 + 400, 1e-2);
  EXPECT_NEAR(densityAt(read, {10 + 0.5f * 3.5f, 0.5f * 5.25f, 0.5f * 3.5f}), 3.5 + 52.5 + 350, 1e-2);
  EXPECT_EQ(densityAt(read, {10, 1, 2}), 0);
}

/// The same densities around an origin that the scene has far away.
TEST_F(VdbFile, FarAwayIsTheSameGrid) {
  const auto place = [&](const glm::dvec3& shift) {
    const auto grid = ramp({1, 2, 3}, {4, 6, 5});
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    grid->transform().postTranslate({10 + shift.x, shift.y, shift.z});
    write(grid);
    return readDensityGrid(file(), {}, shift);
  };
  const DensityGrid near = place(glm::dvec3(0));
  for (const double x : {1e5, 1e7}) {
    const DensityGrid far = place({x, 2 * x, -x});
    EXPECT_EQ(far.size, near.size);
    EXPECT_EQ(far.values, near.values);
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row)
        EXPECT_NEAR(far.worldToBox[column][row], near.worldToBox[column][row], 1e-6) << x;
  }
}

TEST_F(VdbFile, IsTheMediumOfASceneBesideIt) {
  write(ramp({0, 0, 0}, {2, 2, 2}));
  GltfBuilder b;
  b.append("scenes", {{"extras", {{"limn_medium", {{"sigma_s", 0.5}, {"grid", "cloud.vdb"}}}}}});
  const scene::Scene scene = scene::load(SceneFiles::write("scene/a.glb", b.glb()));
  ASSERT_TRUE(scene.medium.inhomogeneous());
  EXPECT_EQ(scene.medium.grid->size, glm::ivec3(3));
  b.root["scenes"][0]["extras"]["limn_medium"]["grid"] = "../cloud.vdb";
  EXPECT_THAT(loadError(SceneFiles::write("scene/b.glb", b.glb())), HasSubstr("outside the scene's folder"));
  b.root["scenes"][0]["extras"]["limn_medium"]["grid"] = "no.vdb";
  EXPECT_THAT(loadError(SceneFiles::write("scene/b.glb", b.glb())),
              AllOf(HasSubstr("b.glb"), HasSubstr("no.vdb")));
  EXPECT_THAT(loadError(b.glb()), HasSubstr("a scene in memory can name none"));
}

/// As smoke does: the coefficients of a file, which --sigma-a and --sigma-s override, may be 0.
TEST_F(VdbFile, WaitsForCoefficients) {
  write(ramp({0, 0, 0}, {2, 2, 2}));
  GltfBuilder b;
  b.append("scenes", {{"extras", {{"limn_medium", {{"grid", "cloud.vdb"}}}}}});
  scene::Scene scene = scene::load(SceneFiles::write("scene/a.glb", b.glb()));
  EXPECT_FALSE(scene.medium.inhomogeneous());
  EXPECT_THAT(scene.warnings, testing::IsEmpty());
  scene.medium.sigmaS = glm::vec3(1);
  EXPECT_TRUE(scene.medium.inhomogeneous());
}

TEST_F(VdbFile, OfZerosIsNoMedium) {
  const auto grid = ramp({0, 0, 0}, {2, 2, 2});
  for (auto voxel = grid->beginValueOn(); voxel; ++voxel) voxel.setValue(0);
  write(grid);
  GltfBuilder b;
  b.append("scenes", {{"extras", {{"limn_medium", {{"sigma_s", 0.5}, {"grid", "cloud.vdb"}}}}}});
  const scene::Scene scene = scene::load(SceneFiles::write("scene/a.glb", b.glb()));
  EXPECT_FALSE(scene.medium.present());
  EXPECT_THAT(scene.warnings, testing::ElementsAre(HasSubstr("there is no medium")));
}

TEST_F(VdbFile, IsRefusedWithWhatWouldBeAccepted) {
  EXPECT_THAT(error(), HasSubstr("cannot be read"));
  write(ramp({0, 0, 0}, {9, 2, 2}));
  EXPECT_THAT(error({.side = 8}), AllOf(HasSubstr("10 x 3 x 3 voxels"), HasSubstr("at most 8 a side")));
  EXPECT_THAT(error({.voxels = 50}), HasSubstr("at most 50 together"));
  EXPECT_THAT(error({.fileBytes = 10}), HasSubstr("at most 10 are accepted"));
  const auto sparse = ramp({0, 0, 0}, {1, 1, 1});
  sparse->getAccessor().setValue({1 << 30, 0, 0}, 1);
  write(sparse);
  EXPECT_THAT(error(), HasSubstr("at most 2048 a side"));
  const auto negative = ramp({0, 0, 0}, {1, 1, 1});
  negative->getAccessor().setValue({0, 0, 0}, -1);
  write(negative);
  EXPECT_THAT(error(), HasSubstr("a density of -1"));
  const auto broken = ramp({0, 0, 0}, {1, 1, 1});
  broken->getAccessor().setValue({0, 0, 0}, NAN);
  write(broken);
  EXPECT_THAT(error(), HasSubstr("a density of nan"));
  write(openvdb::FloatGrid::create(0.f));
  EXPECT_THAT(error(), HasSubstr("no voxel that is set"));
  write(emptyGrid("Tree_vec3s_5_4_3"));
  EXPECT_THAT(error(), HasSubstr("no grid of floats"));
}

TEST_F(VdbFile, ThatIsDamagedIsAnError) {
  write(ramp({0, 0, 0}, {9, 9, 9}));
  const auto size = std::filesystem::file_size(file());
  std::filesystem::resize_file(file(), size / 2);
  EXPECT_THAT(error(), HasSubstr("not an OpenVDB file that can be read"));
  std::ofstream(file(), std::ios::binary) << "this is no volume";
  EXPECT_THAT(error(), HasSubstr("not an OpenVDB file that can be read"));
}

}  // namespace
}  // namespace limn::test
