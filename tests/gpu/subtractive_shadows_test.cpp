// Subtractive shadows: what holds to the bit, and what lies between nothing and the unshadowed light.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "core/scene/density_grid.h"
#include "tests/gpu/subtractive_harness.h"
#include "tests/support/density_grids.h"

namespace limn {
namespace {

using glm::vec3;

constexpr const char* kCombines[] = {"subtract", "ratio", "ratio_split", "add"};

TEST_F(SubtractiveShadowsTest, WhereNothingIsHiddenTheLightIsTheUnshadowedOneToTheBit) {
  const scene::Scene scene = lit(floor(), sky(), 0);
  render::Renderer renderer(device(), scene);
  const Image unshadowed = direct(renderer, 37, 23);
  for (const char* combine : {"subtract", "ratio", "ratio_split"})
    for (const char* block : {"1", "2", "4", "32"})
      for (const char* lights : {"1", "25", "200"})
        EXPECT_LE(largestDifference(
                      direct(renderer, 37, 23,
                             {smallShadows({{"combine", combine}, {"block", block}, {"lights", lights}})}),
                      unshadowed),
                  contraction())
            << combine << ' ' << block << ' ' << lights;
}

/// The lobes of metals have their light from samples or from the cache.
TEST_F(SubtractiveShadowsTest, WhereNothingIsHiddenLobesHaveAllOfTheirLight) {
  scene::Scene plane = floor();
  plane.materials[0] = metal(glm::vec4(1), 0.3f);
  const scene::Scene scene = lit(plane, sky(), 0);
  render::Renderer renderer(device(), scene);
  for (const char* source : {"brdf_samples", "cache"}) {
    const auto shown = [&](const char* show, const char* block, const char* lights) {
      return direct(
          renderer, 37, 23,
          {smallShadows({{"unshadowed", source}, {"block", block}, {"lights", lights}, {"show", show}})});
    };
    const Image unshadowed = shown("unshadowed", "1", "1");
    EXPECT_GT(mean(unshadowed), 0.1) << source;
    for (const char* block : {"1", "4", "32"})
      for (const char* lights : {"1", "25", "200"})
        EXPECT_LE(largestDifference(shown("light", block, lights), unshadowed),
                  static_cast<double>(contraction()) * std::max(1.0, largest(unshadowed)))
            << source << ' ' << block << ' ' << lights << ", of up to " << largest(unshadowed);
  }
}

/// Where a budget of time may change the samples, passes of its own add them up: the first frame has all.
TEST_F(SubtractiveShadowsTest, AddedAtEveryPixelItIsTheSampledEnvironment) {
  const scene::Scene scene = lit(coarse("balls"), sky(), 0);
  render::Renderer renderer(device(), scene);
  const Image sampled =
      direct(renderer, 64, 48,
             {technique("sampled_environment_light", {{"samples", "40"}, {"shadow_map_size", "128"}})});
  const auto added = [&](const char* time, const char* demodulate, const char* memory) {
    return direct(renderer, 64, 48,
                  {smallShadows({{"combine", "add"},
                                 {"block", "1"},
                                 {"lights", "40"},
                                 {"frame_time", time},
                                 {"demodulate", demodulate},
                                 {"memory", memory}})});
  };
  EXPECT_EQ(largestDifference(added("0", "true", "16"), sampled), 0);
  for (const char* demodulate : {"true", "false"})
    for (const char* memory : {"16", "1"})
      EXPECT_LT(largestDifference(added("10000", demodulate, memory), sampled), 1e-5 * largest(sampled))
          << demodulate << ' ' << memory;
}

TEST_F(SubtractiveShadowsTest, OfTheSameLightsTheDifferenceIsTheSum) {
  const scene::Scene scene = lit(coarse("balls"), sky(), 0);
  render::Renderer renderer(device(), scene);
  const auto with = [&](const char* combine) {
    return direct(renderer, 64, 48,
                  {smallShadows({{"combine", combine},
                                 {"block", "1"},
                                 {"lights", "40"},
                                 {"unshadowed", "lights"},
                                 {"unshadowed_factor", "1"}})});
  };
  const Image added = with("add");
  for (const char* combine : {"subtract", "ratio", "ratio_split"})
    EXPECT_LT(largestDifference(with(combine), added), 1e-5 * largest(added)) << combine;
}

/// Software renderers leave loops early, which would make the light without shadows too dark.
TEST_F(SubtractiveShadowsTest, UnshadowedSamplesThatLoopsDoNotTakeAreRefused) {
  if (!context().info().software) GTEST_SKIP() << "loops of GPUs have no end of their own";
  const scene::Scene clear = lit(floor(), uniform(1), 0);
  scene::Scene hazy = clear;
  hazy.medium.sigmaA = vec3(1e-6f);
  scene::setGrid(hazy.medium, test::constantGrid(scene::evaluate(hazy, 0).bounds, 1));
  const auto with = [&](const scene::Scene& scene, const char* lights) {
    render::Renderer renderer(device(), scene);
    return direct(renderer, 8, 6,
                  {shadows({{"lights", lights},
                            {"block", "1"},
                            {"unshadowed", "lights"},
                            {"unshadowed_factor", "64"},
                            {"shadow_map_size", "16"}})});
  };
  expectWithin(with(clear, "400"), 0.97f, 1.03f);
  expectWithin(with(hazy, "7"), 0.97f, 1.03f);
  EXPECT_THAT(errorOf([&] { with(clear, "500"); }), testing::HasSubstr("takes at most 30000"));
  EXPECT_THAT(errorOf([&] { with(hazy, "8"); }), testing::HasSubstr("where a medium has a grid"));
}

TEST_F(SubtractiveShadowsTest, LightLiesBetweenNothingAndTheUnshadowedLight) {
  for (const char* name : {"balls", "fresnel_spheres"}) {
    const scene::Scene scene = lit(coarse(name), sky(), 0);
    render::Renderer renderer(device(), scene);
    const Image unshadowed = direct(renderer, 64, 48);
    for (const char* combine : {"subtract", "ratio", "ratio_split"})
      for (const char* block : {"1", "4"})
        for (const char* lights : {"1", "25"}) {
          const Image picture = direct(
              renderer, 64, 48, {smallShadows({{"combine", combine}, {"block", block}, {"lights", lights}})});
          for (size_t i = 0; i < picture.data().size(); ++i) {
            EXPECT_GE(picture.data()[i], 0) << name << combine << block;
            EXPECT_LE(picture.data()[i], unshadowed.data()[i] * (1 + 1e-5f)) << name << combine << block;
          }
        }
  }
}

TEST_F(SubtractiveShadowsTest, LightIsNoMoreThanThatOfSampledOrCachedLobes) {
  const scene::Scene scene = lit(coarse("balls"), sky(), 0);
  render::Renderer renderer(device(), scene);
  for (const char* source : {"brdf_samples", "cache"}) {
    const auto shown = [&](const char* show, const char* combine, const char* block) {
      return direct(
          renderer, 64, 48,
          {smallShadows({{"unshadowed", source}, {"combine", combine}, {"block", block}, {"show", show}})});
    };
    const Image unshadowed = shown("unshadowed", "ratio", "1");
    for (const char* combine : {"subtract", "ratio", "ratio_split"})
      for (const char* block : {"1", "4"}) {
        const Image light = shown("light", combine, block);
        double least = 0, over = 0;  // over: of light over the unshadowed light, less 1
        for (size_t i = 0; i < light.data().size(); ++i) {
          const auto value = static_cast<double>(light.data()[i]),
                     whole = static_cast<double>(unshadowed.data()[i]);
          ASSERT_TRUE(std::isfinite(value)) << source << ' ' << combine << ' ' << block << ' ' << i;
          least = std::min(least, value);
          if (value > whole) over = std::max(over, value / whole - 1);
        }
        EXPECT_GE(least, 0) << source << ' ' << combine << ' ' << block;
        EXPECT_LE(over, 1e-5) << source << ' ' << combine << ' ' << block;
      }
  }
}

/// U is what is hidden of it and what is left. In the middle of a block the shadow buffer has what is hidden
/// there.
TEST_F(SubtractiveShadowsTest, WhatIsShownAddsUpToTheUnshadowedLight) {
  constexpr int kWidth = 64, kHeight = 48, kSide = 4;
  const scene::Scene scene = lit(coarse("balls"), sky(), 0);
  render::Renderer renderer(device(), scene);
  const Image unshadowed = direct(renderer, kWidth, kHeight);
  const double most = largest(unshadowed), rounding = 5e-5 * most;  // shares are kept in 16 bits
  for (const char* combine : {"subtract", "ratio", "ratio_split"}) {
    const auto shown = [&](const char* show, const char* block) {
      return direct(
          renderer, kWidth, kHeight,
          {smallShadows({{"combine", combine}, {"demodulate", "false"}, {"block", block}, {"show", show}})});
    };
    for (const char* block : {"1", "4"}) {
      EXPECT_LE(largestDifference(shown("unshadowed", block), unshadowed), 1e-6 * most) << combine << block;
      Image sum = shown("hidden", block);
      const Image left = shown("light", block);
      EXPECT_GT(largest(sum), 10 * rounding) << combine << block;
      for (size_t i = 0; i < sum.data().size(); ++i) sum.data()[i] += left.data()[i];
      EXPECT_LT(largestDifference(sum, unshadowed), rounding) << combine << block;
    }
    const Image own = shown("hidden", "1"), buffer = shown("shadow_buffer", "4");
    EXPECT_EQ(largestDifference(shown("shadow_buffer", "1"), own), 0) << combine;
    EXPECT_GT(largestDifference(buffer, shown("hidden", "4")), 10 * rounding) << combine;
    // Blocks count from below, rows of the picture from above.
    for (int y = kSide / 2; y < kHeight; y += kSide)
      for (int x = kSide / 2; x < kWidth; x += kSide)
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(buffer.at(x, kHeight - 1 - y, c), own.at(x, kHeight - 1 - y, c), rounding)
              << combine << ' ' << x << ' ' << y;
  }
  EXPECT_THAT(errorOf([&] {
                render::Renderer refused(device(), scene);
                direct(refused, kWidth, kHeight, {shadows({{"combine", "add"}, {"show", "hidden"}})});
              }),
              testing::HasSubstr("show goes with combine=subtract"));
}

TEST_F(SubtractiveShadowsTest, BatchesOfAnySizeGiveTheSamePicture) {
  for (const char* name : {"balls", "fresnel_spheres"}) {
    const scene::Scene scene = lit(coarse(name), sky(), 0);
    render::Renderer renderer(device(), scene);
    for (const char* combine : kCombines)
      for (const char* block : {"1", "4"}) {
        // Of coats one way to combine is enough: all hand on the same sums.
        if (name != std::string_view("balls") && combine != std::string_view("ratio_split")) continue;
        const auto with = [&](const char* memory) {
          return direct(
              renderer, 64, 48,
              {smallShadows({{"combine", combine}, {"block", block}, {"lights", "40"}, {"memory", memory}})});
        };
        // Shares are kept in 16 bits.
        EXPECT_LT(rmse(with("1"), with("16")), 2e-5) << name << combine << block;
      }
  }
}

/// 25 samples and each pixel's own shadows; the references' noise is taken off.
TEST_F(SubtractiveShadowsTest, SharesOfLightErrLessThanSamplesAddedUp) {
  const auto errors = [&](const scene::Scene& scene, const char* combine) {
    render::Renderer renderer(device(), scene);
    const Image whole = referenceWithNoise(scene, settings(128, 96, Term::direct), 256);
    const Image truth = whole.select({"R", "G", "B"});
    const double noise = mean(whole.select({"variance"}));
    const auto error = [&](const char* way) {
      const Values values{{"unshadowed", "brdf_samples"}, {"combine", way}, {"block", "1"}, {"lights", "25"}};
      const double both = rmse(direct(renderer, 128, 96, {shadows(values)}), truth);
      EXPECT_GT(both * both, 2 * noise) << way << ": the reference's noise, " << std::sqrt(noise);
      return std::sqrt(std::max(both * both - noise, 0.0));
    };
    return std::pair(error("add"), error(combine));
  };
  for (const float degrees : {0.f, 72.f}) {
    scene::Scene spheres = asset("nine_spheres");
    spheres.environment.rotation += degrees * glsl::pi / 180;
    const auto [added, split] = errors(spheres, "ratio_split");
    EXPECT_GE(added / split, 1.8) << degrees << " degrees: added up " << added << ", ratio_split " << split;
  }
  const auto [added, ratio] = errors(asset("arcade_dark"), "ratio");
  EXPECT_LE(ratio / added, 1.2) << "arcade_dark: added up " << added << ", ratio " << ratio;
}

/// Pictures smaller than a block, one light, a single bright texel, lobes as sharp as they get: nothing is
/// infinite, and nothing is brighter than without shadows. Smoother metals are mirrors, which have no light
/// here.
TEST_F(SubtractiveShadowsTest, ExtremesStayFinite) {
  scene::Environment spot = uniform(0);
  spot.texels[32 * 4 + 7] = vec3(1e6f);
  scene::Scene sharp = coarse("balls"), metals = sharp;
  for (scene::Material& material : sharp.materials) material.roughness = 0;
  for (scene::Material& material : metals.materials) material = metal(glm::vec4(1), 13 / 255.f);
  for (const auto& [surfaces, environment] :
       {std::pair(sharp, sky()), std::pair(sharp, spot), std::pair(metals, sky()), std::pair(metals, spot)}) {
    const scene::Scene scene = lit(surfaces, environment, 0);
    render::Renderer renderer(device(), scene);
    const double most = largest(direct(renderer, 21, 13));
    for (const char* combine : kCombines)
      for (const char* block : {"1", "32"})
        for (const char* lights : {"1", "4"}) {
          const Image picture = direct(
              renderer, 21, 13, {smallShadows({{"combine", combine}, {"block", block}, {"lights", lights}})});
          for (const float v : picture.data()) EXPECT_TRUE(std::isfinite(v) && v >= 0) << combine << block;
          const bool bounded = std::string_view(combine) != "add";
          EXPECT_TRUE(!bounded || largest(picture) <= most * (1 + 1e-5)) << combine << block;
        }
  }
}

/// Were each sample of the truth off by three times its mean, that of all 884,736 would be by 0.3 %.
TEST_F(SubtractiveShadowsTest, RegionsStandForAllOfTheLight) {
  const Values regions{{"block", "1"}, {"sampling", "regions"}, {"region_threshold", "0.1"}};
  const auto combined = [&](const char* combine) {
    Values values = regions;
    values.emplace_back("combine", combine);
    return shadows(values);
  };
  const scene::Scene plane = lit(floor(), uniform(0.7f), 0);
  render::Renderer above(device(), plane);
  const Image open = direct(above, 16, 12, {combined("add")});
  for (const float v : open.data()) EXPECT_NEAR(v, 0.7f, 0.02f * 0.7f);
  const scene::Scene scene = lit(asset("balls"), sky(), 0);
  render::Renderer renderer(device(), scene);
  const Image truth = reference(scene, settings(96, 72, Term::direct), 128);
  for (const char* combine : {"add", "ratio_split"})
    EXPECT_NEAR(mean(direct(renderer, 96, 72, {combined(combine)})), mean(truth), 0.05 * mean(truth))
        << combine;
}

}  // namespace
}  // namespace limn
