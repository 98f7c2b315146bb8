// The scene in which the visibility of indirect light matters: how much of it the pillars hide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "core/scene_io/load.h"
#include "tests/support/paths.h"

namespace limn {
namespace {

class ColonnadeTest : public ::testing::Test {
 protected:
  ColonnadeTest() {
    for (const scene::DrawInstance& instance : pose_.instances) {
      const scene::Primitive& primitive = scene_.meshes[static_cast<std::size_t>(instance.mesh)]
                                              .primitives[static_cast<std::size_t>(instance.primitive)];
      for (const uint32_t index : primitive.indices)
        corners_.emplace_back(instance.objectToWorld * glm::vec4(primitive.positions[index], 1));
    }
  }

  /// Whether a triangle lies between the two points, a thousandth of the way at either end left out.
  bool hidden(glm::vec3 from, glm::vec3 to) const {
    for (std::size_t i = 0; i + 2 < corners_.size(); i += 3) {
      const glm::vec3 way = to - from, first = corners_[i + 1] - corners_[i],
                      second = corners_[i + 2] - corners_[i], offset = from - corners_[i];
      const glm::vec3 p = glm::cross(way, second), q = glm::cross(offset, first);
      const float scale = glm::dot(first, p);
      if (scale == 0) continue;
      const float u = glm::dot(offset, p) / scale, v = glm::dot(way, q) / scale;
      const float t = glm::dot(second, q) / scale;
      if (u >= -1e-5f && v >= -1e-5f && u + v <= 1 + 1e-5f && t > 1e-3f && t < 1 - 1e-3f) return true;
    }
    return false;
  }

  scene::Scene scene_ =
      scene::load(std::filesystem::path(test::kBinaryDir) / "assets" / "colonnade" / "colonnade.glb");
  scene::Pose pose_ = scene::evaluate(scene_, 0);
  std::vector<glm::vec3> corners_;  ///< of all triangles, in the world
};

TEST_F(ColonnadeTest, TheRoomIsClosed) {
  for (const scene::CameraPose& camera : pose_.cameras) {
    const glm::vec3 eye(glm::inverse(camera.worldToView)[3]);
    constexpr int kDirections = 500;
    for (int i = 0; i < kDirections; ++i) {  // a spiral from pole to pole
      const float z = 1 - (2 * static_cast<float>(i) + 1) / kDirections, r = std::sqrt(1 - z * z);
      const float turn = glm::golden_ratio<float>() * 2 * glm::pi<float>() * static_cast<float>(i);
      EXPECT_TRUE(hidden(eye, eye + 10.f * glm::vec3(r * std::cos(turn), z, r * std::sin(turn)))) << i;
    }
  }
}

/// Lit points of the hall's wall: a grid over the disc that the inner cone lights.
std::vector<glm::vec3> patch() {
  std::vector<glm::vec3> points;
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j)
      if (i * i + j * j <= 16)
        points.emplace_back(0.1f + 0.12f * static_cast<float>(i), 0.9f + 0.12f * static_cast<float>(j),
                            -1.2f);
  return points;
}

TEST_F(ColonnadeTest, NothingHidesTheHallsWallFromTheLight) {
  ASSERT_EQ(pose_.lights.size(), 1u);
  for (const glm::vec3& point : patch()) EXPECT_FALSE(hidden(pose_.lights[0].position, point));
}

// The same points against the boxes as the scene declares them, by slabs instead of triangles, have 0.504 of
// the segments hidden, between 0.04 and 0.98 from one of them: shadows, not a shade that is everywhere the
// same.
TEST_F(ColonnadeTest, ThePillarsHideHalfOfThePatchFromTheAislesWall) {
  constexpr int kColumns = 32, kRows = 8;
  const std::vector<glm::vec3> lit = patch();
  const auto all = static_cast<double>(lit.size());
  double sum = 0, least = 1, most = 0;
  for (int i = 0; i < kColumns; ++i)
    for (int j = 0; j < kRows; ++j) {
      const glm::vec3 point(-1.7f + 3.4f * (static_cast<float>(i) + 0.5f) / kColumns,
                            0.1f + 1.6f * (static_cast<float>(j) + 0.5f) / kRows, 0.9f - 1e-4f);
      const auto count = static_cast<double>(
          std::ranges::count_if(lit, [&](const glm::vec3& from) { return hidden(from, point); }));
      sum += count / all;
      least = std::min(least, count / all);
      most = std::max(most, count / all);
    }
  EXPECT_NEAR(sum / (kColumns * kRows), 0.504, 0.01);
  EXPECT_LT(least, 0.1);
  EXPECT_GT(most, 0.9);
}

}  // namespace
}  // namespace limn
