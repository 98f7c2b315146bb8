#include "core/relief/height_field.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/error.h"

namespace limn::relief {
namespace {

TEST(HeightFieldTest, IsBilinearBetweenTexelCentresAndRepeats) {
  const HeightField field({2, 2}, {0, 1, 2, 5}, {4, 6}, 2, 1);
  EXPECT_EQ(field.spacing(), glm::dvec2(2, 3));
  EXPECT_DOUBLE_EQ(field.height({0.5, 0.25}), 1 + 2 * (0.75 * 0.5 + 0.25 * 3.5));
  EXPECT_DOUBLE_EQ(field.height({-0.5, 2.25}), field.height({1.5, 0.25}));
  EXPECT_DOUBLE_EQ(field.lowest(), 1);
  EXPECT_DOUBLE_EQ(field.highest(), 11);
}

TEST(HeightFieldTest, IsLevelBeyondClampedEdges) {
  const HeightField field({2, 2}, {0, 1, 2, 5}, {1, 1}, 1, 0, Wrap::clamped);
  EXPECT_DOUBLE_EQ(field.height({-3, -7}), 0);
  EXPECT_DOUBLE_EQ(field.height({9, 0.5}), 3);
}

TEST(HeightFieldTest, NormalsAreThoseOfAPlane) {
  // z = 0.5 x - 0.25 y, with texels of 2 m x 1 m; edges have other neighbours.
  std::vector<float> values;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x)
      values.push_back(0.5f * 2 * static_cast<float>(x) - 0.25f * static_cast<float>(y));
  const HeightField field({3, 3}, values, {6, 3}, 1, 0, Wrap::clamped);
  const glm::dvec3 expected = glm::normalize(glm::dvec3(-0.5, 0.25, 1));
  EXPECT_LT(glm::distance(field.normal({1, 1}), expected), 1e-12);
  EXPECT_NEAR(field.steepest(), std::hypot(0.5, 0.25), 1e-12);
}

TEST(HeightFieldTest, RefusesWhatIsNoField) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinite = std::numeric_limits<float>::infinity();
  EXPECT_THROW(HeightField({0, 1}, {}, {1, 1}), Error);
  EXPECT_THROW(HeightField({2, 1}, {1}, {1, 1}), Error);
  EXPECT_THROW(HeightField({1, 1}, {nan}, {1, 1}), Error);
  EXPECT_THROW(HeightField({1, 1}, {infinite}, {1, 1}), Error);
  EXPECT_THROW(HeightField({1, 1}, {1}, {0, 1}), Error);
  EXPECT_THROW(HeightField({1, 1}, {1}, {1, -1}), Error);
  EXPECT_THROW(HeightField({1, 1}, {1}, {1, 1}, static_cast<double>(nan)), Error);
  EXPECT_THROW(HeightField({1, 1}, {3e38f}, {1, 1}, 1e4), Error);
}

}  // namespace
}  // namespace limn::relief
