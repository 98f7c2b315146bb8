// Laws of the sample bits of bitmask soft shadows (glsl/shadow/coverage_mask.glsl).
#include "glsl/shadow/coverage_mask.glsl"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace limn::glsl {
namespace {

bool inside(const vec2& p, const vec2& low, const vec2& high) {
  return p.x >= low.x && p.x < high.x && p.y >= low.y && p.y < high.y;
}

TEST(CoverageMask, NoTwoSamplesShareARowOrAColumn) {
  for (const int words : {2, 4, 8}) {
    std::set<float> columns, rows;
    for (int i = 0; i < 32 * words; ++i) {
      const vec2 p = coverage_sample(i / 32, i % 32, words);
      EXPECT_TRUE(inside(p, vec2(0), vec2(1)));
      columns.insert(p.x);
      rows.insert(p.y);
    }
    EXPECT_EQ(columns.size(), size_t(32 * words));
    EXPECT_EQ(rows.size(), size_t(32 * words));
  }
}

TEST(CoverageMask, BitsAreTheSamplesInsideTheRectangle) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-0.3f, 1.3f);
  for (const int words : {2, 4, 8}) {
    for (int i = 0; i < 2000; ++i) {
      const vec2 a(uniform(random), uniform(random)), b(uniform(random), uniform(random));
      const vec2 low = min(a, b), high = max(a, b);
      const ivec4 ranks = coverage_ranks(low, high, words);
      for (int word = 0; word < words; ++word) {
        uint32_t expected = 0;
        for (int bit = 0; bit < 32; ++bit) {
          if (inside(coverage_sample(word, bit, words), low, high)) expected |= 1u << bit;
        }
        ASSERT_EQ(coverage_word(ranks, word, words), expected)
            << words << " words, word " << word << ": " << low.x << " " << low.y << " " << high.x << " "
            << high.y;
      }
    }
  }
}

TEST(CoverageMask, ExtremeRectangles) {
  for (const int words : {2, 4, 8}) {
    for (int word = 0; word < words; ++word) {
      EXPECT_EQ(coverage_word(coverage_ranks(vec2(0), vec2(1), words), word, words), 0xffffffffu);
      EXPECT_EQ(coverage_word(coverage_ranks(vec2(-3e38f), vec2(3e38f), words), word, words), 0xffffffffu);
      EXPECT_EQ(coverage_word(coverage_ranks(vec2(0.5f), vec2(0.5f), words), word, words), 0u);
      EXPECT_EQ(coverage_word(coverage_ranks(vec2(0.7f), vec2(0.2f), words), word, words), 0u) << "empty";
    }
  }
}

/// The share of samples in a rectangle is its area, to the discrepancy of the set.
TEST(CoverageMask, SamplesAreUniformInArea) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (const int words : {2, 4, 8}) {
    float worst = 0;
    for (int i = 0; i < 5000; ++i) {
      const vec2 a(uniform(random), uniform(random)), b(uniform(random), uniform(random));
      const vec2 low = min(a, b), high = max(a, b);
      int count = 0;
      for (int word = 0; word < words; ++word)
        count += bitCount(coverage_word(coverage_ranks(low, high, words), word, words));
      const vec2 size = high - low;
      worst = std::max(worst, std::abs(float(count) / float(32 * words) - size.x * size.y));
    }
    EXPECT_LT(worst, words == 2 ? 0.06f : words == 4 ? 0.035f : 0.02f) << words;
  }
}

}  // namespace
}  // namespace limn::glsl
