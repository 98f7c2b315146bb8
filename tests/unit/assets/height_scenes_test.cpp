// The scenes of height maps as written to disk: 16 bits, slopes as promised, textures that repeat.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/scene_io/load.h"
#include "tests/support/glb.h"

namespace limn::test {
namespace {

relief::HeightField heightsOf(const std::string& name) {
  const scene::Scene scene = scene::load(kAssets / name / (name + ".glb"));
  EXPECT_EQ(scene.heights.size(), 1u) << name;
  return scene.heights.at(0);
}

double rmsSlope(const relief::HeightField& field) {
  double sum = 0;
  for (int y = 0; y < field.size().y; ++y)
    for (int x = 0; x < field.size().x; ++x) {
      const glm::dvec2 slope = field.slope({x, y});
      sum += glm::dot(slope, slope);
    }
  return std::sqrt(sum / static_cast<double>(field.texels()));
}

TEST(HeightScenes, HaveTheSlopesTheyPromise) {
  EXPECT_NEAR(rmsSlope(heightsOf("bump_wall")), 0.76, 0.01);
  EXPECT_NEAR(rmsSlope(heightsOf("bump_sphere")), 0.26, 0.01);
  EXPECT_NEAR(rmsSlope(heightsOf("egg_crate")), 0.47, 0.01);
}

/// Steps of 16 bits over 32 texels of a wall.
TEST(HeightScenes, TheGrooveHasARightAngle) {
  const relief::HeightField field = heightsOf("groove");
  ASSERT_EQ(field.size(), glm::ivec2(64, 1));
  EXPECT_EQ(field.wrap(), relief::Wrap::periodic);
  for (int x = 0; x < 64; ++x) {
    const double slope = (field.texel({x + 1, 0}) - field.texel({x, 0})) / field.spacing().x;
    EXPECT_NEAR(slope, x < 32 ? -1 : 1, 32.0 / 65535) << x;
  }
}

}  // namespace
}  // namespace limn::test
