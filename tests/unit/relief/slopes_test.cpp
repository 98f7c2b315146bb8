// Slopes of height maps as textures, and the normals that they give.
#include "core/relief/slopes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/texture_lookup.h"
#include "glsl/relief/height_normal.glsl"
#include "tests/unit/relief/fields.h"

namespace limn::relief::test {
namespace {

HeightField plane(int width, int height, const glm::dvec2& slope, Wrap wrap = Wrap::clamped) {
  std::vector<float> values;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      values.push_back(static_cast<float>(slope.x * x / width + slope.y * 2 * y / height));
  return {{width, height}, values, {1, 2}, 1, 0, wrap};  // 1 m along u, 2 m along v
}

glm::dvec2 meanOf(const SlopeLevel& level) {
  glm::dvec2 sum(0);
  for (const glm::vec2& slope : level.slopes) sum += glm::dvec2(slope);
  return sum / static_cast<double>(level.slopes.size());
}

TEST(ReliefSlopes, AreThoseOfAPlane) {
  const std::vector<SlopeLevel> levels = slopeLevels(plane(8, 16, {0.25, -0.5}));
  EXPECT_EQ(levels[0].size, glm::ivec2(8, 16));
  for (int y = 1; y < 15; ++y)
    for (int x = 1; x < 7; ++x) {
      const glm::vec2 slope = levels[0].slopes[static_cast<std::size_t>(8 * y + x)];
      EXPECT_NEAR(slope.x, 0.25, 1e-6);
      EXPECT_NEAR(slope.y, -0.5, 1e-6);
    }
  EXPECT_NEAR(levels[0].slopes[8].x, 0.125, 1e-6) << "beyond the edge a clamped field is level";
}

TEST(ReliefSlopes, AreThoseOfTheNormalAtEachTexel) {
  const HeightField field = bricks(32);
  const SlopeLevel level = slopeLevels(field)[0];
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const glm::vec2 slope = level.slopes[static_cast<std::size_t>(32 * y + x)];
      const glm::dvec3 normal = field.normal({x, y});
      EXPECT_NEAR(glm::length(glm::normalize(glm::dvec3(-slope.x, -slope.y, 1)) - normal), 0, 1e-6);
    }
}

TEST(ReliefSlopes, AverageLinearlyDownToOneTexel) {
  for (const glm::ivec2& size : {glm::ivec2(16, 16), glm::ivec2(13, 7), glm::ivec2(1, 9), glm::ivec2(1, 1)}) {
    const std::vector<SlopeLevel> levels = slopeLevels(plane(size.x, size.y, {0.7, 0.3}, Wrap::clamped));
    EXPECT_EQ(levels.back().size, glm::ivec2(1));
    for (const SlopeLevel& level : levels) {
      ASSERT_EQ(level.slopes.size(), static_cast<std::size_t>(level.size.x * level.size.y));
      EXPECT_NEAR(glm::distance(meanOf(level), meanOf(levels[0])), 0, 1e-6) << size.x << " x " << size.y;
    }
  }
  const std::vector<SlopeLevel> periodic = slopeLevels(noise(32));
  EXPECT_NEAR(glm::length(glm::dvec2(periodic.back().slopes[0])), 0, 1e-6)
      << "what a periodic field rises it falls";
}

TEST(ReliefSlopes, StayFiniteOnAnyStep) {
  const HeightField field({2, 1}, {0, 3e38f}, glm::dvec2(1e-30), 1, 0, Wrap::clamped);
  for (const SlopeLevel& level : slopeLevels(field))
    for (const glm::vec2& slope : level.slopes) {
      EXPECT_TRUE(std::isfinite(glm::dot(slope, slope)));
      const glm::vec3 normal = glsl::height_normal({0, 0, 1}, {1, 0, 0, -1}, slope);
      EXPECT_NEAR(glm::length(normal), 1, 1e-6);
    }
}

TEST(ReliefSlopes, AreLookedUpBetweenTexelsAndLevels) {
  const HeightField field = eggCrate(16);
  const std::vector<SlopeLevel> levels = slopeLevels(field);
  const auto texel = [&](int x, int y) { return levels[0].slopes[field.index({x, y})]; };
  const auto at = [&](double x, double y, float lod) {
    return scene::sampleSlopes(levels, scene::wrapOf(field), glm::vec2((x + 0.5) / 16, (y + 0.5) / 16), lod);
  };
  EXPECT_NEAR(glm::distance(at(3, 5, 0), texel(3, 5)), 0, 1e-5);
  EXPECT_NEAR(glm::distance(at(3.5, 5, -2), 0.5f * (texel(3, 5) + texel(4, 5))), 0, 1e-5);
  EXPECT_NEAR(glm::distance(at(15.5, 5, 0), 0.5f * (texel(15, 5) + texel(0, 5))), 0, 1e-5) << "periodic";
  EXPECT_NEAR(glm::distance(at(2.5, 4.5, 1), levels[1].slopes[2 * 8 + 1]), 0, 1e-5);
  EXPECT_NEAR(glm::length(at(2.5, 4.5, 32)), 0, 1e-5);
}

/// Rising u is the tangent; rising v is against the bitangent.
TEST(ReliefSlopes, TurnNormalsAwayFromTheirRise) {
  const glm::vec3 up(0, 0, 1);
  const glm::vec4 tangent(1, 0, 0, 1);
  const auto near = [](const glm::vec3& a, const glm::vec3& b) { EXPECT_NEAR(glm::distance(a, b), 0, 1e-6); };
  near(glsl::height_normal(up, tangent, {0, 0}), up);
  near(glsl::height_normal(up, tangent, {0.75f, 0}), {-0.6f, 0, 0.8f});
  near(glsl::height_normal(up, tangent, {0, 0.75f}), {0, 0.6f, 0.8f});
  near(glsl::height_normal(up, {1, 0, 0, -1}, {0, 0.75f}), {0, -0.6f, 0.8f});
  near(glsl::height_normal(up, {0, 0, 0, 1}, {1, 1}), up);
}

}  // namespace
}  // namespace limn::relief::test
