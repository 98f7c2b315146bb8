// Reflected light in parts, and what shadows leave of it.
#include "glsl/surface/reflected_parts.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace limn {
namespace {

using glm::vec3;

TEST(ReflectedParts, SharesAreWhatIsMissing) {
  EXPECT_EQ(glsl::hidden_share(1.f, 4.f, 0.5f), 0.75f);
  EXPECT_EQ(glsl::hidden_share(0.f, 4.f, 0.5f), 1);
  EXPECT_EQ(glsl::hidden_share(4.0001f, 4.f, 0.5f), 0) << "rounding adds no light";
  EXPECT_EQ(glsl::hidden_share(0.f, 0.f, 0.5f), 0.5f);
}

TEST(ReflectedParts, PartsAreHiddenApart) {
  const glsl::ReflectedParts all{vec3(2, 4, 0), vec3(1, 0, 0)}, seen{vec3(1, 3, 0), vec3(0)},
      light{vec3(8), vec3(16)};
  const glsl::ReflectedParts hidden = glsl::hidden_parts(seen, all);
  EXPECT_EQ(hidden.diffuse, vec3(0.5f, 0.25f, 0));
  EXPECT_EQ(hidden.lobe, vec3(1, 0.25f, 0)) << "an empty lobe is hidden as the diffuse part is";
  EXPECT_EQ(glsl::reflected_left(light, hidden), vec3(4, 6 + 12, 24));
}

TEST(ReflectedParts, WhereNothingIsHiddenLightIsWholeToTheBit) {
  const glsl::ReflectedParts light{vec3(0.1f, 0.2f, 0.3f), vec3(0.7f, 1e-7f, 3e7f)};
  const vec3 left = glsl::reflected_left(light, glsl::hidden_parts(light, light));
  EXPECT_EQ(left, glsl::reflected_whole(light));
}

/// N times the variances of what is added up, subtracted and divided by, of N lights whose relative deviation
/// is s and each of which is seen with that chance, where the unshadowed light is 1.
std::array<double, 3> variances(double seenChance, double s) {
  constexpr int kLights = 50, kSets = 40000;
  const double width = std::sqrt(std::log(1 + s * s));
  std::mt19937 random(5);
  std::lognormal_distribution<double> response(-0.5 * width * width, width);
  std::bernoulli_distribution isSeen(seenChance);
  std::array<double, 3> sums{}, squares{};
  for (int set = 0; set < kSets; ++set) {
    double all = 0, seen = 0;
    for (int i = 0; i < kLights; ++i) {
      const double g = response(random) / kLights;
      all += g;
      if (isSeen(random)) seen += g;
    }
    const glsl::ReflectedParts hidden = glsl::hidden_parts({vec3(static_cast<float>(seen)), vec3(0)},
                                                           {vec3(static_cast<float>(all)), vec3(0)});
    const auto ratio = static_cast<double>(glsl::reflected_left({vec3(1), vec3(0)}, hidden).x);
    const double estimates[] = {seen, std::max(1 - (all - seen), 0.0), ratio};
    for (size_t k = 0; k < 3; ++k) {
      sums[k] += estimates[k] / kSets;
      squares[k] += estimates[k] * estimates[k] / kSets;
    }
  }
  for (size_t k = 0; k < 3; ++k) squares[k] = kLights * (squares[k] - sums[k] * sums[k]);
  return squares;
}

/// The laws of first order; 40000 sets know a variance within 0.7 %.
TEST(ReflectedParts, EstimatorsVaryAsTheirLawsSay) {
  constexpr double s = 0.5;
  for (const double v : {0.7, 0.35}) {
    const double shadow = v * (1 - v);
    const std::array<double, 3> law{shadow + v * s * s, shadow + (1 - v) * s * s,
                                    shadow + v * (1 - v) * s * s},
        found = variances(v, s);
    EXPECT_NEAR(found[0] / law[0], 1, 0.04) << "add at " << v << ": " << found[0] << " for " << law[0];
    EXPECT_NEAR(found[1] / law[1], 1, 0.04) << "subtract at " << v << ": " << found[1] << " for " << law[1];
    EXPECT_NEAR(found[2] / law[2], 1, 0.04) << "ratio at " << v << ": " << found[2] << " for " << law[2];
  }
}

}  // namespace
}  // namespace limn
