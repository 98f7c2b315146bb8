// Integer summed-area tables on the CPU: exactness, its bounds, moments against double.
#include "glsl/shadow/summed_area_table.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace limn {
namespace {

using namespace glsl;

uint64_t wide(uvec2 a) {
  return uint64_t{a.y} << 32 | a.x;
}
uvec2 words(uint64_t a) {
  return {static_cast<uint32_t>(a), static_cast<uint32_t>(a >> 32)};
}

TEST(SummedAreaTable, WideArithmeticIsThatOf64Bits) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100000; ++i) {
    const uint64_t a = random() >> (i % 64), b = random() >> (i / 64 % 64);
    const auto c = static_cast<uint32_t>(random());
    ASSERT_EQ(wide(wide_add(words(a), words(b))), a + b);
    ASSERT_EQ(wide(wide_subtract(words(a), words(b))), a - b);
    ASSERT_EQ(wide(wide_multiply(words(a), c)), a * c);
    const auto d = static_cast<int64_t>(a - b);
    ASSERT_NEAR(wide_signed_float(words(a - b)), static_cast<double>(d),
                1.3e-7 * std::abs(static_cast<double>(d)));
  }
}

TEST(SummedAreaTable, QuantisesToTheNearestAndStaysInRange) {
  for (const uint bits : {8u, 12u, 16u, 24u}) {
    const uint format = sat_format(bits, 2, 1), scale = sat_scale(format);
    EXPECT_EQ(sat_quantise(0.f, format), 0u);
    EXPECT_EQ(sat_quantise(1.f, format), scale);
    EXPECT_EQ(sat_quantise(-3.f, format), 0u);
    EXPECT_EQ(sat_quantise(7.f, format), scale);
    EXPECT_EQ(sat_quantise(NAN, format), scale);
    EXPECT_EQ(sat_quantise(INFINITY, format), scale);
    EXPECT_EQ(sat_quantise(std::nextafter(1.f, 0.f), format), bits == 24 ? scale - 1 : scale);
    std::mt19937 random(bits);
    std::uniform_real_distribution<float> unit(0.f, 1.f);
    for (int i = 0; i < 10000; ++i) {
      const float z = unit(random);
      // Half a quantum, and the rounding of z M to a float.
      ASSERT_LE(std::abs(double{z} * scale - sat_quantise(z, format)), 0.5 + 6e-8 * scale);
    }
  }
}

TEST(SummedAreaTable, NearestQuantaStayInRange) {
  for (const uint bits : {8u, 16u, 24u}) {
    const uint format = sat_format(bits, 2, 1), scale = sat_scale(format);
    EXPECT_EQ(sat_nearest(static_cast<float>(scale), format), scale) << "256 times that fits one word";
    EXPECT_EQ(sat_nearest(0.4f, format), 0u);
    EXPECT_EQ(sat_nearest(100.6f, format), 101u);
  }
}

TEST(SummedAreaTable, RoundedSquaresAreTheNearest) {
  for (const uint bits : {8u, 16u, 24u}) {
    const uint format = sat_format(bits, 1, 1), scale = sat_scale(format);
    for (uint64_t z = 0; z <= scale; z += bits == 24 ? 101 : 1) {
      const uvec4 texel = sat_texel(static_cast<float>(static_cast<double>(z) / scale), format);
      const uint64_t value = texel.x;
      ASSERT_EQ(texel.y, (value * value + scale / 2) / scale);
      ASSERT_EQ(texel.z, 0u);
    }
  }
}

/// A table in memory, with what it stores.
struct Table {
  uint format;
  int width, height;
  std::vector<uvec4> texels;

  Table(uint f, int w, int h, const std::vector<float>& z)
      : format(f), width(w), height(h), texels(z.size()) {
    for (int y = 0; y < h; ++y) {
      uvec4 row(0u);
      for (int x = 0; x < w; ++x) {
        row = sat_add(row, sat_texel(z[index(x, y)], f));
        const uvec4 sum = y == 0 ? row : sat_add(row, sat_unpack(texels[index(x, y - 1)], f));
        texels[index(x, y)] = stored(sat_pack(sum, f));
      }
    }
  }
  size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
  /// Without the components that the texture lacks.
  uvec4 stored(uvec4 t) const {
    if (sat_two_words(format)) return sat_has_squares(format) ? t : uvec4(t.x, t.y, 0, 0);
    return {t.x, sat_has_squares(format) ? t.y : 0u, 0, 0};
  }
  uvec4 sums(int x, int y) const {
    x = std::min(x, width), y = std::min(y, height);
    return x <= 0 || y <= 0 ? uvec4(0u) : sat_unpack(texels[index(x - 1, y - 1)], format);
  }
  SatBox box(ivec2 lo, ivec2 hi) const {
    return sat_kernel_box(sums(hi.x, hi.y), sums(lo.x, hi.y), sums(hi.x, lo.y), sums(lo.x, lo.y), lo, hi,
                          {width, height}, format);
  }
  vec2 moments(vec2 lo, vec2 hi, float d) const {
    const ivec2 margin = sat_margin({width, height}, format);
    const SatAxis x = sat_axis(lo.x, hi.x, width, margin.x), y = sat_axis(lo.y, hi.y, height, margin.y);
    const uint receiver = sat_quantise(d, format);
    SatMoments m{0, 0, 0};
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        m = sat_accumulated(m, box({x.edges[i], y.edges[j]}, {x.edges[i + 1], y.edges[j + 1]}),
                            x.weights[i] * y.weights[j], receiver, format);
      }
    }
    return sat_moments(sat_beyond(m, lo, hi, {width, height}, receiver, format), d, receiver, format);
  }
};

TEST(SummedAreaTable, OneWordIsExactUpTo65537TexelsAtDepthOne) {
  const uint format = sat_format(16, 1, 0);
  EXPECT_EQ(sat_largest_box(format), 65537u);
  const Table table(format, 65538, 3, std::vector<float>(size_t{65538} * 3, 1.f));
  EXPECT_EQ(wide(table.box({0, 2}, {65537, 3}).z), uint64_t{65537} * 65535);
  EXPECT_EQ(wide(table.box({1, 1}, {65538, 2}).z), uint64_t{65537} * 65535);
  EXPECT_EQ(wide(table.box({0, 2}, {65538, 3}).z), uint64_t{65538} * 65535 - (uint64_t{1} << 32));
  const Table twoWords(sat_format(16, 2, 0), 65538, 3, std::vector<float>(size_t{65538} * 3, 1.f));
  EXPECT_EQ(wide(twoWords.box({0, 0}, {65538, 3}).z), uint64_t{65538} * 3 * 65535);
}

TEST(SummedAreaTable, LargestBoxIsWhereTheSumOfOnesStillFits) {
  for (uint bits = 8; bits <= 24; ++bits) {
    const uint64_t scale = (uint64_t{1} << bits) - 1, words32 = 0xffffffffu, words64 = ~uint64_t{0};
    const auto limited = [&](uint64_t n) { return static_cast<uint>(std::min(n, words32)); };
    EXPECT_EQ(sat_largest_box(sat_format(bits, 1, 0)), limited(words32 / scale)) << bits;
    EXPECT_EQ(sat_largest_box(sat_format(bits, 1, 1)), limited(words32 / scale)) << bits;
    EXPECT_EQ(sat_largest_box(sat_format(bits, 2, 0)), limited(words64 / scale)) << bits;
    EXPECT_EQ(sat_largest_box(sat_format(bits, 2, 1)), limited(words64 / (scale * scale))) << bits;
  }
}

std::vector<float> randomDepths(size_t count, float centre, float spread, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(centre - spread, centre + spread);
  std::vector<float> z(count);
  for (float& v : z) v = std::clamp(value(random), 0.f, 1.f);
  return z;
}

/// Moments about d of the quantised depths over the kernel, texel by texel.
dvec2 momentsInDouble(const Table& table, const std::vector<float>& z, vec2 lo, vec2 hi, float d) {
  const auto overlap = [](float a, float b, int i) {
    return std::max(0.0, std::min<double>(b, i + 1) - std::max<double>(a, i));
  };
  const double scale = sat_scale(table.format);
  dvec2 sum(0);
  double weights = 0;
  for (int y = static_cast<int>(std::floor(lo.y)); y <= static_cast<int>(hi.y); ++y) {
    for (int x = static_cast<int>(std::floor(lo.x)); x <= static_cast<int>(hi.x); ++x) {
      const bool inside = x >= 0 && y >= 0 && x < table.width && y < table.height;
      const double depth = inside ? sat_quantise(z[table.index(x, y)], table.format) / scale : 1.0;
      const double w = overlap(lo.x, hi.x, x) * overlap(lo.y, hi.y, y);
      sum += w * dvec2(d - depth, (d - depth) * (d - depth));
      weights += w;
    }
  }
  return sum / weights;
}

TEST(SummedAreaTable, MomentsOfRandomKernelsAgreeWithDouble) {
  constexpr int width = 100, height = 77;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.f, 1.f);
  for (const uint bits : {8u, 16u, 24u}) {
    // Over the whole range, and within 1e-3 of it: where floating-point moments are lost.
    for (const float spread : {0.6f, 5e-4f}) {
      const auto z = randomDepths(size_t{width} * height, 0.5f, spread, bits);
      const Table table(sat_format(bits, 2, 1), width, height, z);
      for (int i = 0; i < 200; ++i) {
        const vec2 lo(unit(random) * 110 - 10, unit(random) * 90 - 10);
        const vec2 hi = lo + vec2(unit(random), unit(random)) * (i % 4 == 0 ? 0.9f : 60.f) + vec2(0.01f);
        const float d = i % 10 == 0 ? -0.2f + 1.4f * unit(random) : 0.5f + 2 * spread * (unit(random) - 0.5f);
        const vec2 m = table.moments(lo, hi, d);
        const dvec2 exact = momentsInDouble(table, z, lo, hi, d);
        // Edges are floats: their weights carry 1e-5 of a texel at most.
        const double root = std::sqrt(exact.y);
        ASSERT_NEAR(m.x, exact.x, 2e-5 * root + 1.2e-7) << bits << " bits, kernel " << i;
        ASSERT_NEAR(m.y, exact.y, 4e-5 * exact.y + 2.4e-7 * root + 1e-14) << bits << " bits, kernel " << i;
      }
    }
  }
}

TEST(SummedAreaTable, OutsideTheMapCountsAsUnoccluded) {
  const Table table(sat_format(16, 2, 1), 8, 8, std::vector<float>(64, 0.f));
  // Half of the kernel outside: E(1 - z) = 1/2.
  EXPECT_FLOAT_EQ(table.moments({-4, 0}, {4, 8}, 1).x, 0.5f);
  EXPECT_FLOAT_EQ(table.moments({4.5f, 2}, {11.5f, 6}, 1).x, 0.5f);
  EXPECT_FLOAT_EQ(table.moments({20, 20}, {24, 24}, 1).x, 0.f);
  // Kernels ten maps wide, which hold all of the map or six of its rows, and a far wider one.
  for (const auto& [lo, inside] : {std::pair(vec2(-36), 64.f), {vec2(0, -72), 64.f}, {vec2(-70, 2), 48.f}}) {
    const vec2 m = table.moments(lo, lo + vec2(80), 1);
    EXPECT_FLOAT_EQ(m.x, inside / 6400) << lo.x;
    EXPECT_FLOAT_EQ(m.y, inside / 6400) << lo.x << ": depths lie 1 and 0 before 1";
  }
  EXPECT_NEAR(table.moments({-1e9f, -1e9f}, {1e9f, 1e9f}, 1).x, 64 / 4e18, 1e-18);
  EXPECT_EQ(wide(table.box({-8, -8}, {16, 16}).z), uint64_t{512} * 65535);
}

/// The largest map that 24 bits hold, in kernels of up to three maps by three: what lies outside is so far
/// behind the receiver that squares over all of it exceed 64 bits.
TEST(SummedAreaTable, KernelsWiderThanTheLargestMapDoNotOverflow) {
  constexpr int side = 256;
  const uint format = sat_format(24, 2, 1);
  ASSERT_EQ(sat_largest_box(format), uint{side * side});
  const auto z = randomDepths(size_t{side} * side, 0.25f, 0.2f, 1);
  const Table table(format, side, side, z);
  for (const auto& [lo, hi] : {std::pair(vec2(-256), vec2(512)),
                               {vec2(-100.3f, 7), vec2(300, 480.6f)},
                               {vec2(20, -250.5f), vec2(230.25f, 256)},
                               {vec2(-700), vec2(900)}}) {
    for (const float d : {0.05f, 0.3f, 0.9f}) {
      const vec2 m = table.moments(lo, hi, d);
      const dvec2 exact = momentsInDouble(table, z, lo, hi, d);
      EXPECT_NEAR(m.x, exact.x, 2e-5 * std::sqrt(exact.y)) << lo.x << ", depth " << d;
      EXPECT_NEAR(m.y, exact.y, 4e-5 * exact.y) << lo.x << ", depth " << d;
    }
  }
}

TEST(SummedAreaTable, OfAConstantMapTheVarianceIsZero) {
  for (const float z : {0.25f, 0.3f, 0.9999f}) {
    const Table table(sat_format(16, 2, 1), 64, 64, std::vector<float>(64 * 64, z));
    const float quantised = static_cast<float>(sat_quantise(z, table.format)) / 65535.f;
    for (const float d : {quantised, quantised + 3e-6f, quantised + 1e-3f, 1.f}) {
      const vec2 m = table.moments({3.25f, 4.5f}, {40.125f, 60.75f}, d);
      EXPECT_NEAR(m.x, d - quantised, 1.3e-7);
      EXPECT_NEAR(m.y, m.x * m.x, 4e-7 * m.y + 1e-14);
    }
  }
}

TEST(SummedAreaTable, RoundedSquaresLeaveNoNegativeVarianceAndLittleOfIt) {
  const uint format = sat_format(16, 1, 1);
  for (uint z = 1; z <= sat_scale(format); z += 977) {
    const float depth = static_cast<float>(z) / 65535.f;
    const Table table(format, 8, 8, std::vector<float>(64, depth));
    for (const float behind : {0.f, 0.4f, 1.f, 2.f, 50.3f, 180.f, 3000.f}) {
      const vec2 m = table.moments({1, 1}, {7, 6.5f}, depth + behind / 65535.f);
      // A square is off by up to half of a quantum.
      ASSERT_GE(m.y, m.x * m.x * (1 - 1e-5f) - 1e-14f) << z << " quanta, " << behind << " behind";
      ASSERT_LE(m.y, m.x * m.x * (1 + 1e-5f) + 0.5001f / 65535.f) << z << " quanta, " << behind << " behind";
    }
  }
}

}  // namespace
}  // namespace limn
