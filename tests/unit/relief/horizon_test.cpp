#include "core/relief/horizon.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/relief/ellipse.h"
#include "tests/unit/relief/fields.h"

namespace limn::relief {
namespace {

using namespace test;

/// Returns the root of the mean square of the difference in rho.
double difference(const Horizons& a, const Horizons& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.tangents.size(); ++i) {
    const double apart =
        litRadius(static_cast<double>(a.tangents[i])) - litRadius(static_cast<double>(b.tangents[i]));
    sum += apart * apart;
  }
  return std::sqrt(sum / static_cast<double>(a.tangents.size()));
}

TEST(ReliefHorizonTest, IsTheSteepestOfADenseMarch) {
  const HeightField field = bricks(24);
  double largest = 0;
  for (const double azimuth : {0.0, 0.3, 1.9, 3.7, 5.5})
    for (int texel = 0; texel < 24; ++texel) {
      const glm::dvec2 start(texel, (7 * texel) % 24),
          along = 24.0 * glm::dvec2(std::cos(azimuth), std::sin(azimuth));
      const double exact = exactHorizon(field, start, azimuth);
      double marched = 0;
      for (int i = 1; i <= 60000; ++i) {
        const double s = 5e-5 * i;
        marched = std::max(marched, (field.height(start + s * along) - field.height(start)) / s);
      }
      EXPECT_GE(exact, marched - 1e-9);
      largest = std::max(largest, exact - marched);
    }
  // A march that passes a crest at half a step, 2.5e-5 m, next to a texel of 1/24 m misses this part of a
  // slope below 3.
  EXPECT_LT(largest, 3 * 2.5e-5 * 24 * 2);
}

TEST(ReliefHorizonTest, IsThatOfAGroove) {
  // A sight line along azimuth f crosses the groove in 1/|cos f| times its width.
  const HeightField field = groove(32, 0.8);
  for (const Horizons& horizons : {sweepHorizons(field, 32), exactHorizons(field, 32)})
    for (int i = 0; i < 32; ++i)
      for (int x = 0; x < 32; ++x) {
        const double cosine = std::cos(horizons.angle(i)), crest = cosine > 0 ? 32 - x : (x == 0 ? 32 : x);
        const double below = 0.8 * (0.5 - std::abs(x - 16) / 32.0);
        const double expected = below / (crest / 32) * (std::abs(cosine) < 1e-9 ? 0 : std::abs(cosine));
        EXPECT_NEAR(horizons.tangent(i, static_cast<std::size_t>(x)), expected, 1e-5) << i << ' ' << x;
      }
}

TEST(ReliefHorizonTest, SweepsAgreeWithEachSightLine) {
  // Lines pass up to a texel beside what they stand for; bricks have bevels of 2 texels that lie askew to
  // them.
  EXPECT_LT(difference(sweepHorizons(noise(64), 24), exactHorizons(noise(64), 24)), 0.003);
  EXPECT_LT(difference(sweepHorizons(eggCrate(64), 24), exactHorizons(eggCrate(64), 24)), 0.005);
  EXPECT_LT(difference(sweepHorizons(bricks(64), 24), exactHorizons(bricks(64), 24)), 0.02);
}

TEST(ReliefHorizonTest, SweepsAgreeOnTilesThatAreNotSquareAndOnClampedEdges) {
  std::vector<float> values;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 24; ++x)
      values.push_back(std::sin(0.5f * static_cast<float>(x)) * std::cos(0.3f * static_cast<float>(y)));
  for (const Wrap wrap : {Wrap::periodic, Wrap::clamped}) {
    const HeightField field({24, 40}, values, {2, 1}, 0.05, 3, wrap);
    EXPECT_LT(difference(sweepHorizons(field, 20), exactHorizons(field, 20)), 0.01);
  }
}

/// Grooves as above on tiles that are a million times and more as long as wide: in metres 8 of the longer
/// sides are 4e8 texels of the shorter one, or more than integers count.
TEST(ReliefHorizonTest, LinesEndAfterAsManyTexelsOfStretchedTiles) {
  constexpr int size = 64;
  constexpr double scale = 1000;
  std::vector<float> values;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      values.push_back(static_cast<float>(std::abs(x - size / 2)) / static_cast<float>(size));
  for (const glm::dvec2& tile : {glm::dvec2(1e-3, 1e3), glm::dvec2(1e-6, 1e6)}) {
    const HeightField field({size, size}, values, tile, scale);
    const Horizons horizons = sweepHorizons(field, 5);  // none of them along the grooves
    for (int i = 0; i < 5; ++i)
      for (int x = 0; x < size; ++x) {
        const double cosine = std::cos(horizons.angle(i)),
                     crest = cosine > 0 ? size - x : (x == 0 ? size : x);
        const double below = scale * (0.5 - std::abs(x - size / 2) / static_cast<double>(size));
        const double expected = below / (crest / size * tile.x) * std::abs(cosine);
        EXPECT_NEAR(horizons.tangent(i, static_cast<std::size_t>(5 * size + x)), expected,
                    1e-5 * (1 + expected))
            << tile.x << ' ' << i << ' ' << x;
      }
  }
}

/// Ridges as a profile one texel wide, whose texels are square: 8 sizes of the map ahead of each texel across
/// the profile would be 65536 texels that are all alike.
TEST(ReliefHorizonTest, ProfilesOfOneTexelAreFollowedAlongTheirLength) {
  constexpr int size = 8192;
  std::vector<float> values;
  for (int i = 0; i < size; ++i) values.push_back(static_cast<float>(std::abs(i % 64 - 32)) / 32);
  for (const Wrap wrap : {Wrap::periodic, Wrap::clamped})
    for (const int axis : {0, 1}) {
      glm::ivec2 texels(1);
      texels[axis] = size;
      const HeightField field(texels, values, glm::dvec2(texels) * 1e-3, 0.05, 0, wrap);
      const Horizons swept = sweepHorizons(field, 12);
      for (int i = 0; i < 12; ++i)
        for (const int at : {0, 31, 32, 50, 4100, size - 1}) {
          glm::dvec2 place(0);
          place[axis] = at;
          const double angle = swept.angle(i), along = axis == 0 ? std::cos(angle) : std::sin(angle),
                       expected = std::abs(along) < 1e-9 ? 0 : exactHorizon(field, place, angle);
          EXPECT_NEAR(swept.tangent(i, static_cast<std::size_t>(at)), expected, 1e-5 * (1 + expected))
              << axis << ' ' << i << ' ' << at;
        }
    }
}

TEST(ReliefHorizonTest, OfFlatAndSmallFieldsIsLevel) {
  for (const Wrap wrap : {Wrap::periodic, Wrap::clamped})
    for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(1, 7), glm::ivec2(7, 1), glm::ivec2(5, 5)}) {
      const HeightField flat(size, std::vector<float>(static_cast<std::size_t>(size.x * size.y), 0.3f),
                             {1, 1}, 1, 0, wrap);
      for (const float tangent : sweepHorizons(flat, 7).tangents) EXPECT_EQ(tangent, 0);
      for (const float tangent : exactHorizons(flat, 7).tangents) EXPECT_EQ(tangent, 0);
    }
}

TEST(ReliefHorizonTest, FollowsTheScale) {
  const auto scaled = [](double scale) {
    return HeightField({8, 1}, {0, 1, 3, 2, 0, 0, 5, 1}, {1, 1}, scale, 0);
  };
  const Horizons one = exactHorizons(scaled(1), 9), small = exactHorizons(scaled(1e-4), 9);
  for (std::size_t i = 0; i < one.tangents.size(); ++i)
    EXPECT_NEAR(small.tangents[i], 1e-4f * one.tangents[i], 1e-6f * (1e-4f + one.tangents[i]));
  // The field is the same all along v, so that lines that pass beside a texel have its heights.
  for (const double scale : {1e4, -1.0, -1e4}) {
    const Horizons swept = sweepHorizons(scaled(scale), 9), exact = exactHorizons(scaled(scale), 9);
    for (std::size_t i = 0; i < exact.tangents.size(); ++i)
      EXPECT_NEAR(swept.tangents[i], exact.tangents[i], 1e-5f * (1 + exact.tangents[i]))
          << "scale " << scale << ", texel " << i % exact.texels << ", azimuth " << i / exact.texels;
  }
  for (const float tangent : sweepHorizons(scaled(0), 9).tangents) EXPECT_EQ(tangent, 0);
  EXPECT_THROW(sweepHorizons(scaled(1), 0), UsageError);
}

}  // namespace
}  // namespace limn::relief
