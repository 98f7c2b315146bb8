// Filtered environments against closed forms, integration, and irradiance maps made by others.
#include "core/shading/environment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <random>

#include "core/base/error.h"
#include "core/image/image.h"
#include "glsl/light/environment.glsl"
#include "tests/support/environment_maps.h"

namespace limn::shading {
namespace {

using glm::dvec3;
using glm::vec2;
using glm::vec3;
using glsl::pi;
using test::environmentOf;

vec3 randomDirection(std::mt19937& random) {
  std::normal_distribution<float> normal;
  return normalize(vec3(normal(random), normal(random), normal(random)));
}

TEST(Environment, UniformRadianceStaysUniform) {
  const FilteredEnvironment f = filterEnvironment(environmentOf(64, [](vec3) { return vec3(2, 3, 4); }));
  ASSERT_EQ(f.radiance.size(), static_cast<size_t>(glsl::environment_levels));
  for (const vec3& e : f.irradiance.texels) ASSERT_NEAR(e.x, 2 * pi, 2 * pi * 5e-4);
  for (const FilteredMap& level : f.radiance) {
    for (const vec3& l : level.texels) ASSERT_NEAR(l.y, 3, 1e-4);
  }
}

/// The sum of a map's light, by exact solid angles.
dvec3 totalLight(int width, int height, const std::vector<vec3>& texels) {
  dvec3 sum(0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      sum += double(glsl::equirectangular_pixel_solid_angle(y, width, height)) *
             dvec3(texels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)]);
  return sum;
}

scene::Environment noise(int width, int height) {
  scene::Environment e;
  e.width = width;
  e.height = height;
  std::mt19937 random(3);
  std::exponential_distribution<float> radiance(1);
  for (int i = 0; i < width * height; ++i)
    e.texels.emplace_back(radiance(random), radiance(random), radiance(random));
  return e;
}

TEST(RadianceLevels, EveryLevelHoldsTheLightOfTheMap) {
  for (const glm::ivec2 size : {glm::ivec2(64, 32), glm::ivec2(50, 25), glm::ivec2(7, 1), glm::ivec2(1, 9)}) {
    const scene::Environment e = noise(size.x, size.y);
    const dvec3 expected = totalLight(e.width, e.height, e.texels);
    int width = e.width, height = e.height;
    for (const FilteredMap& level : radianceLevels(e)) {
      width = std::max(width / 2, 1);
      height = std::max(height / 2, 1);
      ASSERT_EQ(level.width, width);
      ASSERT_EQ(level.height, height);
      const dvec3 light = totalLight(level.width, level.height, level.texels);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[c], expected[c], 1e-5 * expected[c]) << width;
    }
    EXPECT_EQ(width * height, 1);
  }
}

TEST(RadianceLevels, NeedAMap) {
  EXPECT_THROW(radianceLevels({}), Error);
  EXPECT_TRUE(radianceLevels(noise(1, 1)).empty());
}

/// A single bright row among 512, whichever it is: none is skipped where a picture is narrow.
TEST(Environment, NarrowPicturesGiveTheLightOfWideOnes) {
  const auto irradianceOf = [](int width, int bright) {
    scene::Environment e;
    e.width = width;
    e.height = 512;
    e.texels.assign(static_cast<size_t>(width) * 512, vec3(0));
    const auto first = e.texels.begin() + ptrdiff_t{bright} * width;
    std::fill(first, first + width, vec3(100));
    return filterEnvironment(e).irradiance.texels;
  };
  for (const int bright : {199, 200, 202}) {
    const std::vector<vec3> narrow = irradianceOf(1, bright), wide = irradianceOf(1024, bright);
    for (size_t i = 0; i < wide.size(); ++i)
      ASSERT_NEAR(narrow[i].x, wide[i].x, 0.01f * wide[i].x + 1e-3f) << bright << ", " << i;
  }
}

/// A sun of one pixel, in each channel another one, in pictures whose pixels are no whole part of a texel.
/// Texels that are summed and looked up are at most 3 and 4 degrees from it: cosines take 0.4 % of it.
TEST(Environment, ASunOfOnePixelKeepsItsLightInPicturesOfAnySize) {
  constexpr glm::ivec2 kSuns[] = {{101, 76}, {103, 78}, {200, 30}};
  for (const glm::ivec2 size : {glm::ivec2(300, 150), glm::ivec2(333, 140), glm::ivec2(700, 350)}) {
    scene::Environment e;
    e.width = size.x;
    e.height = size.y;
    e.texels.assign(static_cast<size_t>(size.x) * static_cast<size_t>(size.y), vec3(0));
    for (int c = 0; c < 3; ++c) e.texels[static_cast<size_t>(kSuns[c].y * size.x + kSuns[c].x)][c] = 100;
    const FilteredEnvironment f = filterEnvironment(e);
    for (int c = 0; c < 3; ++c) {
      const vec3 towards = glsl::equirectangular_direction((vec2(kSuns[c]) + 0.5f) / vec2(size));
      const float facing = 100 * glsl::equirectangular_pixel_solid_angle(kSuns[c].y, size.x, size.y);
      EXPECT_NEAR(f.irradiance.sample(towards)[c] / facing, 1, 0.01) << size.x << ", channel " << c;
    }
  }
}

// L = 1 + d.a: the cosine convolution keeps the linear part by 2/3.
TEST(Environment, IrradianceOfALinearSkyIsTheClosedForm) {
  const vec3 a = normalize(vec3(0.3f, 0.8f, -0.5f));
  const FilteredEnvironment f =
      filterEnvironment(environmentOf(512, [&](vec3 d) { return vec3(1 + dot(d, a)); }));
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const vec3 n = randomDirection(random);
    const float expected = pi + 2 * pi / 3 * dot(n, a);
    ASSERT_NEAR(f.irradiance.sample(n).x, expected, 2e-3 * pi);
  }
}

// L = 1 + d.a: pi / 21 of the constant part, pi / 84 of the linear one. Sums over texels err where the kernel
// has its edge, at the horizon, which is that of irradiance: by the 3e-4 of pi that its map has.
TEST(Environment, GrazingIrradianceOfALinearSkyIsTheClosedForm) {
  const vec3 a = normalize(vec3(0.3f, 0.8f, -0.5f));
  const FilteredMap grazing = filterGrazing(environmentOf(512, [&](vec3 d) { return vec3(1 + dot(d, a)); }));
  EXPECT_EQ(grazing.width, glsl::environment_irradiance_width);
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const vec3 n = randomDirection(random);
    ASSERT_NEAR(grazing.sample(n).x, pi / 21 + pi / 84 * dot(n, a), 3e-4 * pi);
  }
}

TEST(Environment, HalfASkyGivesHalfTheIrradianceAtTheHorizon) {
  const FilteredEnvironment f =
      filterEnvironment(environmentOf(512, [](vec3 d) { return vec3(d.y > 0 ? 1 : 0); }));
  EXPECT_NEAR(f.irradiance.sample({0, 1, 0}).x, pi, 5e-3);
  EXPECT_NEAR(f.irradiance.sample({1, 0, 0}).x, pi / 2, 5e-3);
  EXPECT_NEAR(f.irradiance.sample({0.6f, 0.8f, 0}).x, pi / 2 * 1.8f, 5e-3);
  EXPECT_NEAR(f.irradiance.sample({0, -1, 0}).x, 0, 5e-3);
}

vec3 hilly(vec3 d) {
  return vec3(1 + d.x * d.y + 0.5f * std::sin(5 * d.z) * std::cos(4 * d.x), 1 + 0.8f * d.y, 1);
}

TEST(Environment, FilteredLevelsAreTheLobesMean) {
  const FilteredEnvironment f = filterEnvironment(environmentOf(512, hilly));
  std::mt19937 random(2);
  double worst = 0;
  for (int level = 0; level < glsl::environment_levels; ++level) {
    const float alpha = glsl::environment_alpha(static_cast<float>(level));
    for (int i = 0; i < 20; ++i) {
      const vec3 r = randomDirection(random);
      const glsl::Frame frame = glsl::frame_around(r);
      dvec3 sum(0);
      double total = 0;
      const int side = 200;
      for (int k = 0; k < side * side; ++k) {
        const vec2 u((static_cast<float>(k % side) + 0.5f) / side,
                     (static_cast<float>(k / side) + 0.5f) / side);
        const vec3 h = glsl::sample_visible_normal(vec3(0, 0, 1), glm::vec2(alpha), u);
        const vec3 l = 2 * h.z * h - vec3(0, 0, 1);
        if (l.z <= 0) continue;
        const double weight = glsl::ggx_visibility(1, l.z, alpha) * l.z;
        sum += weight * dvec3(hilly(glsl::from_local(frame, l)));
        total += weight;
      }
      const double error = std::abs(f.filtered(r, alpha).x - sum.x / total);
      worst = std::max(worst, error);
      EXPECT_LT(error, 0.02) << level;
    }
  }
  RecordProperty("worst", std::to_string(worst));
}

TEST(Environment, LevelsAndWidthsAreInverse) {
  for (int level = 0; level < glsl::environment_levels; ++level) {
    EXPECT_NEAR(glsl::environment_level(glsl::environment_alpha(static_cast<float>(level))), level, 1e-5);
  }
  EXPECT_EQ(glsl::environment_level(glsl::brdf_min_alpha), 0);
}

vec3 reflected(const FilteredEnvironment& f, const glsl::SurfaceBrdf& s, vec3 n, vec3 v) {
  const glsl::LtcTerms terms = glsl::ltc_lookup(dot(n, v), s.alpha);
  return glsl::reflected_whole(glsl::environment_reflection(
      s, terms, f.irradiance.sample(n),
      f.filtered(glsl::environment_lobe_direction(terms, n, v, s.alpha), s.alpha)));
}

dvec3 integrated(const glsl::SurfaceBrdf& s, vec3 n, vec3 v, const std::function<vec3(vec3)>& radiance) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.f, 1.f);
  dvec3 sum(0);
  const int count = 40000;
  for (int i = 0; i < count; ++i) {
    const vec3 l = glsl::brdf_sample(s, n, v, {unit(random), unit(random), unit(random)});
    const float pdf = glsl::brdf_pdf(s, n, v, l);
    if (pdf > 0) sum += dvec3(glsl::brdf(s, n, v, l) * radiance(l)) * static_cast<double>(dot(n, l) / pdf);
  }
  return sum / static_cast<double>(count);
}

TEST(Environment, UniformEnvironmentIsReflectedExactly) {
  const FilteredEnvironment f = filterEnvironment(environmentOf(64, [](vec3) { return vec3(1); }));
  const vec3 n = normalize(vec3(0.2f, 1, 0.3f));
  for (float roughness : {0.15f, 0.5f, 1.f}) {
    for (float cosine : {0.1f, 0.5f, 0.95f}) {
      const vec3 v = glsl::from_local(glsl::frame_around(n), vec3(std::sqrt(1 - cosine * cosine), 0, cosine));
      const glsl::SurfaceBrdf s = glsl::surface_brdf({0.8f, 0.5f, 0.2f}, 0.3f, roughness, 1, vec3(1), 1.5f);
      const dvec3 expected = integrated(s, n, v, [](vec3) { return vec3(1); });
      EXPECT_NEAR(reflected(f, s, n, v).x, expected.x, 0.01 * expected.x) << roughness << ' ' << cosine;
    }
  }
}

TEST(Environment, StructuredEnvironmentIsReflectedWithinTheStatedError) {
  const FilteredEnvironment f = filterEnvironment(environmentOf(512, hilly));
  std::mt19937 random(3);
  for (float metallic : {0.f, 1.f}) {
    double squares = 0, signal = 0;
    for (int i = 0; i < 60; ++i) {
      const vec3 n = randomDirection(random);
      const vec3 d = randomDirection(random);
      const vec3 v = dot(d, n) < 0 ? -d : d;
      const glsl::SurfaceBrdf s = glsl::surface_brdf(
          vec3(0.7f), metallic, 0.1f + 0.9f * static_cast<float>(i) / 60, 1, vec3(1), 1.5f);
      const double expected = integrated(s, n, v, hilly).x, error = reflected(f, s, n, v).x - expected;
      squares += error * error;
      signal += expected * expected;
    }
    const double relative = std::sqrt(squares / signal);
    RecordProperty(metallic > 0 ? "metal" : "dielectric", std::to_string(relative));
    EXPECT_LT(relative, metallic > 0 ? 0.08 : 0.03);
  }
}

TEST(Environment, WithoutAMapThereIsNothingToFilter) {
  EXPECT_THROW(filterEnvironment({}), Error);
  EXPECT_THROW(filterGrazing({}), Error);
  EXPECT_THROW(keptEnvironment({}), Error);
  EXPECT_THROW(keptGrazing({}), Error);
}

TEST(Environment, MapsThatHoldTheSameAreFilteredOnce) {
  const auto sky = [](float above) {
    return environmentOf(16, [above](vec3 d) { return vec3(d.y > 0 ? above : 1); });
  };
  const auto bright = keptEnvironment(sky(2));
  const auto grazing = keptGrazing(sky(2));
  EXPECT_EQ(keptEnvironment(sky(2)), bright);
  EXPECT_EQ(keptGrazing(sky(2)), grazing);
  EXPECT_NE(keptEnvironment(sky(3)), bright);
  EXPECT_NE(keptGrazing(sky(3)), grazing);
  EXPECT_EQ(keptEnvironment(sky(2)), bright) << "it is still there";
  EXPECT_TRUE(bright->irradiance.texels == filterEnvironment(sky(2)).irradiance.texels);
  EXPECT_TRUE(grazing->texels == filterGrazing(sky(2)).texels);
}

/// Mean and root mean square relative difference of the irradiance over pi from a map of it, over the sphere.
struct Difference {
  double mean = 0, rms = 0;
};

Difference compare(const std::filesystem::path& probe, const std::filesystem::path& irradiance, float scale) {
  const Image image = readImage(probe), expected = readImage(irradiance);
  const auto rgb = image.rgbChannels(), expectedRgb = expected.rgbChannels();
  scene::Environment e;
  e.width = image.width();
  e.height = image.height();
  for (int y = 0; y < e.height; ++y) {
    for (int x = 0; x < e.width; ++x) {
      e.texels.push_back(
          max(vec3(image.at(x, y, rgb[0]), image.at(x, y, rgb[1]), image.at(x, y, rgb[2])), vec3(0)));
    }
  }
  const FilteredEnvironment f = filterEnvironment(e);
  double sum = 0, squares = 0, signal = 0, signal2 = 0;
  for (int y = 0; y < expected.height(); ++y) {
    const double weight = glsl::equirectangular_pixel_solid_angle(y, expected.width(), expected.height());
    for (int x = 0; x < expected.width(); ++x) {
      const vec3 n = glsl::equirectangular_direction(
          vec2((static_cast<float>(x) + 0.5f) / static_cast<float>(expected.width()),
               (static_cast<float>(y) + 0.5f) / static_cast<float>(expected.height())));
      const vec3 ours = f.irradiance.sample(n) * scale / pi;
      for (int c = 0; c < 3; ++c) {
        const double theirs = expected.at(x, y, expectedRgb[static_cast<size_t>(c)]);
        const double error = static_cast<double>(ours[c]) - theirs;
        sum += weight * error;
        squares += weight * error * error;
        signal += weight * theirs;
        signal2 += weight * theirs * theirs;
      }
    }
  }
  return {sum / signal, std::sqrt(squares / signal2)};
}

TEST(Environment, AgreesWithIrradianceMapsOfRealProbes) {
  const char* models = std::getenv("LIMN_MODELS");
  if (models == nullptr) GTEST_SKIP() << "LIMN_MODELS names no folder with env/grace_1k.exr and others";
  const std::filesystem::path folder = std::filesystem::path(models) / "env";
  if (!std::filesystem::exists(folder / "grace_1k.exr")) GTEST_SKIP() << folder << " has no grace_1k.exr";
  for (const auto& [name, scale] : {std::pair{"grace", 63.8f}, std::pair{"eucalyptus", 0.99f}}) {
    const Difference d = compare(folder / (std::string(name) + "_1k.exr"),
                                 folder / (std::string(name) + "_irradiance_256.exr"), scale);
    RecordProperty(std::string(name) + "_rms", std::to_string(d.rms));
    EXPECT_LT(std::abs(d.mean), 0.003) << name;
    EXPECT_LT(d.rms, 0.006) << name;
  }
}

}  // namespace
}  // namespace limn::shading
