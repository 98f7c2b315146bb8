// The tone curves: published values and laws.
#include "glsl/numeric/tone_curve.glsl"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace limn {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kCurves[] = {glsl::tone_curve_none, glsl::tone_curve_neutral, glsl::tone_curve_agx};

TEST(ToneCurve, NoneIsExposureClampAndSrgbToTheBit) {
  for (int i = -10; i <= 200; ++i)
    for (const float ev : {-2.5f, 0.0f, 1.0f}) {
      const glm::vec3 colour = glm::vec3(0.01f, 0.007f, 0.02f) * static_cast<float>(i);
      EXPECT_EQ(glsl::tone_map(colour, ev, glsl::tone_curve_none), glsl::tone_map(colour, ev));
    }
}

/// Whatever arrives, codes are in [0, 1]; NaN and negative light are 0.
TEST(ToneCurve, AcceptsAnything) {
  for (const std::uint32_t curve : kCurves) {
    for (const float v :
         {-kInfinity, -1.0f, 0.0f, 1e-30f, 0.04f, 0.18f, 1.0f, 1e4f, 1e30f, kInfinity, std::nanf("")})
      for (const float w : {0.0f, 0.5f, 1e6f})
        for (const float ev : {-60.0f, 0.0f, 60.0f}) {
          const glm::vec3 codes = glsl::tone_map(glm::vec3(v, w, 0.1f), ev, curve);
          for (int c = 0; c < 3; ++c)
            EXPECT_TRUE(codes[c] >= 0.0f && codes[c] <= 1.0f) << curve << ' ' << v << ' ' << w;
        }
    EXPECT_EQ(glsl::tone_map(glm::vec3(std::nanf("")), 0.0f, curve),
              glsl::tone_map(glm::vec3(0.0f), 0.0f, curve));
    EXPECT_EQ(glsl::tone_map(glm::vec3(-1.0f), 0.0f, curve), glsl::tone_map(glm::vec3(0.0f), 0.0f, curve));
    EXPECT_NEAR(glsl::tone_map(glm::vec3(0.0f), 0.0f, curve).x, 0.0f, 1e-4f);
    EXPECT_GT(glsl::tone_map(glm::vec3(1e9f), 0.0f, curve).x, 0.999f);
  }
}

TEST(ToneCurve, GreyStaysGreyAndRises) {
  for (const std::uint32_t curve : {glsl::tone_curve_neutral, glsl::tone_curve_agx}) {
    float last = -1;
    for (int i = -200; i <= 60; ++i) {  // 2^-10 to 2^3
      const glm::vec3 codes =
          glsl::tone_map(glm::vec3(std::exp2(0.05f * static_cast<float>(i))), 0.0f, curve);
      EXPECT_NEAR(codes.x, codes.y, 2e-6f);
      EXPECT_NEAR(codes.x, codes.z, 2e-6f);
      EXPECT_GT(codes.x, last) << curve << ' ' << i;
      last = codes.x;
    }
  }
}

TEST(NeutralCurve, LeavesBaseColoursAloneButForTheToe) {
  // Diffuse light of base colour c in white light of 1 is c + 0.04, with what a dielectric mirrors of it.
  for (const glm::vec3 base :
       {glm::vec3(0.04f), glm::vec3(0.2f, 0.5f, 0.04f), glm::vec3(0.75f, 0.1f, 0.3f)}) {
    const glm::vec3 shown = glsl::neutral_curve(base + 0.04f);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], base[c], 1e-6f);
  }
  // The toe: x - (x - 6.25 x^2) below 0.08.
  EXPECT_NEAR(glsl::neutral_curve(glm::vec3(0.04f)).x, 6.25f * 0.04f * 0.04f, 1e-7f);
}

TEST(NeutralCurve, CompressesWhatIsBright) {
  // Above the knee at 0.76: 1 - 0.24^2 / (peak + 0.24 - 0.76).
  EXPECT_NEAR(glsl::neutral_curve(glm::vec3(1.04f)).x, 1 - 0.24f * 0.24f / (1 + 0.24f - 0.76f), 1e-6f);
  EXPECT_NEAR(glsl::neutral_curve(glm::vec3(0.8f)).x, 0.76f, 1e-6f) << "continuous";
  // A bright colour turns towards white and keeps its order of channels.
  const glm::vec3 red = glsl::neutral_curve(glm::vec3(20, 1, 0.1f)),
                  bright = glsl::neutral_curve(glm::vec3(200, 10, 1));
  EXPECT_GT(red.x, red.y);
  EXPECT_GT(red.y, red.z);
  EXPECT_GT(bright.z, red.z);
}

TEST(AgxCurve, MeetsItsFixedPoints) {
  EXPECT_NEAR(glsl::agx_sigmoid(glsl::agx_pivot), 0.5f, 1e-6f);
  EXPECT_NEAR(glsl::agx_sigmoid(0.0f), 0.0f, 1e-4f);
  EXPECT_NEAR(glsl::agx_sigmoid(1.0f), 1.0f, 1e-4f);
  const float h = 1e-3f;
  EXPECT_NEAR((glsl::agx_sigmoid(glsl::agx_pivot + h) - glsl::agx_sigmoid(glsl::agx_pivot - h)) / (2 * h),
              2.0f, 1e-3f);
  // Middle grey is the middle of the codes.
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(glsl::agx_codes(glm::vec3(0.18f))[c], 0.5f, 1e-5f);
}

/// The polynomial that is published as an approximation (Wrensch 2023, who gives a mean square error of
/// 3.7e-6; against the sigmoid here it is 7.1e-6).
TEST(AgxCurve, IsWhatThePublishedPolynomialApproximates) {
  double squares = 0;
  const int n = 1000;
  for (int i = 0; i <= n; ++i) {
    const double x = static_cast<double>(i) / n, x2 = x * x, x4 = x2 * x2;
    const double polynomial =
        15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
    const double error = static_cast<double>(glsl::agx_sigmoid(static_cast<float>(x))) - polynomial;
    squares += error * error / n;
  }
  EXPECT_NEAR(squares, 7.1e-6, 0.1e-6);
}

}  // namespace
}  // namespace limn
