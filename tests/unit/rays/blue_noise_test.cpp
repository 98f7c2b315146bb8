// Blue noise: every threshold once, and little of the low frequencies.
#include "core/rays/blue_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "glsl/numeric/language.glsl"

namespace limn::rays {
namespace {

/// Returns the mean power of the frequencies from `low` to `high` cycles per tile, in units of white noise's.
double power(const std::vector<float>& tile, int side, double low, double high) {
  double sum = 0;
  int count = 0;
  for (int v = -side / 2; v < side / 2; ++v) {
    for (int u = -side / 2; u < side / 2; ++u) {
      const double radius = std::hypot(u, v);
      if (radius < low || radius > high) continue;
      std::complex<double> amplitude = 0;
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
          amplitude += (double(tile[static_cast<size_t>(y * side + x)]) - 0.5) *
                       std::polar(1.0, -2 * double(glsl::pi) * (u * x + v * y) / side);
      sum += std::norm(amplitude);
      ++count;
    }
  }
  return 12 * sum / count / side / side;
}

TEST(BlueNoiseTest, EveryThresholdIsThereOnce) {
  for (const int side : {4, 16, 32}) {
    std::vector<float> tile = blueNoise(side, 3);
    std::ranges::sort(tile);
    ASSERT_EQ(tile.size(), static_cast<size_t>(side * side));
    for (size_t i = 0; i < tile.size(); ++i)
      EXPECT_EQ(tile[i], (static_cast<float>(i) + 0.5f) / static_cast<float>(side * side));
  }
}

TEST(BlueNoiseTest, LowFrequenciesAreWeak) {
  const int side = 32;
  const std::vector<float> tile = blueNoise(side, 1);
  EXPECT_LT(power(tile, side, 1, 6), 0.05);
  EXPECT_GT(power(tile, side, 12, 16), 1);
}

TEST(BlueNoiseTest, SeedsGiveTilesOfTheirOwn) {
  EXPECT_EQ(blueNoise(16, 1), blueNoise(16, 1));
  EXPECT_NE(blueNoise(16, 1), blueNoise(16, 2));
}

}  // namespace
}  // namespace limn::rays
