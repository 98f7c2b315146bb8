// The Fourier series of the shadow test: its constants, bounds and reconstructions.
#include "glsl/shadow/fourier_shadow.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/base/error.h"
#include "core/shadow/fourier_maps.h"

namespace limn::shadow {
namespace {

using glsl::vec2;
using glsl::vec4;

constexpr FourierWindow kWindows[] = {FourierWindow::none, FourierWindow::lanczos, FourierWindow::fejer};

/// Texels of some depths, filtered with some weights, and both reconstructions at the receiver's depth.
struct Reconstruction {
  float lit = 0.5f, blockedDepth = 0;

  /// scale > 0: basis values quantised to multiples of 1 / scale, and z times those stored.
  Reconstruction(const std::vector<vec2>& depthAndWeight, float receiver, int order, FourierWindow window,
                 float delta, float scale = 0) {
    for (const vec2& t : depthAndWeight) blockedDepth += 0.5f * t.x * t.y;
    for (int k = 1; k <= order; k += 2) {
      vec4 basis(0), depthBasis(0);
      for (const vec2& t : depthAndWeight) {
        vec4 b = glsl::fourier_basis(glsl::fourier_phase(k, t.x), glsl::fourier_phase(k + 1, t.x));
        if (scale > 0) b = glm::round(b * scale) / scale;
        basis += t.y * b;
        depthBasis += t.y * t.x * b;
      }
      const vec2 phase = glsl::fourier_phase(k, receiver - delta),
                 next = glsl::fourier_phase(k + 1, receiver - delta);
      const auto kind = static_cast<glsl::uint>(window);
      const vec2 weights(glsl::fourier_weight(k, order, kind), glsl::fourier_weight(k + 1, order, kind));
      lit += glsl::fourier_terms(basis, phase, next, weights);
      blockedDepth -= glsl::fourier_terms(depthBasis, phase, next, weights);
    }
  }
};

TEST(FourierShadow, ConstantsAreThoseOfTheTable) {
  struct Row {
    int order;
    double overshoot, dip, gain, delta, range;
  };
  for (const Row& row :
       {Row{1, 0.1366, 1, 1, 0.2875, 0.425}, Row{2, 0.1002, 0.9244, 1.1781, 0.1507, 0.699},
        Row{3, 0.0942, 0.9411, 1.1336, 0.1014, 0.797}, Row{4, 0.0921, 0.9459, 1.1214, 0.0763, 0.847},
        Row{8, 0.0901, 0.9501, 1.1109, 0.0383, 0.923}, Row{16, 0.0897, 0.9511, 1.1084, 0.0192, 0.962},
        Row{64, 0.0895, 0.9514, 1.1077, 0.3066 / 64, 1 - 2 * 0.3066 / 64}}) {
    const FourierConstants c = fourierConstants(row.order, FourierWindow::none);
    EXPECT_NEAR(c.overshoot, row.overshoot, 1e-4) << row.order;
    EXPECT_NEAR(c.dip, row.dip, 1e-4) << row.order;
    EXPECT_NEAR(c.gain, row.gain, 2e-4) << row.order;
    EXPECT_NEAR(c.delta, row.delta, 6e-5) << row.order;
    EXPECT_NEAR(c.range, row.range, 6e-4) << row.order;
    EXPECT_NEAR(c.valley, row.order == 1 ? c.delta : 1.0 / row.order, 3e-3) << row.order;
  }
  const FourierConstants lanczos = fourierConstants(4, FourierWindow::lanczos);
  EXPECT_NEAR(lanczos.overshoot, 0.011, 1e-3);
  EXPECT_NEAR(lanczos.dip, 0.996, 1e-3);
  EXPECT_THROW(fourierConstants(0, FourierWindow::none), UsageError);
  EXPECT_THROW(fourierConstants(65, FourierWindow::none), UsageError);
}

TEST(FourierShadow, SeriesStaysWithinItsBoundsForEveryOrderAndWindow) {
  for (const FourierWindow window : kWindows) {
    for (int order = 1; order <= 64; ++order) {
      const FourierConstants c = fourierConstants(order, window);
      ASSERT_GT(c.range, 0.3) << order;
      for (int i = 0; i <= 2000; ++i) {
        // At or behind the receiver, up to the far end: lit. 2 delta before it, down to depth 0: the
        // complement.
        const double lit = fourierSeries(c.delta + c.range * i / 2000, order, window);
        ASSERT_GE(lit, c.dip - 1e-6) << order;
        ASSERT_LE(lit, 1 + c.overshoot + 1e-6) << order;
        const float v = glsl::fourier_visibility(static_cast<float>(lit), static_cast<float>(c.gain));
        ASSERT_GE(v, 1 - 2e-6f);
        ASSERT_LE(fourierSeries(-c.delta - (1 - 2 * c.delta) * i / 2000, order, window), 1 - c.dip + 1e-6);
        if (window == FourierWindow::fejer) {
          ASSERT_LE(lit, 1);
        }
      }
    }
  }
}

TEST(FourierShadow, LitPlanesWithinTheToleranceStayAboveTheDip) {
  for (const int order : {1, 2, 4, 16, 64}) {
    const FourierConstants c = fourierConstants(order, FourierWindow::none);
    ASSERT_GE(c.tolerance, 0);
    for (int i = 1; i <= 10; ++i) {
      const double half = c.tolerance * i / 10;
      double mean = 0;
      for (int j = 0; j < 1000; ++j)
        mean += fourierSeries(c.delta + half * (2 * (j + 0.5) / 1000 - 1), order, FourierWindow::none) / 1000;
      EXPECT_GE(mean, c.dip - 1e-5) << order;
      EXPECT_GE(mean, c.level - c.curvature * half * half - 1e-4 * (1 - c.dip)) << order;
    }
  }
}

TEST(FourierShadow, MeanBlockerDepthOfTwoPlanesIsExactAtAnyShare) {
  for (int order = 1; order <= 64; ++order) {
    const FourierConstants c = fourierConstants(order, FourierWindow::none);
    const auto delta = static_cast<float>(c.delta), range = static_cast<float>(c.range);
    for (const float share : {0.01f, 0.1f, 0.5f, 0.99f, 1.f}) {
      for (const float receiver : {range, 0.7f * range, 0.3f * range}) {
        for (const float blocker : {0.f, 0.2f * range, receiver - 0.05f * range}) {
          const Reconstruction r({{blocker, share}, {receiver, 1 - share}}, receiver, order,
                                 FourierWindow::none, delta);
          ASSERT_NEAR(r.blockedDepth / (1 - r.lit), blocker, 3e-4f / share)
              << order << " share " << share << " d " << receiver << " z " << blocker;
        }
      }
    }
  }
}

TEST(FourierShadow, NormalisedVisibilityOfTwoPlanesIsExact) {
  const FourierConstants c = fourierConstants(4, FourierWindow::none);
  for (const float gap : {0.02f, 0.05f, 0.1f, 0.3f}) {
    const auto blocked = static_cast<float>(fourierSeries(c.delta - gap, 4, FourierWindow::none));
    for (const float share : {0.f, 0.25f, 0.75f, 1.f}) {
      const float v = 1 - share * (1 - blocked);
      EXPECT_NEAR(glsl::fourier_normalised(glsl::fourier_visibility(v, 1),
                                           glsl::fourier_visibility(blocked, 1), 0.02f),
                  1 - share, 1e-5f);
    }
  }
  // Where the series of what blocks is above 1, V is limited to 0 before it is normalised.
  const auto above = static_cast<float>(fourierSeries(c.delta - 0.2, 4, FourierWindow::none));
  ASSERT_LT(above, -0.09f);
  for (const float share : {0.f, 0.25f, 0.75f, 1.f}) {
    const float v = glsl::fourier_normalised(glsl::fourier_visibility(1 - share * (1 - above), 1),
                                             glsl::fourier_visibility(above, 1), 0.02f);
    EXPECT_NEAR(v, 1 - share, c.overshoot) << share;
  }
}

TEST(FourierShadow, RandomKernelsGiveFiniteVisibilityWithinBounds) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  for (const FourierWindow window : kWindows) {
    for (const int order : {1, 3, 4, 31, 64}) {
      const FourierConstants c = fourierConstants(order, window);
      const auto range = static_cast<float>(c.range);
      for (int i = 0; i < 200; ++i) {
        std::vector<vec2> texels(8);
        for (vec2& t : texels) t = {range * std::clamp(1.4f * unit(random) - 0.2f, 0.f, 1.f), 0.125f};
        const float d = range * std::clamp(1.4f * unit(random) - 0.2f, 0.f, 1.f);
        const Reconstruction r(texels, d, order, window, static_cast<float>(c.delta));
        const float v = glsl::fourier_visibility(r.lit, static_cast<float>(c.gain));
        ASSERT_TRUE(v >= 0 && v <= 1);
        ASSERT_TRUE(std::isfinite(r.blockedDepth));
        if (window == FourierWindow::fejer) {
          // Its series lies within [0, 1], so that the mean depth of what blocks lies between those of the
          // texels, but for the rounding of sums, over 1 - s, which is at least 0.0025 with 64 terms.
          const auto [nearest, farthest] =
              std::ranges::minmax(texels, {}, [](const vec2& texel) { return texel.x; });
          const float depth = r.blockedDepth / (1 - r.lit), rounding = 3e-6f / (1 - r.lit);
          ASSERT_LE(r.lit, 1) << order;
          ASSERT_GE(depth, nearest.x - rounding) << order << " terms, d " << d << ", 1 - s " << 1 - r.lit;
          ASSERT_LE(depth, farthest.x + rounding) << order << " terms, d " << d << ", 1 - s " << 1 - r.lit;
        }
        const float p = std::pow(v, glsl::fourier_sharpening(d, 30, 20));
        ASSERT_TRUE(p >= 0 && p <= v);
        for (const float response : {0.f, 0.5f, 1.f}) {
          const float n = glsl::fourier_normalised(v, response, 0.02f);
          ASSERT_TRUE(n >= 0 && n <= 1);
        }
      }
    }
  }
}

TEST(FourierShadow, QuantisationStaysWithinItsBound) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(0, 1);
  for (const int order : {1, 4, 16, 64}) {
    const double bound = fourierNoise(order, FourierWindow::none, 127);
    if (order == 4) {
      EXPECT_NEAR(bound, 0.006, 1e-3);
    }
    for (int i = 0; i < 3000; ++i) {
      const float z = unit(random), d = unit(random);
      const Reconstruction exact({{z, 1}}, d, order, FourierWindow::none, 0),
          quantised({{z, 1}}, d, order, FourierWindow::none, 0, 127);
      ASSERT_LE(std::abs(exact.lit - quantised.lit), bound + 1e-5);
      // The same series in both: a single blocker's depth survives the quantisation.
      if (1 - quantised.lit > 0.05f) {
        ASSERT_NEAR(quantised.blockedDepth / (1 - quantised.lit), z, 1e-3f);
      }
    }
  }
}

TEST(FourierShadow, MipLevelHasTheSecondMomentOfTheBox) {
  EXPECT_EQ(glsl::fourier_lod(0), 0);
  EXPECT_EQ(glsl::fourier_lod(1.7f), 0);
  for (float width = 1.74f; width < 4000; width *= 1.1f) {
    const float lod = glsl::fourier_lod(width), level = std::floor(lod);
    // Variance of a bilinear fetch at level k over all phases: that of a texel, 4^k / 12, and of the weights,
    // 4^k / 6.
    const auto variance = [](float k) { return std::exp2(2 * k) / 4; };
    const float mixed = (1 - (lod - level)) * variance(level) + (lod - level) * variance(level + 1);
    ASSERT_NEAR(mixed, width * width / 12, 2e-3f * width * width) << width;
  }
}

TEST(FourierShadow, SumsOfWholeMapsFitTheirWords) {
  for (const int64_t side : {1, 2, 16, 100, 512, 1000, 1024, 2048, 4096, 8192}) {
    const int64_t texels = side * side, scale = glsl::fourier_sum_scale(static_cast<int>(texels));
    EXPECT_GE(scale, 1);
    EXPECT_LT(texels * scale, int64_t{1} << 31) << side;
  }
  EXPECT_EQ(glsl::fourier_sum_bits(1024 * 1024), 12);
}

TEST(FourierShadow, DepthsOfARangeGoThereAndBack) {
  const glsl::FourierRange range{0.3f, 0.2f, -0.1f, 3.f};
  for (const float stored : {0.f, 0.4f, 1.f}) {
    const vec2 uv(0.8f, 0.1f);
    EXPECT_NEAR(glsl::fourier_stored(range, uv, glsl::fourier_depth(range, uv, stored)), stored, 1e-6f);
  }
  EXPECT_EQ(glsl::fourier_texel_depth(range, vec2(0.5f), 1.f, 0.8f), 0.8f)
      << "nothing there: as far as can be";
  EXPECT_EQ(glsl::fourier_texel_depth(range, vec2(0.5f), 0.f, 0.8f), 0.f);
}

}  // namespace
}  // namespace limn::shadow
