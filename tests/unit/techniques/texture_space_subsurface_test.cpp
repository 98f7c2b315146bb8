// Profiles as sums of Gaussians, against the profiles themselves.
#include <gtest/gtest.h>

#include <cmath>

#include "techniques/texture_space_subsurface/body_texture.glsl"
#include "techniques/texture_space_subsurface/gaussians.h"

namespace limn::texture_space {
namespace {

using glm::vec3;

// Of skin1 (Jensen, Marschner, Levoy and Hanrahan 2001, figure 5), per metre.
const vec3 kScattering{740, 880, 1010}, kAbsorption{32, 170, 480};
const vec3 kExtinction = kScattering + kAbsorption;

/// The largest difference of the shares within any radius, of one channel.
double largestDifference(const scene::ChannelProfile& channel, const std::vector<Gaussian>& gaussians,
                         int c) {
  double largest = 0;
  for (int i = 0; i <= 100; ++i) {
    const double r = radiusOfShare(channel, 0.01 + 0.0098 * i);
    double share = 0;
    for (const Gaussian& g : gaussians) share += g.weight[c] * gaussianShare(g.sigma, r);
    largest = std::max(largest, std::abs(share - channel.share(r)));
  }
  return largest;
}

double largestDifference(const scene::Profile& profile, const std::vector<Gaussian>& gaussians) {
  double largest = 0;
  for (size_t c = 0; c < 3; ++c)
    largest = std::max(largest, largestDifference(profile[c], gaussians, static_cast<int>(c)));
  return largest;
}

TEST(TextureSpaceSubsurface, GaussiansAddUpToProfiles) {
  const scene::Profile skin = scene::diffusionProfile(kExtinction, kAbsorption / kExtinction, 1.3f, false);
  const scene::Profile normalised =
      scene::diffusionProfile(kExtinction, kAbsorption / kExtinction, 1.3f, true);
  EXPECT_LT(largestDifference(skin, fitGaussians(skin, 6)), 0.01);
  EXPECT_LT(largestDifference(skin, fitGaussians(skin, 4)), 0.03);
  EXPECT_LT(largestDifference(normalised, fitGaussians(normalised, 6)), 0.03);
  for (const auto& profile : {skin, normalised})
    for (const int count : {1, 2, 6, 12}) {
      glm::dvec3 sum(0);
      double last = 0;
      const std::vector<Gaussian> gaussians = fitGaussians(profile, count);
      ASSERT_EQ(gaussians.size(), static_cast<size_t>(count));
      for (const Gaussian& g : gaussians) {
        for (int c = 0; c < 3; ++c) EXPECT_GE(g.weight[c], 0);
        EXPECT_GT(g.sigma, last);
        last = g.sigma;
        sum += g.weight;
      }
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], 1, 1e-12);
    }
}

TEST(TextureSpaceSubsurface, AGaussianIsItself) {
  const auto share = [](double r) { return gaussianShare(0.01, r); };
  const scene::Profile profile{{{1, share}, {1, share}, {1, share}}};
  EXPECT_LT(largestDifference(profile, fitGaussians(profile, 1)), 0.1);
  EXPECT_LT(largestDifference(profile, fitGaussians(profile, 6)), 0.02);
}

TEST(TextureSpaceSubsurface, ExtremeMatterHasFiniteGaussians) {
  for (const float extinction : {1e-6f, 1.f, 1e9f})
    for (const float absorption : {0.f, 1e-5f, 1.f})
      for (const float ior : {1.f, 3.f})
        for (const bool normalised : {false, true})
          for (const Gaussian& g : fitGaussians(
                   scene::diffusionProfile(vec3(extinction), vec3(absorption), ior, normalised), 6)) {
            EXPECT_TRUE(std::isfinite(g.sigma) && g.sigma >= 0 && g.sigma < 1e13);
            for (int c = 0; c < 3; ++c) EXPECT_TRUE(g.weight[c] >= 0 && g.weight[c] <= 1);
          }
}

// A step from one Gaussian to the next adds the variance that they differ by, so that all are as wide as
// said.
TEST(TextureSpaceSubsurface, TapsHaveTheVarianceOfTheirGaussian) {
  float sum = glsl::tap_weights[0], squares = 0;
  for (int i = 1; i < 4; ++i) {
    const float place = static_cast<float>(i) * glsl::tap_step;
    sum += 2 * glsl::tap_weights[i];
    squares += 2 * glsl::tap_weights[i] * place * place;
  }
  EXPECT_NEAR(squares / sum, 1, 1e-3);
}

TEST(TextureSpaceSubsurface, GaussiansBelowHalfATexelAreNotSpread) {
  EXPECT_EQ(glsl::spread_share(0.4f, {1, 0.5f}), 0);
  EXPECT_FLOAT_EQ(glsl::spread_share(0.75f, {1, 0.5f}), 0.5f);
  EXPECT_EQ(glsl::spread_share(2, {1, 0.5f}), 1);
  EXPECT_EQ(glsl::spread_share(1, {0, 0}), 1);
}

}  // namespace
}  // namespace limn::texture_space
