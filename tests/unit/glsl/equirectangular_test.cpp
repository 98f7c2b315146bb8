#include "glsl/numeric/equirectangular.glsl"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace limn {
namespace {

void expectNear(glm::vec2 actual, glm::vec2 expected, float tolerance = 1e-6f) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
}

TEST(Equirectangular, PutsTheAxesWhereTheyBelong) {
  expectNear(glsl::equirectangular_uv({0, 0, -1}), {0.5f, 0.5f});
  expectNear(glsl::equirectangular_uv({1, 0, 0}), {0.75f, 0.5f});
  expectNear(glsl::equirectangular_uv({-1, 0, 0}), {0.25f, 0.5f});
  expectNear(glsl::equirectangular_uv({0, 1, 0}), {0.5f, 0.0f});
  expectNear(glsl::equirectangular_uv({0, -1, 0}), {0.5f, 1.0f});
  const float seam = glsl::equirectangular_uv({0, 0, 1}).x;  // +z is the seam: either end of the map
  EXPECT_TRUE(seam == 0.0f || seam == 1.0f) << seam;
}

TEST(Equirectangular, InvertsDirections) {
  std::mt19937 generator(1);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 10000; ++i) {
    const glm::vec3 direction =
        glm::normalize(glm::vec3(normal(generator), normal(generator), normal(generator)));
    const glm::vec2 uv = glsl::equirectangular_uv(direction * 3.0f);
    ASSERT_TRUE(uv.x >= 0.0f && uv.x <= 1.0f && uv.y >= 0.0f && uv.y <= 1.0f);
    EXPECT_LT(glm::length(glsl::equirectangular_direction(uv) - direction), 1e-6f);
  }
}

TEST(Equirectangular, InvertsPixelCentres) {
  const int width = 64, height = 32;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::vec2 uv((static_cast<float>(x) + 0.5f) / width, (static_cast<float>(y) + 0.5f) / height);
      expectNear(glsl::equirectangular_uv(glsl::equirectangular_direction(uv)), uv, 2e-6f);
    }
  }
}

TEST(Equirectangular, KeepsItsPrecisionAtThePoles) {
  for (const float angle : {1e-6f, 1e-4f, 1e-2f}) {
    const glm::vec2 uv = glsl::equirectangular_uv({std::sin(angle), std::cos(angle), 0.0f});
    EXPECT_NEAR(uv.y * glsl::pi, angle, 1e-6f * angle);
    EXPECT_NEAR(uv.x, 0.75f, 1e-6f);
  }
}

TEST(Equirectangular, SolidAnglesCoverTheSphere) {
  const int width = 64, height = 32;
  double total = 0;
  for (int y = 0; y < height; ++y) total += width * glsl::equirectangular_pixel_solid_angle(y, width, height);
  EXPECT_NEAR(total, 4 * M_PI, 1e-5);
}

}  // namespace
}  // namespace limn
