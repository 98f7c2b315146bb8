// Samples of the glossy lobe and the levels that they look up against the BRDF itself, its reflectance and
// integrals.
#include "glsl/surface/lobe_samples.glsl"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "glsl/light/ltc.glsl"
#include "glsl/light/radiance_levels.glsl"

namespace limn::glsl {
namespace {

vec3 viewOf(float cosine) {
  return {std::sqrt(1 - cosine * cosine), 0, cosine};
}

LobeSample sampleOf(float alpha, const vec3& v, int i, int count) {
  return lobe_sample(alpha, v, vec2(lobe_point(i, count)), count);
}

/// A white mirror of facets: f0 = f90 = 1.
SurfaceBrdf whiteLobe(float alpha) {
  SurfaceBrdf s{};
  s.alpha = alpha;
  s.f0 = vec3(1);
  s.f90 = 1;
  return s;
}

TEST(LobeSamples, WeightTimesDensityIsTheResponse) {
  constexpr int kCount = 64;
  for (const float alpha : {0.02f, 0.1f, 0.4f, 1.f}) {
    for (const float cosine : {0.05f, 0.3f, 0.7f, 1.f}) {
      for (int i = 0; i < kCount; ++i) {
        const LobeSample s = sampleOf(alpha, viewOf(cosine), i, kCount);
        EXPECT_NEAR(length(s.direction), 1, 1e-5f);
        if (s.spread >= 4 * pi * 0.999f || s.weight <= 0) continue;
        const float response =
            brdf_parts(whiteLobe(alpha), vec3(0, 0, 1), viewOf(cosine), s.direction).specular.x *
            s.direction.z;
        EXPECT_NEAR(s.weight / (kCount * s.spread), response, 2e-3f * response) << alpha << ' ' << cosine;
      }
    }
  }
}

/// The table of reflectances has an error of its own (tests/unit/glsl/ltc_test.cpp).
TEST(LobeSamples, WeightsAddUpToTheReflectance) {
  constexpr int kCount = 4096;
  for (const float alpha : {brdf_min_alpha, 0.1f, 0.4f, 1.f}) {
    for (const float cosine : {0.1f, 0.5f, 1.f}) {
      double facing = 0, grazing = 0;
      for (int i = 0; i < kCount; ++i) {
        const LobeSample s = sampleOf(alpha, viewOf(cosine), i, kCount);
        ASSERT_GE(s.weight, 0);
        ASSERT_LE(s.weight, 1);
        facing += s.weight * (1 - s.schlick);
        grazing += s.weight * s.schlick;
      }
      const LtcTerms terms = ltc_lookup(cosine, alpha);
      EXPECT_NEAR(facing / kCount, terms.reflectance.x, 5e-3) << alpha << ' ' << cosine;
      EXPECT_NEAR(grazing / kCount, terms.reflectance.y, 5e-3) << alpha << ' ' << cosine;
    }
  }
}

/// Light that is linear in the direction: the mean over few samples is that over many.
TEST(LobeSamples, FewSamplesHaveTheMeanDirectionOfMany) {
  const auto meanDirection = [](float alpha, const vec3& v, int count) {
    vec3 sum(0);
    float weights = 0;
    for (int i = 0; i < count; ++i) {
      const LobeSample s = sampleOf(alpha, v, i, count);
      sum += s.weight * s.direction;
      weights += s.weight;
    }
    return sum / weights;
  };
  for (const float alpha : {brdf_min_alpha, 0.1f, 0.4f, 1.f})
    for (const float cosine : {0.1f, 0.5f, 1.f})
      EXPECT_LT(length(meanDirection(alpha, viewOf(cosine), 32) - meanDirection(alpha, viewOf(cosine), 8192)),
                0.03f)
          << alpha << ' ' << cosine;
}

/// Shading normals may turn away from the viewer, also along the view itself.
TEST(LobeSamples, ViewsBelowTheHorizonHaveFiniteSamples) {
  for (const vec3 v : {vec3(1, 0, 0), viewOf(-0.3f), vec3(0, 0, -1)}) {
    for (const float alpha : {brdf_min_alpha, 1.f}) {
      for (int i = 0; i < 32; ++i) {
        const LobeSample s = sampleOf(alpha, v, i, 32);
        EXPECT_TRUE(std::isfinite(dot(s.direction, vec3(1)))) << v.z << ' ' << alpha;
        EXPECT_TRUE(s.weight >= 0 && s.weight <= 1);
        EXPECT_TRUE(s.spread > 0 && s.spread <= 4 * pi * 1.001f);
      }
    }
  }
}

TEST(LobeSamples, PointsAreEven) {
  constexpr int kCount = 32;
  vec3 sum(0);
  for (int i = 0; i < kCount; ++i) {
    const vec3 u = lobe_point(i, kCount);
    for (int c = 0; c < 3; ++c) ASSERT_TRUE(u[c] >= 0 && u[c] < 1);
    sum += u;
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / kCount, 0.5f, 0.02f);
}

TEST(RadianceLevels, ATexelOfTheLevelCoversTheSpread) {
  constexpr int kWidth = 1024, kHeight = 512;
  for (int level = 0; level < 6; ++level) {
    const int rows = kHeight >> level;
    for (int y = rows / 8; y < rows - rows / 8; ++y) {
      const float spread = equirectangular_pixel_solid_angle(y, kWidth >> level, rows);
      const vec3 d =
          equirectangular_direction({0.3f, (static_cast<float>(y) + 0.5f) / static_cast<float>(rows)});
      EXPECT_NEAR(radiance_level(d, spread, {kWidth, kHeight}), level, 0.01f) << y;
    }
  }
}

/// Next to a pole texels are small, but a disc around it reaches those that are not.
TEST(RadianceLevels, PolesHaveTheLevelOfWhatIsAroundThem) {
  const ivec2 size(1024, 512);
  for (const float spread : {1e-3f, 1e-2f, 0.1f}) {
    const float pole = radiance_level({0, 1, 0}, spread, size),
                equator = radiance_level({1, 0, 0}, spread, size);
    const float rim = std::sqrt(spread / pi);
    EXPECT_NEAR(pole, equator - 0.5f * std::log2(2 * rim / 3), 0.01f);
    EXPECT_LT(pole, 10);
  }
}

TEST(RadianceLevels, LevelsStayInRange) {
  for (const ivec2 size : {ivec2(1, 1), ivec2(2, 1), ivec2(4096, 2048), ivec2(16384, 8192)}) {
    for (const float spread : {1e-30f, 1e-12f, 1e-6f, 1.f, 4 * pi}) {
      for (const vec3 d : {vec3(0, 1, 0), vec3(0, -1, 0), vec3(1, 0, 0), normalize(vec3(1e-5f, 1, 0))}) {
        const float level = radiance_level(d, spread, size);
        EXPECT_GE(level, 0);
        EXPECT_LE(level, std::log2(static_cast<float>(size.x)) + 2);
      }
    }
  }
}

/// From the narrowest peak, the density of which is 3e5 / sr, to a few samples of the widest lobe.
TEST(RadianceLevels, LobesOfAllWidthsHaveLevelsInRange) {
  for (const float alpha : {brdf_min_alpha, 0.01f, 0.1f, 1.f}) {
    for (const float cosine : {1e-4f, 0.5f, 1.f}) {
      for (const int count : {1, 32, 1024}) {
        for (int i = 0; i < count; ++i) {
          const LobeSample s = sampleOf(alpha, viewOf(cosine), i, count);
          const float level = radiance_level(s.direction, s.spread, {2048, 1024});
          ASSERT_TRUE(level >= 0 && level < 13) << alpha << ' ' << cosine << ' ' << level;
        }
      }
    }
  }
}

}  // namespace
}  // namespace limn::glsl
