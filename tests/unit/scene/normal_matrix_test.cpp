// Normals of instances: against inverse transposes, and where there are none.
#include "core/scene/normal_matrix.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace limn::scene {
namespace {

/// Rounding of a float times the condition of these matrices, whose axes differ by less than a factor of 10.
constexpr float kRounding = 1e-5f;

glm::mat4 turnedAndScaled(const glm::vec3& scale) {
  return glm::scale(glm::rotate(glm::mat4(1), 0.7f, glm::vec3(1, 2, 3)), scale);
}

void expectDirection(const glm::vec3& product, const glm::vec3& direction) {
  ASSERT_GT(glm::length(product), 0.f);
  const glm::vec3 unit = glm::normalize(product);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(unit[c], direction[c], kRounding);
}

TEST(NormalMatrix, TurnsAsTheInverseTransposeDoes) {
  const glm::vec3 n = glm::normalize(glm::vec3(1, -2, 0.5f));
  for (const glm::vec3& scale : {glm::vec3(1), glm::vec3(1, 3, 0.5f), glm::vec3(-1, 2, 3), glm::vec3(-2)}) {
    const glm::mat4 matrix = turnedAndScaled(scale);
    const glm::dmat3 exact = glm::inverse(glm::transpose(glm::dmat3(glm::dmat4(matrix))));
    expectDirection(normalMatrix(matrix) * n, glm::vec3(glm::normalize(exact * glm::dvec3(n))));
  }
}

TEST(NormalMatrix, NoScaleIsTooSmallOrTooLarge) {
  const glm::vec3 n = glm::normalize(glm::vec3(1, -2, 0.5f));
  const glm::vec3 expected = glm::normalize(normalMatrix(turnedAndScaled({1, 3, 0.5f})) * n);
  for (const float size : {1e-30f, 1e-12f, 1e12f, 1e30f})
    expectDirection(normalMatrix(turnedAndScaled(size * glm::vec3(1, 3, 0.5f))) * n, expected);
}

/// What is pressed into a plane shows it; a line or a point shows nothing.
TEST(NormalMatrix, FlatInstancesHaveTheNormalOfTheirPlane) {
  const glm::mat4 flat = turnedAndScaled({2, 3, 0});
  const glm::vec3 plane = glm::normalize(glm::cross(glm::vec3(flat[0]), glm::vec3(flat[1])));
  expectDirection(normalMatrix(flat) * glm::vec3(0.6f, 0, 0.8f), plane);
  for (const glm::mat4& none : {turnedAndScaled({2, 0, 0}), turnedAndScaled(glm::vec3(0))})
    EXPECT_EQ(normalMatrix(none) * glm::vec3(0.6f, 0, 0.8f), glm::vec3(0));
}

TEST(NormalMatrix, MirroringIsTheSignOfTheDeterminant) {
  EXPECT_FALSE(mirrors(turnedAndScaled({1, 2, 3})));
  EXPECT_TRUE(mirrors(turnedAndScaled({1, -2, 3})));
  EXPECT_FALSE(mirrors(turnedAndScaled({-1, -2, 3})));
  EXPECT_TRUE(mirrors(turnedAndScaled(glm::vec3(-1e-20f)))) << "too small for the product of three floats";
  EXPECT_FALSE(mirrors(turnedAndScaled({1, 2, 0}))) << "flat";
}

}  // namespace
}  // namespace limn::scene
