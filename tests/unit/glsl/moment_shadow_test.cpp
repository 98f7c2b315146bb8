// Moments of depth, and what they bound: laws of the moment problem on distributions whose answer is known.
#include "glsl/shadow/moment_shadow.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace limn::glsl {
namespace {

constexpr float kBias = 1e-6f;

struct Point {
  double depth, weight;
};
using Distribution = std::vector<Point>;

vec4 moments(const Distribution& points) {
  dvec4 sum(0);
  for (const Point& p : points) {
    const double u = 2 * p.depth - 1;
    sum += p.weight * dvec4(u, 2 * u * u - 1, u * (4 * u * u - 3), 8 * u * u * (u * u - 1) + 1);
  }
  return vec4(sum);
}

/// (share, mean depth) of what is nearer than d.
dvec2 nearer(const Distribution& points, double d) {
  double share = 0, depth = 0;
  for (const Point& p : points) {
    if (p.depth >= d) continue;
    share += p.weight;
    depth += p.weight * p.depth;
  }
  return {share, share > 0 ? depth / share : d};
}

Distribution randomDistribution(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> unit(0, 1);
  Distribution points(static_cast<size_t>(count));
  double total = 0;
  for (Point& p : points) {
    p = {unit(random), 0.05 + unit(random)};
    total += p.weight;
  }
  for (Point& p : points) p.weight /= total;
  return points;
}

TEST(MomentShadow, PolynomialsFillTheirRangeAndStayInIt) {
  EXPECT_EQ(moment_polynomials(0.f), vec4(-1, 1, -1, 1));
  EXPECT_EQ(moment_polynomials(1.f), vec4(1, 1, 1, 1));
  EXPECT_EQ(moment_polynomials(0.5f), vec4(0, -1, 0, 1));
  EXPECT_EQ(moment_polynomials(-5.f), moment_polynomials(0.f));
  EXPECT_EQ(moment_polynomials(INFINITY), moment_polynomials(1.f));
  EXPECT_EQ(moment_polynomials(NAN), moment_polynomials(1.f));
  for (int i = 0; i <= 10000; ++i) {
    const double z = i / 10000.0, angle = std::acos(2 * z - 1);
    const vec4 t = moment_polynomials(static_cast<float>(z));
    for (int k = 0; k < 4; ++k) {
      ASSERT_NEAR(t[k], std::cos((k + 1) * angle), 3e-6) << z;
      ASSERT_LE(std::abs(t[k]), 1.f) << z;
    }
  }
}

TEST(MomentShadow, TheLargestBoxIsExactAndNoLarger) {
  for (int bits = 10; bits <= 20; ++bits) {
    const int64_t side = moment_largest_side(bits), scale = moment_scale(bits);
    EXPECT_LE(side * side * scale, int64_t{2147483647}) << bits;
    EXPECT_GT((side + 1) * (side + 1) * scale, int64_t{2147483647}) << bits;
  }
  EXPECT_EQ(moment_largest_side(16), 256);
  EXPECT_EQ(moment_largest_side(18), 128);
}

/// Sums of n texels of one depth are off by less than a constant, so that their mean is by O(1 / n).
TEST(MomentShadow, RoundingAveragesOut) {
  for (const int bits : {10, 14, 18, 20}) {
    for (const float z : {0.f, 0.1234f, 0.5f, 0.8111f, 1.f}) {
      const vec4 t = moment_polynomials(z);
      for (const uint side : {4u, 16u, 64u}) {
        dvec4 sum(0);
        for (uint y = 0; y < side; ++y) {
          for (uint x = 0; x < side; ++x) {
            const ivec4 texel = ivec4(moment_texel(z, uvec2(x + 100, y + 37), bits));
            for (int k = 0; k < 4; ++k) {
              ASSERT_LE(std::abs(texel[k]), moment_scale(bits));
              // One step; a float holds t times 2^19 only to 1/32 of one.
              ASSERT_NEAR(texel[k], double{t[k]} * moment_scale(bits), 1.05);
            }
            sum += dvec4(texel);
          }
        }
        for (int k = 0; k < 4; ++k) {
          const double mean = sum[k] / (double(side) * side);
          EXPECT_NEAR(mean, double{t[k]} * moment_scale(bits), 4.0 / side / std::sqrt(side) + 0.04)
              << bits << " bits, depth " << z << ", moment " << k + 1 << ", side " << side;
        }
      }
    }
  }
}

TEST(MomentShadow, DistributionsOfOneAndTwoDepthsAreExact) {
  for (const double z : {0.0, 0.2, 0.5, 0.93, 1.0}) {
    for (const double d : {0.05, 0.3, 0.6, 0.99}) {
      if (std::abs(z - d) < 0.04) continue;
      const MomentBlockers b = moment_blockers(moments({{z, 1}}), static_cast<float>(d), 0, kBias);
      EXPECT_NEAR(b.share, z < d ? 1 : 0, 2e-3) << z << " " << d;
      if (z < d) {
        EXPECT_NEAR(b.depth, z, 2e-3) << z << " " << d;
      }
    }
  }
  for (const double share : {0.02, 0.3, 0.5, 0.95}) {
    for (const double d : {0.35, 0.5, 0.65}) {
      const Distribution points{{0.2, share}, {0.8, 1 - share}};
      const MomentBlockers b = moment_blockers(moments(points), static_cast<float>(d), 0, kBias);
      EXPECT_NEAR(b.share, share, 2e-3) << share << " " << d;
      EXPECT_NEAR(b.depth, 0.2, 3e-3) << share << " " << d;
    }
  }
}

TEST(MomentShadow, DistributionsOfThreeDepthsAreExactAtEachOfThem) {
  const Distribution points{{0.15, 0.3}, {0.4, 0.2}, {0.85, 0.5}};
  const vec4 t = moments(points);
  EXPECT_NEAR(moment_blockers(t, 0.15f, 0, kBias).share, 0, 1e-3);
  const MomentBlockers second = moment_blockers(t, 0.4f, 0, kBias),
                       third = moment_blockers(t, 0.85f, 0, kBias);
  EXPECT_NEAR(second.share, 0.3, 2e-3);
  EXPECT_NEAR(second.depth, 0.15, 2e-3);
  EXPECT_NEAR(third.share, 0.5, 2e-3);
  EXPECT_NEAR(third.depth, (0.15 * 0.3 + 0.4 * 0.2) / 0.5, 2e-3);
}

TEST(MomentShadow, TheShareIsALowerBoundAndGrowsWithDepth) {
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    const Distribution points = randomDistribution(random, 1 + i % 9);
    const vec4 t = moments(points);
    float former = 0;
    for (int step = 0; step <= 100; ++step) {
      const float d = static_cast<float>(step) / 100;
      const MomentBlockers b = moment_blockers(t, d, 0, kBias);
      // What the bias adds near the depths themselves is not below the distribution's own share; d a little
      // farther.
      ASSERT_LE(b.share, nearer(points, d + 0.004).x + 2e-3) << i << " " << d;
      ASSERT_GE(b.share, former - 2e-3) << i << " " << d;
      ASSERT_GE(b.depth, 0.f);
      ASSERT_LE(b.depth, d);
      former = b.share;
    }
  }
}

TEST(MomentShadow, NothingIsBlockedByWhatLiesBehind) {
  std::mt19937 random(2);
  for (int i = 0; i < 500; ++i) {
    const Distribution points = randomDistribution(random, 1 + i % 5);
    const double nearest = std::ranges::min(points, {}, &Point::depth).depth;
    const auto d = static_cast<float>(nearest - 0.002);
    if (d > 0) {
      ASSERT_LE(moment_blockers(moments(points), d, 0, kBias).share, 2e-3f) << i;
    }
    ASSERT_EQ(moment_blockers(moments(points), d, static_cast<float>(nearest), kBias).share, 0.f);
  }
}

TEST(MomentShadow, DegenerateAndInconsistentMomentsGiveSharesWithinRange) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1), noise(-1e-4f, 1e-4f), any(-1, 1);
  for (int i = 0; i < 20000; ++i) {
    const float z = i % 3 == 0 ? 1.f : i % 3 == 1 ? 0.f : unit(random);
    vec4 t = moments({{z, 1}});
    if (i % 2 == 0) t += vec4(noise(random), noise(random), noise(random), noise(random));
    if (i % 7 == 0) t = vec4(any(random), any(random), any(random), any(random));
    const float d = i % 5 == 0 ? z : unit(random);
    for (const float pull : {1e-7f, 1e-6f, 0.1f}) {
      const MomentBlockers b = moment_blockers(t, d, 0, pull);
      ASSERT_TRUE(b.share >= 0 && b.share <= 1) << b.share;
      ASSERT_TRUE(b.depth >= 0 && b.depth <= d) << b.depth;
    }
  }
}

TEST(MomentShadow, PartsCoverTheirBoxes) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int i = 0; i < 5000; ++i) {
    float lo = 20 * unit(random), hi = lo + 0.01f + (i % 3 == 0 ? 1 : 12) * unit(random);
    if (i % 4 == 0) lo = std::floor(lo);
    if (i % 5 == 0) hi = std::max(std::ceil(hi), lo + 1);
    std::vector<float> covered(40, 0);
    int parts = 0;
    MomentPart part{.begin = 0, .end = lo, .weight = 0};
    do {
      const float before = std::floor(part.end);
      part = moment_part(part.end, hi);
      ASSERT_EQ(part.begin, before);
      ASSERT_GT(part.end, part.begin);
      ASSERT_EQ(part.end, std::floor(part.end));
      for (auto x = static_cast<size_t>(part.begin); x < static_cast<size_t>(part.end); ++x)
        covered[x] += part.weight;
      ++parts;
    } while (part.end < hi);
    const bool whole = lo == std::floor(lo) && hi == std::floor(hi);
    ASSERT_LE(parts, whole ? 1 : 3);
    for (int x = 0; x < 40; ++x) {
      const float expected = std::max(std::min(hi, float(x + 1)) - std::max(lo, float(x)), 0.f);
      ASSERT_NEAR(covered[static_cast<size_t>(x)], expected, 1e-6f) << lo << " " << hi << " texel " << x;
    }
  }
}

TEST(MomentShadow, CellsCoverTheirBoxesAndNothingElse) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int i = 0; i < 5000; ++i) {
    const float lo = 20 * unit(random), hi = lo + (i % 2 == 0 ? 1.5f : 20.f) * unit(random);
    const int parts = 1 + static_cast<int>(random() % 8);
    float covered = 0;
    for (int k = 0; k < parts; ++k) {
      const float begin = moment_cell_edge(lo, hi, k, parts), end = moment_cell_edge(lo, hi, k + 1, parts);
      ASSERT_TRUE(lo <= begin && begin <= end && end <= hi) << lo << " " << hi << " cell " << k;
      // Whole texels, so that sums of the table are exact, but for the ends.
      ASSERT_TRUE(begin == lo || begin == hi || begin == std::floor(begin));
      covered += end - begin;
    }
    ASSERT_NEAR(covered, hi - lo, 1e-5f);
  }
}

}  // namespace
}  // namespace limn::glsl
