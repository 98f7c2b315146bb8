#include "core/relief/interreflection.h"

#include <gtest/gtest.h>

#include <utility>

#include "core/base/error.h"
#include "core/relief/horizon.h"
#include "tests/support/relief_bounces.h"
#include "tests/unit/relief/fields.h"

namespace limn::relief {
namespace {

using namespace test;

glm::dvec3 lightAt35Degrees() {
  const double elevation = 35 * std::numbers::pi / 180;
  return {std::cos(elevation) * std::cos(0.5), std::cos(elevation) * std::sin(0.5), std::sin(elevation)};
}

double meanOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

struct Loss {
  double rms;   ///< of the error, over that of the bounce
  double mean;  ///< of the estimate, over that of the bounce
};

Loss lossOf(const std::vector<double>& estimate, const std::vector<double>& exact) {
  double error = 0, power = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    error += (estimate[i] - exact[i]) * (estimate[i] - exact[i]);
    power += exact[i] * exact[i];
  }
  return {.rms = std::sqrt(error / power), .mean = meanOf(estimate) / meanOf(exact)};
}

TEST(ReliefRayTest, IsBlockedBelowTheExactHorizon) {
  const HeightField field = bricks(32, 1.2);
  for (int i = 0; i < 2000; ++i) {
    const glm::ivec2 texel((7 * i) % 32, (11 * i) % 32);
    const double azimuth = 0.37 * i, tangent = exactHorizon(field, texel, azimuth);
    const auto towards = [&](double slope) {
      return glm::normalize(glm::dvec3(std::cos(azimuth), std::sin(azimuth), slope));
    };
    EXPECT_FALSE(traceRay(field, texel, towards(tangent + 1e-5)));
    if (tangent > 1e-4) {
      EXPECT_TRUE(traceRay(field, texel, towards(tangent - 1e-5)));
    }
  }
}

TEST(ReliefRayTest, EndsOnTheField) {
  const HeightField field = eggCrate(24, 0.9);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec2 start(std::fmod(0.713 * i, 24.0), std::fmod(1.391 * i, 24.0));
    const glm::dvec3 direction = glm::normalize(glm::dvec3(std::cos(0.7 * i), std::sin(0.7 * i), -0.6));
    const auto place = traceRay(field, start, direction);
    ASSERT_TRUE(place);
    // Up to whole tiles, the ray's height over the place is the field's.
    const glm::dvec2 along = glm::dvec2(direction) / field.spacing();
    double nearest = 1;
    for (int x = -3; x <= 3; ++x)
      for (int y = -3; y <= 3; ++y) {
        const glm::dvec2 way = *place + 24.0 * glm::dvec2(x, y) - start;
        const double s = glm::dot(way, along) / glm::dot(along, along);
        const double off = glm::length(way - s * along);
        nearest =
            std::min(nearest, off + std::abs(field.height(start) + s * direction.z - field.height(*place)));
      }
    EXPECT_LT(nearest, 1e-9);
  }
}

TEST(ReliefRayTest, LeavesAFlatFieldUpwardsAlone) {
  const HeightField flat({1, 1}, {2}, {1, 1});
  EXPECT_FALSE(traceRay(flat, {0, 0}, {0, 0, 1}));
  EXPECT_FALSE(traceRay(flat, {0.3, 0.1}, {1, 0, 0}));
  EXPECT_FALSE(traceRay(flat, {0, 0}, {0.6, 0, 0.8}));
  EXPECT_TRUE(traceRay(flat, {0, 0}, {0, 0, -1}));
  EXPECT_TRUE(traceRay(flat, {0, 0}, {0.8, 0, -0.6}));
}

TEST(ReliefBounceTest, WallsOfAGrooveSeeEachOther) {
  // Opening angle 2 h: the walls' form factor is 1 - sin h; that of a strip at a texel is (1 - cos a) / 2,
  // where a is the angle between its own wall and the other crest.
  constexpr int kSize = 64, kPaths = 1024;
  const double slope = 1.3, half = std::atan(1 / slope);
  const HeightField field = groove(kSize, slope);
  const BouncePaths paths = traceBounces(field, BounceDirections::ownFrame, kPaths);
  double sum = 0;
  for (int x = 1; x < kSize / 2; ++x) {
    double seen = 0;
    for (int i = 0; i < kPaths; ++i) {
      const BouncePath& path = paths.list[static_cast<std::size_t>(x * kPaths + i)];
      if (path.hits()) seen += static_cast<double>(path.weight) / std::numbers::pi;
    }
    const glm::dvec2 crest(1.0 - x / static_cast<double>(kSize), slope * x / kSize),
        down = glm::normalize(glm::dvec2(1, -slope));
    EXPECT_NEAR(seen, (1 - glm::dot(glm::normalize(crest), down)) / 2, 0.01) << x;
    sum += seen;
  }
  // At the crest a wall sees nothing of the other one; at the bottom the limit of the strip.
  const double bottom = (1 - std::cos(std::numbers::pi - 2 * half)) / 2;
  EXPECT_NEAR((sum + 0.5 * bottom) / (kSize / 2), 1 - std::sin(half), 0.005);
}

TEST(ReliefBounceTest, FurnaceIsOne) {
  for (const HeightField& field : {eggCrate(64, 0.94), bricks(64, 1.52)}) {
    const BouncePaths paths = traceBounces(field, BounceDirections::ownFrame, 64);
    const std::vector<double> dark(field.texels(), 0.0);
    double last = 0;
    for (const int bounces : {1, 2, 4, 8, 12}) {
      const double mean = meanOf(bounce(field, paths, dark, 1, 1, bounces));
      EXPECT_GT(mean, last);
      last = mean;
    }
    EXPECT_NEAR(last, 1, 1e-3);
  }
}

/// Weights add up to pi for any directions, so that a furnace becomes 1 with those above the base as well:
/// only how fast it does tells that walls below it are seen.
TEST(ReliefBounceTest, AFurnaceFillsAsFastAsWallsHideTheSky) {
  const HeightField field = eggCrate(64, 0.94);
  const BouncePaths paths = traceBounces(field, BounceDirections::ownFrame, 64);
  const std::vector<double> dark(field.texels(), 0.0);
  for (const auto& [bounces, expected] :
       {std::pair(1, 0.742), std::pair(2, 0.922), std::pair(4, 0.992), std::pair(8, 0.9999)})
    EXPECT_NEAR(meanOf(bounce(field, paths, dark, 1, 1, bounces)), expected, 0.01) << bounces << " bounces";
}

TEST(ReliefBounceTest, SixtyFourPathsOfTheOwnFrameAreEnough) {
  for (const HeightField& field : {eggCrate(64, 0.94), bricks(64, 1.52)}) {
    const std::vector<double> direct = directRadiance(field, lightAt35Degrees(), 0.7, 1);
    const std::vector<double> exact =
        gather(field, traceBounces(field, BounceDirections::ownFrame, 1024), direct, 0);
    const auto loss = [&](BounceDirections directions) {
      return lossOf(gather(field, traceBounces(field, directions, 64), direct, 0), exact);
    };
    const Loss own = loss(BounceDirections::ownFrame), shared = loss(BounceDirections::shared);
    const Loss published = loss(BounceDirections::published),
               deeper = loss(BounceDirections::publishedDeeper);
    EXPECT_LE(own.rms, 0.10);
    EXPECT_NEAR(own.mean, 1, 0.015);
    EXPECT_LT(own.rms, shared.rms);
    EXPECT_LT(shared.rms, deeper.rms);
    EXPECT_LT(deeper.rms, published.rms);
    // What the published directions lose, whatever their number: walls below the base plane.
    EXPECT_LT(
        lossOf(gather(field, traceBounces(field, BounceDirections::published, 1024), direct, 0), exact).mean,
        0.8);
  }
}

TEST(ReliefBounceTest, WeightsAddUpToPi) {
  const HeightField field = bricks(16, 1.5);
  for (const BounceDirections directions : {BounceDirections::ownFrame, BounceDirections::shared,
                                            BounceDirections::published, BounceDirections::publishedDeeper}) {
    const BouncePaths paths = traceBounces(field, directions, 40);
    for (std::size_t texel = 0; texel < field.texels(); ++texel) {
      double sum = 0;
      for (std::size_t i = 0; i < 40; ++i) sum += static_cast<double>(paths.list[texel * 40 + i].weight);
      EXPECT_NEAR(sum, std::numbers::pi, 1e-5);
    }
  }
  EXPECT_THROW(traceBounces(field, BounceDirections::shared, 0), UsageError);
}

TEST(ReliefBounceTest, PathsOfEachTexelAreHandedOverOnce) {
  constexpr int kPaths = 12, kSeed = 7;
  const HeightField field = eggCrate(16);
  const BouncePaths all = traceBounces(field, BounceDirections::publishedDeeper, kPaths, kSeed);
  std::vector<int> times(field.texels(), 0), alike(field.texels(), 0);
  const auto take = [&](std::size_t texel, std::span<const BouncePath> paths) {
    ++times[texel];
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const BouncePath& same = all.list[texel * kPaths + i];
      if (paths[i].place == same.place && paths[i].weight == same.weight) ++alike[texel];
    }
  };
  traceBounces(field, BounceDirections::publishedDeeper, kPaths, take, kSeed);
  EXPECT_EQ(times, std::vector<int>(field.texels(), 1));
  EXPECT_EQ(alike, std::vector<int>(field.texels(), kPaths));
}

TEST(ReliefBounceTest, FlatFieldsHaveNone) {
  for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(1, 6), glm::ivec2(6, 6)}) {
    const HeightField flat(size, std::vector<float>(static_cast<std::size_t>(size.x * size.y), -1.0f),
                           {1, 1});
    const std::vector<double> direct = directRadiance(flat, lightAt35Degrees(), 0.7, 1);
    EXPECT_NEAR(direct[0], 0.7 / std::numbers::pi * std::sin(35 * std::numbers::pi / 180), 1e-12);
    for (const double value : gather(flat, traceBounces(flat, BounceDirections::ownFrame, 16), direct, 0))
      EXPECT_EQ(value, 0);
    for (const double value : directRadiance(flat, {0.8, 0, -0.6}, 0.7, 1)) EXPECT_EQ(value, 0);
  }
}

}  // namespace
}  // namespace limn::relief
