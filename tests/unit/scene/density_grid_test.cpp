// Densities of media: lookups, integrals along rays, and the laws of procedural smoke.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/bench/private/stress_scene.h"
#include "glsl/scene/media.glsl"
#include "tests/support/density_grids.h"

namespace limn::scene {
namespace {

using glm::vec3;
using test::gridOf;

TEST(DensityGrid, IsLinearBetweenVoxelsAndNothingOutside) {
  const DensityGrid grid = gridOf({4, 2, 3}, {1, 0, -1}, {5, 2, 2}, [](vec3 p) { return p.x + 10 * p.y; });
  EXPECT_NEAR(densityAt(grid, {1.5f, 0.5f, 0}), 6.5, 1e-5);
  EXPECT_NEAR(densityAt(grid, {2.9f, 1.2f, 1}), 14.9, 1e-5);
  EXPECT_NEAR(densityAt(grid, {1.1f, 0.5f, 0}), 6.5, 1e-5) << "the outer half voxel";
  EXPECT_EQ(densityAt(grid, {0.99f, 1, 0}), 0);
  EXPECT_EQ(densityAt(grid, {2, 1, 2.01f}), 0);
}

TEST(DensityGrid, TheIntegralOfARampIsThatOfItsMiddle) {
  const DensityGrid grid = gridOf({16, 3, 3}, {0, 0, 0}, {8, 3, 3}, [](vec3 p) { return p.x; });
  // From the first voxel's centre to the last one's the density is x.
  const vec3 origin(-2, 1.4f, 1.3f);
  EXPECT_NEAR(densityLength(grid, origin, {1, 0, 0}, 2.25f, 9.75f), 0.5 * (7.75 * 7.75 - 0.25 * 0.25), 1e-5);
  EXPECT_NEAR(densityLength(grid, origin, {1, 0, 0}, 0, 3e38f), 32, 1e-5) << "the box from face to face";
  EXPECT_NEAR(densityLength(grid, {12, 1.4f, 1.3f}, {-1, 0, 0}, 0, 3e38f), 32, 1e-5) << "backwards";
  EXPECT_NEAR(densityLength(grid, {3, 1, -4}, {0, 0, 1}, 0, 100), 9, 1e-5) << "a slab of density 3";
  EXPECT_EQ(densityLength(grid, {3, 3.1f, -4}, {0, 0, 1}, 0, 100), 0);
  EXPECT_EQ(densityLength(grid, origin, {1, 0, 0}, 5, 5), 0);
  EXPECT_EQ(densityLength(grid, origin, {-1, 0, 0}, 0, 3e38f), 0);
}

TEST(DensityGrid, TheIntegralIsThatOfTheLookup) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  const DensityGrid grid = gridOf({7, 5, 6}, {-1, -1, -1}, {1, 0.5f, 1}, [&](vec3) { return unit(random); });
  for (int i = 0; i < 30; ++i) {
    const vec3 origin = 4.f * vec3(unit(random), unit(random), unit(random)) - 2.f;
    const vec3 target = 2.f * vec3(unit(random), unit(random), unit(random)) - 1.f;
    const vec3 direction = glm::normalize(target - origin);
    double sum = 0;
    constexpr int steps = 40000;
    for (int s = 0; s < steps; ++s)
      sum += double(densityAt(grid, origin + 6.f * (s + 0.5f) / steps * direction));
    EXPECT_NEAR(densityLength(grid, origin, direction, 0, 6), sum * 6 / steps, 5e-4) << i;
  }
}

TEST(DensityGrid, OneVoxelAndRaysAlongPlanesOfVoxels) {
  const DensityGrid one = gridOf({1, 1, 1}, vec3(0), vec3(2), [](vec3) { return 5.f; });
  EXPECT_NEAR(densityLength(one, {-1, 1, 1}, {1, 0, 0}, 0, 10), 10, 1e-6);
  const DensityGrid four = gridOf({4, 4, 4}, vec3(0), vec3(4), [](vec3 p) { return p.z; });
  EXPECT_NEAR(densityLength(four, {-1, 1.5f, 2.5f}, {1, 0, 0}, 0, 10), 10, 1e-5);
  EXPECT_NEAR(densityLength(four, {-1, -1, 2.5f}, vec3(1, 1, 0), 0, 10), 10, 1e-5)
      << "in lengths of the direction";
}

/// Where t has no more digits for single voxels: as far as it goes, and to an end.
TEST(DensityGrid, TheIntegralEndsHoweverFarTheBoxIs) {
  const DensityGrid grid = gridOf({512, 1, 1}, vec3(0), vec3(512, 1, 1), [](vec3) { return 3.f; });
  for (const int exponent : {50, 53, 54, 57}) {
    const float away = std::ldexp(1.f, exponent);
    const double step = std::max(std::ldexp(1.0, exponent - 52), 1.0);  // between two t there
    EXPECT_NEAR(densityLength(grid, {-away, 0.5f, 0.5f}, {1, 0, 0}, 0, 3e38f), 3 * 512, 6 * step) << exponent;
    EXPECT_NEAR(densityLength(grid, {away, 0.5f, 0.5f}, {-1, 0, 0}, 0, 3e38f), 3 * 512, 6 * step) << exponent;
  }
}

TEST(DensityGrid, TheUnitBoxIsMetWhereItIs) {
  const glm::vec2 through = glsl::unit_box_range({-1, 0.5f, 0.5f}, {2, 0, 0});
  EXPECT_FLOAT_EQ(through.x, 0.5f);
  EXPECT_FLOAT_EQ(through.y, 1);
  const glm::vec2 beside = glsl::unit_box_range({-1, 1.5f, 0.5f}, {2, 0, 0});
  EXPECT_GT(beside.x, beside.y);
  const glm::vec2 past = glsl::unit_box_range({-1, -1, 0.5f}, {1, 3, 0});
  EXPECT_GT(past.x, past.y);
}

TEST(DensityGrid, OneOfZerosIsNoMedium) {
  Medium medium{.sigmaA = vec3(1), .sigmaS = vec3(2), .grid = {}, .smoke = {}};
  setGrid(medium, gridOf({2, 2, 2}, vec3(0), vec3(1), [](vec3) { return 0.f; }));
  EXPECT_FALSE(medium.present());
  EXPECT_FALSE(medium.inhomogeneous());
}

Smoke usualSmoke() {
  return {.low = {-1, 0, -1}, .high = {1, 3, 1}, .whirl = 0.6f, .rise = 0.2f, .seed = 4, .resolution = 48};
}

TEST(Smoke, IsBetweenNothingAndOneAndFadesAtItsBox) {
  const Smoke smoke = usualSmoke();
  EXPECT_EQ(smokeVoxels(smoke), glm::ivec3(32, 48, 32));
  const DensityGrid grid = smokeAt(smoke, 1.5);
  double sum = 0;
  float largest = 0, onFaces = 0;
  for (size_t i = 0; i < grid.values.size(); ++i) {
    ASSERT_GE(grid.values[i], 0);
    ASSERT_LE(grid.values[i], 1);
    sum += double(grid.values[i]);
    largest = std::max(largest, grid.values[i]);
    const size_t x = i % 32;
    if (x == 0 || x == 31) onFaces = std::max(onFaces, grid.values[i]);
  }
  const double mean = sum / double(grid.values.size());
  EXPECT_GT(mean, 0.05);
  EXPECT_LT(mean, 0.4);
  EXPECT_GT(largest, 0.8f) << "dense somewhere";
  EXPECT_LT(onFaces, 0.02f);
}

double difference(const DensityGrid& a, const DensityGrid& b) {
  double sum = 0;
  for (size_t i = 0; i < a.values.size(); ++i) sum += double(std::abs(a.values[i] - b.values[i]));
  return sum / double(a.values.size());
}

TEST(Smoke, FollowsFromTimeAloneAndMovesSmoothly) {
  const Smoke smoke = usualSmoke();
  const DensityGrid first = smokeAt(smoke, 2);
  EXPECT_EQ(first.values, smokeAt(smoke, 2).values);
  const double soon = difference(first, smokeAt(smoke, 2.01)), later = difference(first, smokeAt(smoke, 2.1));
  EXPECT_GT(soon, 0);
  EXPECT_NEAR(later / soon, 10, 2) << "no jumps";
  EXPECT_GT(difference(first, smokeAt(smoke, 60)), 0.05);
  Smoke other = smoke;
  other.seed = 5;
  EXPECT_GT(difference(first, smokeAt(other, 2)), 0.03);
  EXPECT_LT(difference(smokeAt(smoke, 1e5), smokeAt(smoke, 1e5 + 0.01)), 0.02) << "after a day, too";
}

/// Of a scene whose geometry comes later there are no bounds, and of a single point they have no sides.
TEST(Smoke, HasVoxelsWhereTheSceneHasNoSize) {
  const vec3 point(2, 0, -3);
  for (const Bounds& bounds : {Bounds{}, Bounds{point, point}}) {
    const Smoke smoke = smokeIn(bounds);
    const vec3 extent = smoke.high - smoke.low;
    EXPECT_TRUE(glm::all(glm::greaterThan(extent, vec3(0.9f))) &&
                glm::all(glm::lessThan(extent, vec3(1.1f))));
    EXPECT_TRUE(smoke.whirl > 0.1f && smoke.rise > 0.01f);
    EXPECT_TRUE(glm::all(glm::greaterThan(smokeVoxels(smoke), glm::ivec3(smoke.resolution / 2))));
    const std::vector<float> values = smokeAt(smoke, 1).values;
    EXPECT_TRUE(std::ranges::any_of(values, [](float v) { return v > 0.1f; }));
  }
}

TEST(Smoke, ScalesWithItsScene) {
  Scene scene;
  scene.medium.sigmaS = vec3(1);
  scene.medium.smoke = usualSmoke();
  const DensityGrid usual = smokeAt(*scene.medium.smoke, 1);
  const Scene scaled = bench::stressed(scene, StressChange::sceneScale, 1024.);
  EXPECT_EQ(smokeAt(*scaled.medium.smoke, 1).values, usual.values);
  EXPECT_NEAR(
      densityLength(usual, vec3(-2, 1, 0.1f), {1, 0, 0}, 0, 9) * 1024,
      densityLength(smokeAt(*scaled.medium.smoke, 1), 1024.f * vec3(-2, 1, 0.1f), {1, 0, 0}, 0, 9 * 1024),
      1e-2);
}

}  // namespace
}  // namespace limn::scene
