// Decomposed environments: laws that hold for every map, and the counts the thesis reports.
#include "core/shading/environment_decomposition.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <random>

#include "core/base/error.h"
#include "core/scene_io/load.h"
#include "glsl/light/rectangle_light.glsl"
#include "glsl/numeric/equirectangular.glsl"
#include "tests/support/environment_maps.h"

namespace limn::shading {
namespace {

using glm::dvec3;
using glm::vec2;
using glm::vec3;
using glsl::pi;
using test::environmentOf;

scene::Environment noisySky(int width, int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::lognormal_distribution<float> brightness(0, 3);
  return environmentOf(
      width, [&](vec3) { return vec3(brightness(random), brightness(random), brightness(random)); });
}

/// A sky, a ground, and a sun of one pixel.
scene::Environment sunnySky(int width) {
  scene::Environment e = environmentOf(width, [](vec3 d) {
    return d.y > 0 ? vec3(0.3f, 0.5f, 1.0f) * (1.2f - d.y) : vec3(0.1f, 0.09f, 0.08f);
  });
  e.texels[static_cast<size_t>(width / 8 * width + width / 3)] = vec3(1e5f, 9e4f, 7e4f);
  return e;
}

/// Radiance times solid angle, summed as the file has it.
dvec3 energyOf(const scene::Environment& e) {
  dvec3 sum(0);
  for (int y = 0; y < e.height; ++y) {
    const double top = std::cos(std::numbers::pi * y / e.height),
                 bottom = std::cos(std::numbers::pi * (y + 1) / e.height);
    for (int x = 0; x < e.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const float value = e.texels[static_cast<size_t>(y * e.width + x)][c];
        if (std::isfinite(value) && value > 0)
          sum[c] += 2 * std::numbers::pi / e.width * (top - bottom) * static_cast<double>(value);
      }
  }
  return sum;
}

dvec3 energyOf(const EnvironmentDecomposition& d) {
  dvec3 sum(0);
  for (const Region& region : d.regions) sum += region.energy;
  return sum;
}

void expectSameEnergy(const scene::Environment& e, const EnvironmentDecomposition& d) {
  const dvec3 expected = energyOf(e), found = energyOf(d);
  dvec3 lights(0);
  for (const scene::DistantRectangle& light : d.lights) lights += dvec3(light.irradiance);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(found[c], expected[c], 1e-6 * expected[c]);
    EXPECT_NEAR(lights[c], expected[c], 1e-6 * expected[c]);
  }
}

TEST(EnvironmentDecomposition, SolidAnglesOfAFaceSumToASixthOfTheSphere) {
  for (const int n : {1, 64, 1024}) {
    double sum = 0, worst = 0;
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const double a = 2.0 * x / n - 1, b = 2.0 * y / n - 1, side = 2.0 / n;
        const double exact = faceSolidAngle(a, b, a + side, b + side);
        const double middle = 1 + (a + side / 2) * (a + side / 2) + (b + side / 2) * (b + side / 2);
        worst = std::max(worst, std::abs(side * side / (middle * std::sqrt(middle)) / exact - 1));
        sum += exact;
      }
    }
    EXPECT_NEAR(sum, 4 * std::numbers::pi / 6, 1e-12);
    if (n >= 64) {
      EXPECT_LT(worst, n == 64 ? 2.5e-4 : 1e-6) << "the midpoint rule agrees";
    }
  }
}

TEST(EnvironmentDecomposition, CubeMapsKeepTheEnergyOfTheMapAndItsPlaces) {
  for (const int width : {60, 256, 1024}) {
    const scene::Environment e = sunnySky(width);
    const auto faces = cubeMap(e, 32);
    dvec3 sum(0), where(0);
    for (size_t f = 0; f < 6; ++f) {
      for (int i = 0; i < 32 * 32; ++i) {
        const dvec3 energy = faces[f].energy[static_cast<size_t>(i)];
        const vec2 ab = (vec2(static_cast<float>(i % 32), static_cast<float>(i / 32)) + 0.5f) / 16.f - 1.f;
        where += energy.x *
                 dvec3(glm::normalize(kCubeFaces[f].n + ab.x * kCubeFaces[f].u - ab.y * kCubeFaces[f].v));
        sum += energy;
      }
    }
    const dvec3 expected = energyOf(e);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], expected[c], 1e-9 * expected[c]) << width;
    dvec3 expectedWhere(0);
    for (int y = 0; y < e.height; ++y)
      for (int x = 0; x < width; ++x)
        expectedWhere += static_cast<double>(e.texels[static_cast<size_t>(y * width + x)].x *
                                             glsl::equirectangular_pixel_solid_angle(y, width, e.height)) *
                         dvec3(glsl::equirectangular_direction(
                             {(static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                              (static_cast<float>(y) + 0.5f) / static_cast<float>(e.height)}));
    EXPECT_LT(glm::length(where - expectedWhere), 0.03 * glm::length(expectedWhere))
        << width << ": half a texel";
  }
}

TEST(EnvironmentDecomposition, CubeMapsOfUniformMapsAreUniform) {
  for (const int width : {60, 64, 512})
    for (const int resolution : {7, 48}) {
      const auto faces = cubeMap(environmentOf(width, [](vec3) { return vec3(3); }), resolution);
      for (const TexelGrid& face : faces)
        for (size_t i = 0; i < face.energy.size(); ++i)
          EXPECT_NEAR(face.energy[i].x / face.measure[i], 3, 3 * 0.005) << width << ' ' << resolution;
    }
}

/// A sun of one pixel, anywhere: near a pole pixels are much narrower than texels. Its light is within a
/// texel of it, at most sqrt(2) 2 / 48 wide, and the sky keeps its own.
TEST(EnvironmentDecomposition, ASunOfOnePixelIsWhereItIsAndTheSkyAsItWas) {
  constexpr int kResolution = 48;
  for (const float around : {0.f, 1.f}) {
    const scene::Environment sky = environmentOf(256, [&](vec3) { return vec3(around); });
    const auto without = cubeMap(sky, kResolution);
    for (const int y : {0, 1, 5, 20, 127})
      for (const int x : {0, 3, 31, 129}) {
        SCOPED_TRACE(testing::Message() << around << " (" << x << ", " << y << ')');
        scene::Environment e = sky;
        e.texels[static_cast<size_t>(y * 256 + x)] = vec3(1e5f + around);
        const vec3 sun = glsl::equirectangular_direction(
            {(static_cast<float>(x) + 0.5f) / 256, (static_cast<float>(y) + 0.5f) / 128});
        const auto faces = cubeMap(e, kResolution);
        double near = 0;
        for (size_t f = 0; f < 6; ++f)
          for (int i = 0; i < kResolution * kResolution; ++i) {
            const double more =
                faces[f].energy[static_cast<size_t>(i)].x - without[f].energy[static_cast<size_t>(i)].x;
            const vec2 ab =
                2.f / kResolution *
                    (vec2(static_cast<float>(i % kResolution), static_cast<float>(i / kResolution)) + 0.5f) -
                1.f;
            const vec3 towards =
                glm::normalize(kCubeFaces[f].n + ab.x * kCubeFaces[f].u - ab.y * kCubeFaces[f].v);
            if (glm::distance(towards, sun) < 0.06f)
              near += more;
            else
              EXPECT_LT(std::abs(more), 1e-9);
          }
        const double energy = energyOf(e).x - energyOf(sky).x;
        EXPECT_NEAR(near, energy, 1e-6 * energy);
      }
  }
}

TEST(EnvironmentDecomposition, EnergyIsConservedForEveryMapAndSetting) {
  for (const scene::Environment& e : {sunnySky(256), noisySky(64, 1), noisySky(128, 2)}) {
    for (const RegionShape shape : {RegionShape::squares, RegionShape::rectangles}) {
      for (const double threshold : {0.01, 0.1}) {
        for (const int resolution : {1, 7, 32}) {
          SCOPED_TRACE(testing::Message() << e.width << ' ' << threshold << ' ' << resolution);
          EnvironmentDecomposition d;
          try {
            d = decomposeEnvironment(e, {threshold, resolution, shape});
          } catch (const UsageError&) {
            continue;  // more lights than there may be
          }
          expectSameEnergy(e, d);
          for (const scene::DistantRectangle& light : d.lights) {
            EXPECT_GE(std::min({light.irradiance.x, light.irradiance.y, light.irradiance.z}), 0);
            EXPECT_NEAR(dot(cross(light.axisU, light.axisV), light.centre), 1, 1e-6);
            if (shape == RegionShape::squares) {
              EXPECT_NEAR(light.sides.x, light.sides.y, 1e-6);
            }
          }
        }
      }
    }
  }
}

TEST(EnvironmentDecomposition, EveryTexelThatEmitsIsCovered) {
  const scene::Environment e = noisySky(128, 3);
  const EnvironmentDecomposition d = decomposeEnvironment(e, {0.02, 16, RegionShape::squares});
  std::array<std::array<bool, 256>, 6> covered{};
  for (size_t i = 0; i < d.regions.size(); ++i)
    for (int y = d.regions[i].y0; y < d.regions[i].y1; ++y)
      for (int x = d.regions[i].x0; x < d.regions[i].x1; ++x)
        covered[static_cast<size_t>(d.faces[i])][static_cast<size_t>(16 * y + x)] = true;
  for (const auto& face : covered)
    for (const bool texel : face) EXPECT_TRUE(texel);
}

TEST(EnvironmentDecomposition, AUniformMapIsSixFaces) {
  const scene::Environment e = environmentOf(64, [](vec3) { return vec3(2, 3, 4); });
  const EnvironmentDecomposition d = decomposeEnvironment(e, {0.015, 32, RegionShape::squares});
  ASSERT_EQ(d.lights.size(), 6u);
  for (const scene::DistantRectangle& light : d.lights) {
    EXPECT_NEAR(light.irradiance.y, 3 * 4 * pi / 6, 3e-3);
    EXPECT_EQ(light.sides, vec2(2));
  }
  expectSameEnergy(e, d);
}

TEST(EnvironmentDecomposition, GrowthStopsAtTheSideThatTheThresholdSays) {
  TexelGrid grid{200, 200, {}, {}};
  grid.energy.assign(200 * 200, dvec3(1));
  grid.measure.assign(200 * 200, 1);
  for (const RegionShape shape : {RegionShape::squares, RegionShape::rectangles}) {
    for (const double threshold : {0.015, 0.025, 0.035}) {
      const std::vector<Region> regions = greedyRegions(grid, threshold, shape, 1000, "grid");
      EXPECT_NEAR(regions.front().x1 - regions.front().x0, 1 / threshold - 1, 2);
      EXPECT_NEAR(regions.front().y1 - regions.front().y0, 1 / threshold - 1, 2);
    }
  }
}

/// In a grid of 1 the texels around a bright one hold 1 each: it keeps 1 for the regions that lie across it.
/// Of its own average, 1000, it would take nothing, and of the grid's, 1080 / 81, it would keep 13 times as
/// much.
TEST(EnvironmentDecomposition, WhatIsBrightLeavesTheDensityAroundIt) {
  TexelGrid grid{9, 9, {}, {}};
  grid.energy.assign(81, dvec3(1));
  grid.measure.assign(81, 1);
  grid.energy[40] = dvec3(1000);
  for (const RegionShape shape : {RegionShape::squares, RegionShape::rectangles}) {
    // At 0.01 no row or column adds enough to a bright texel of 1000.
    const std::vector<Region> regions = greedyRegions(grid, 0.01, shape, 81, "grid");
    ASSERT_GT(regions.size(), 1u);
    EXPECT_EQ(regions[0].x1 - regions[0].x0, 1);
    EXPECT_EQ(regions[0].y1 - regions[0].y0, 1);
    int covers = 0;
    double sum = 0;
    for (const Region& region : regions) {
      covers += region.x0 <= 4 && 4 < region.x1 && region.y0 <= 4 && 4 < region.y1;
      sum += region.energy.x;
    }
    // Each region across it takes a part of the 1 at most; what is left at the end is divided among all.
    EXPECT_GE(regions[0].energy.x, 999 - 1e-9);
    EXPECT_LE(regions[0].energy.x, 999 + 1.0 / covers + 1e-9);
    EXPECT_NEAR(sum, 1080, 1e-9);
  }
}

TEST(EnvironmentDecomposition, ASunIsASmallLightOfItsEnergy) {
  const scene::Environment e = sunnySky(512);
  const EnvironmentDecomposition d = decomposeEnvironment(e, {0.015, 64, RegionShape::squares});
  const scene::DistantRectangle& sun = d.lights.front();
  const vec3 towards = glsl::equirectangular_direction({(512 / 3 + 0.5f) / 512, (512 / 8 + 0.5f) / 256});
  EXPECT_GT(dot(glm::normalize(sun.centre), towards), std::cos(0.03f));
  EXPECT_LE(sun.sides.x, 0.2f);
  const float energy = 1e5f * glsl::equirectangular_pixel_solid_angle(64, 512, 256);
  EXPECT_NEAR(sun.irradiance.x, energy, 0.05f * energy);
  EXPECT_LT(d.lights.size(), 100u);
  expectSameEnergy(e, d);
}

TEST(EnvironmentDecomposition, NothingComesOfBlackAndBrokenPixelsCountAsBlack) {
  scene::Environment e = environmentOf(64, [](vec3) { return vec3(0); });
  EXPECT_TRUE(decomposeEnvironment(e, {}).lights.empty());
  e.texels[5] = vec3(NAN, -1, 0);
  e.texels[6] = vec3(-INFINITY, -1e30f, INFINITY);
  EXPECT_TRUE(decomposeEnvironment(e, {}).lights.empty());
  e.texels[7] = vec3(1, NAN, -3);
  const EnvironmentDecomposition d = decomposeEnvironment(e, {});
  ASSERT_FALSE(d.lights.empty());
  expectSameEnergy(e, d);
  EXPECT_EQ(energyOf(d).y, 0);
}

TEST(EnvironmentDecomposition, TheSameEveryTime) {
  const scene::Environment e = noisySky(128, 4);
  const EnvironmentDecomposition a = decomposeEnvironment(e, {0.02, 32, RegionShape::squares}),
                                 b = decomposeEnvironment(e, {0.02, 32, RegionShape::squares});
  ASSERT_EQ(a.lights.size(), b.lights.size());
  for (size_t i = 0; i < a.lights.size(); ++i) {
    EXPECT_EQ(a.lights[i].irradiance, b.lights[i].irradiance);
    EXPECT_EQ(a.lights[i].centre, b.lights[i].centre);
  }
}

TEST(EnvironmentDecomposition, SettingsOutOfRangeAreRefused) {
  const scene::Environment e = noisySky(64, 5);
  EXPECT_THROW(decomposeEnvironment(e, {0, 64, RegionShape::squares}), UsageError);
  EXPECT_THROW(decomposeEnvironment(e, {1, 64, RegionShape::squares}), UsageError);
  EXPECT_THROW(decomposeEnvironment(e, {NAN, 64, RegionShape::squares}), UsageError);
  EXPECT_THROW(decomposeEnvironment(e, {0.015, 0, RegionShape::squares}), UsageError);
  EXPECT_THROW(decomposeEnvironment(e, {0.015, 513, RegionShape::squares}), UsageError);
  EXPECT_THROW(decomposeEnvironment(e, {0.4, 128, RegionShape::squares}), UsageError)
      << "thousands of lights";
  EXPECT_THROW(decomposeEnvironment({}, {}), Error);
}

// The thesis: 30 to 32, 45 and 60 lights at thresholds of 0.015, 0.025 and 0.035.
TEST(EnvironmentDecomposition, MeasuredMapsTakeAsManyLightsAsTheThesisReports) {
  const char* models = std::getenv("LIMN_MODELS");
  if (models == nullptr) GTEST_SKIP() << "LIMN_MODELS names no folder with env/courtyard.exr and others";
  for (const char* file : {"courtyard.exr", "sunset.exr", "uffizi_256.hdr", "eucalyptus_1k.exr"}) {
    SCOPED_TRACE(file);
    std::vector<std::string> warnings;
    const scene::Environment e =
        scene::loadEnvironment(std::filesystem::path(models) / "env" / file, warnings);
    EXPECT_LE(warnings.size(), 1u);  // courtyard and sunset hold pixels below 0
    size_t before = 0;
    for (const auto& [threshold, lights] :
         {std::pair(0.015, 31), std::pair(0.025, 45), std::pair(0.035, 60)}) {
      const EnvironmentDecomposition d = decomposeEnvironment(e, {.threshold = threshold});
      EXPECT_NEAR(static_cast<double>(d.lights.size()), lights, 0.2 * lights) << threshold;
      EXPECT_GT(d.lights.size(), before);
      before = d.lights.size();
      expectSameEnergy(e, d);
    }
  }
}

TEST(EnvironmentDecomposition, TheOverlayOutlinesTheLights) {
  const scene::Environment e = environmentOf(64, [](vec3) { return vec3(1); });
  const Image picture = decompositionOverlay(e, decomposeEnvironment(e, {.resolution = 32}), 256, -1);
  int green = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const bool outline = picture.at(x, y, 0) == 0;
      EXPECT_FLOAT_EQ(picture.at(x, y, 1), outline ? 1.f : 0.5f);
      green += outline;
    }
  EXPECT_GT(green, 500);
  EXPECT_LT(green, 256 * 128 / 8);
}

}  // namespace
}  // namespace limn::shading
