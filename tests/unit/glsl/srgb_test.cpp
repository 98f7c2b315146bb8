#include "glsl/numeric/srgb.glsl"

#include <gtest/gtest.h>

#include <cmath>

namespace limn {
namespace {

TEST(Srgb, MeetsItsFixedPoints) {
  EXPECT_EQ(glsl::srgb_encode(0.0f), 0.0f);
  EXPECT_NEAR(glsl::srgb_encode(1.0f), 1.0f, 1e-6f);
  EXPECT_NEAR(glsl::srgb_encode(0.5f), 0.735357f, 1e-6f);
  EXPECT_NEAR(glsl::srgb_encode(0.18f), 0.461356f, 1e-6f);
  EXPECT_NEAR(glsl::srgb_encode(0.002f), 0.02584f, 1e-6f);
}

TEST(Srgb, IsContinuousAtItsKnees) {
  EXPECT_NEAR(glsl::srgb_encode(0.0031308f), glsl::srgb_encode(0.0031309f), 2e-6f);
  EXPECT_NEAR(glsl::srgb_decode(0.04045f), glsl::srgb_decode(0.04046f), 2e-6f);
}

TEST(Srgb, InvertsItself) {
  for (int i = 0; i <= 1000; ++i) {
    const float value = static_cast<float>(i) / 1000.0f;
    EXPECT_NEAR(glsl::srgb_decode(glsl::srgb_encode(value)), value, 2e-6f);
    EXPECT_NEAR(glsl::srgb_encode(glsl::srgb_decode(value)), value, 2e-6f);
  }
}

TEST(Srgb, RisesEverywhere) {
  float last = -1.0f;
  for (int i = 0; i <= 10000; ++i) {
    const float encoded = glsl::srgb_encode(static_cast<float>(i) / 10000.0f);
    EXPECT_GT(encoded, last);
    last = encoded;
  }
}

TEST(ToneMap, ExposesThenClamps) {
  EXPECT_EQ(glsl::tone_map(-3.0f, 0.0f), 0.0f);
  EXPECT_EQ(glsl::tone_map(std::nanf(""), 0.0f), 0.0f);
  EXPECT_EQ(glsl::tone_map(INFINITY, -10.0f), glsl::srgb_encode(1.0f));
  EXPECT_EQ(glsl::tone_map(7.0f, 0.0f), glsl::srgb_encode(1.0f));
  for (const float ev : {-8.0f, -1.0f, 0.0f, 3.0f}) {
    EXPECT_NEAR(glsl::tone_map(0.25f * std::exp2(-ev), ev), glsl::srgb_encode(0.25f), 1e-6f);
  }
  const glm::vec3 colour = glsl::tone_map(glm::vec3(0.0f, 0.5f, 9.0f), 0.0f);
  EXPECT_EQ(colour.x, 0.0f);
  EXPECT_NEAR(colour.y, 0.735357f, 1e-6f);
  EXPECT_NEAR(colour.z, 1.0f, 1e-6f);
}

TEST(Luminance, WeightsSumToOne) {
  EXPECT_NEAR(glsl::luminance(glm::vec3(1.0f)), 1.0f, 1e-6f);
}

}  // namespace
}  // namespace limn
