#include "core/image/private/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/error.h"

namespace limn {
namespace {

using Colour = std::array<float, 3>;

/// A picture from a function of (x, y), linear values.
template <class Function>
std::vector<float> picture(int width, int height, Function colourAt) {
  std::vector<float> pixels;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Colour colour = colourAt(x, y);
      pixels.insert(pixels.end(), colour.begin(), colour.end());
    }
  }
  return pixels;
}

double mean(const std::vector<float>& map) {
  return std::accumulate(map.begin(), map.end(), 0.0) / static_cast<double>(map.size());
}

Colour grey(float value) {
  return {value, value, value};
}

std::vector<float> uniformFlip(Colour a, Colour b) {
  const auto of = [](Colour c) { return picture(5, 4, [c](int, int) { return c; }); };
  return flipMap(of(a), of(b), 5, 4);
}

// Features of a uniform picture are 0 but for rounding of about 1e-8, which the square root of the feature
// exponent turns into 1e-4 of the exponent.
constexpr double kUniformTolerance = 1e-4;

TEST(Flip, UniformColoursFollowTheClosedForm) {
  // Uniform pictures have no features and pass the filters unchanged, so FLIP is the remapped HyAB distance.
  // Black and white: |dL| = 100 and no chroma. Largest distance: green L* 87.735, blue 32.303, Hunt-adjusted
  // HyAB 203.302. With c = 203.302^0.7 and d = 100^0.7 > 0.4 c: 0.95 + 0.05 (d - 0.4 c) / (0.6 c).
  const double c = std::pow(203.3017, 0.7), d = std::pow(100.0, 0.7);
  const double expected = 0.95 + 0.05 * (d - 0.4 * c) / (0.6 * c);
  for (const float value : uniformFlip(grey(0), grey(1))) EXPECT_NEAR(value, expected, kUniformTolerance);

  // Greys below the break: 0.95 d / (0.4 c). Y = 0.2 and 0.25 have L* = 116 cbrt(Y) - 16.
  const double dark = std::pow(116 * (std::cbrt(0.25) - std::cbrt(0.2)), 0.7);
  for (const float value : uniformFlip(grey(0.2f), grey(0.25f)))
    EXPECT_NEAR(value, 0.95 * dark / (0.4 * c), kUniformTolerance);
}

TEST(Flip, LargestDistanceIsGreenAgainstBlue) {
  for (const float value : uniformFlip({0, 1, 0}, {0, 0, 1})) EXPECT_NEAR(value, 1.0, kUniformTolerance);
}

TEST(Flip, UniformColoursMatchDirectEvaluation) {
  // A direct evaluation of the paper's formulas in double precision.
  EXPECT_NEAR(uniformFlip({1, 0, 0}, {0, 1, 0})[7], 0.986662, kUniformTolerance);
  EXPECT_NEAR(uniformFlip({0.5f, 0.5f, 0.5f}, {0.55f, 0.5f, 0.5f})[7], 0.123639, kUniformTolerance);
  EXPECT_NEAR(uniformFlip(grey(0), grey(0.01f))[7], 0.267698, kUniformTolerance);
}

TEST(Flip, EqualPicturesDifferByZero) {
  const auto pattern =
      picture(33, 17, [](int x, int y) { return grey(static_cast<float>((x * y) % 7) / 6.0f); });
  for (const float value : flipMap(pattern, pattern, 33, 17)) EXPECT_EQ(value, 0.0f);
}

/// Test pictures given by integer formulas, 48 x 40.
constexpr int kWidth = 48, kHeight = 40;
std::pair<std::vector<float>, std::vector<float>> patterns() {
  const auto common = [](int x, int y, int shift, float red, float low, float high) -> Colour {
    return {red * static_cast<float>((x * 7 + y * 13) % 32) / 31.0f,
            static_cast<float>((x * 3 + y * 5 + x * y + shift) % 17) / 16.0f,
            (x / 6 + y / 5) % 2 == 0 ? low : high};
  };
  return {picture(kWidth, kHeight, [&](int x, int y) { return common(x, y, 0, 1.0f, 0.1f, 0.9f); }),
          picture(kWidth, kHeight, [&](int x, int y) { return common(x, y, 1, 0.8f, 0.15f, 0.85f); })};
}

// The values below are those of NVIDIA's own implementation (python/flip_api.py of NVlabs/flip:
// its matrices, two-dimensional filters and replicated borders), evaluated in double precision.
constexpr double kNvidiaTolerance = 1e-5;

TEST(Flip, PatternsMatchNvidiasImplementation) {
  const auto [a, b] = patterns();
  const std::vector<float> map = flipMap(a, b, kWidth, kHeight);
  EXPECT_NEAR(mean(map), 0.2835646, kNvidiaTolerance);
  EXPECT_NEAR(*std::max_element(map.begin(), map.end()), 0.6114755, kNvidiaTolerance);
  EXPECT_NEAR(map[0], 0.4157690, kNvidiaTolerance);
  EXPECT_NEAR(map[20 * kWidth + 24], 0.2282455, kNvidiaTolerance);
  EXPECT_NEAR(map[39 * kWidth + 47], 0.3562346, kNvidiaTolerance);
  EXPECT_NEAR(map[7 * kWidth + 31], 0.3028317, kNvidiaTolerance);
}

TEST(Flip, OtherDistancesMatchNvidiasImplementation) {
  const auto [a, b] = patterns();
  const std::vector<float> near = flipMap(a, b, kWidth, kHeight, 20.0);
  EXPECT_NEAR(mean(near), 0.4351887, kNvidiaTolerance);
  EXPECT_NEAR(near[20 * kWidth + 24], 0.4993346, kNvidiaTolerance);
  const std::vector<float> far = flipMap(a, b, kWidth, kHeight, 134.04);
  EXPECT_NEAR(mean(far), 0.2379443, kNvidiaTolerance);
  EXPECT_NEAR(far[20 * kWidth + 24], 0.2269682, kNvidiaTolerance);
}

TEST(Flip, EdgesAndPointsMatchNvidiasImplementation) {
  const auto edgeAt = [](int column) {
    return picture(kWidth, kHeight, [column](int x, int) { return grey(x >= column ? 0.5f : 0.0f); });
  };
  const std::vector<float> edge = edgeAt(kWidth / 2);
  const std::vector<float> shifted = flipMap(edge, edgeAt(kWidth / 2 + 2), kWidth, kHeight);
  EXPECT_NEAR(mean(shifted), 0.0870282, kNvidiaTolerance);
  EXPECT_NEAR(shifted[20 * kWidth + 23], 0.8696436, kNvidiaTolerance);
  EXPECT_NEAR(shifted[20 * kWidth + 24], 0.8678588, kNvidiaTolerance);
  EXPECT_NEAR(shifted[20 * kWidth + 26], 0.4550926, kNvidiaTolerance);

  std::vector<float> dot = edge;
  std::fill_n(dot.begin() + 3 * (20 * kWidth + 10), 3, 1.0f);
  const std::vector<float> point = flipMap(dot, edge, kWidth, kHeight);
  EXPECT_NEAR(mean(point), 0.0074539, kNvidiaTolerance);
  EXPECT_NEAR(point[20 * kWidth + 10], 0.8649065, kNvidiaTolerance);
  EXPECT_NEAR(point[20 * kWidth + 13], 0.1337110, kNvidiaTolerance);
}

TEST(Flip, IsSymmetricAndBounded) {
  const auto [a, b] = patterns();
  const std::vector<float> forward = flipMap(a, b, kWidth, kHeight);
  EXPECT_EQ(forward, flipMap(b, a, kWidth, kHeight));
  for (const float value : forward) EXPECT_TRUE(value >= 0.0f && value <= 1.0f);
}

TEST(Flip, BandsJoinWithoutSeams) {
  // Taller than one band: a picture constant along y must give a map constant along y.
  const auto stripes = [](float contrast) {
    return picture(40, 150, [contrast](int x, int) { return grey(x % 9 < 4 ? contrast : 0.2f); });
  };
  const std::vector<float> map = flipMap(stripes(0.6f), stripes(0.5f), 40, 150);
  for (std::size_t i = 40; i < map.size(); ++i) ASSERT_EQ(map[i], map[i - 40]);
}

TEST(Flip, AcceptsSinglePixelsRowsAndColumns) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(300, 1), std::pair(1, 300)}) {
    const auto black = picture(width, height, [](int, int) { return grey(0); });
    const auto white = picture(width, height, [](int, int) { return grey(1); });
    EXPECT_NEAR(mean(flipMap(black, white, width, height)), 0.96738, 1e-4);
  }
}

TEST(Flip, RefusesWrongLengths) {
  const std::vector<float> pixels(12);
  EXPECT_THROW(flipMap(pixels, pixels, 3, 2), Error);
  EXPECT_THROW(flipMap(pixels, pixels, 0, 0), Error);
  EXPECT_THROW(flipMap(pixels, pixels, 2, 2, 0.0), Error);
}

}  // namespace
}  // namespace limn
