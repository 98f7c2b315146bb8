#include "core/brdf/groove.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/unit/brdf/materials.h"

namespace limn::brdf {
namespace {

using namespace test;

glm::dvec3 atAngles(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

BrdfFunction function(const GrooveBrdf& groove) {
  return [&groove](const glm::vec3& l, const glm::vec3& v) {
    return glm::vec3(groove.evaluate(glm::dvec3(l), glm::dvec3(v)));
  };
}

TEST(GrooveBrdf, ShallowGrooveIsLambertian) {
  const GrooveBrdf flat({.slope = 1e-6f, .rising = glm::vec3(0.2f), .falling = glm::vec3(0.6f), .strips = 4});
  for (const double theta : {0.0, 0.5, 1.2})
    EXPECT_NEAR(flat.evaluate(atAngles(theta, 1), atAngles(0.7, 4)).x, 0.4 / kPi, 1e-5);
}

// One strip a wall sees the other with F = 1 - cos(slope), head-on both are lit alike:
// B = R cos(slope) / (1 - R F) of the light on a unit of surface.
TEST(GrooveBrdf, OneStripHeadOn) {
  const double slope = 1.1, r = 0.7;
  const GrooveBrdf groove({.slope = static_cast<float>(slope),
                           .rising = glm::vec3(0.7f),
                           .falling = glm::vec3(0.7f),
                           .strips = 1});
  const double f = r * std::cos(slope) / (1 - r * (1 - std::cos(slope))) / kPi;
  EXPECT_NEAR(groove.evaluate({0, 0, 1}, {0, 0, 1}).y, f, 1e-6);
}

// With one black wall light is reflected once, at most: f = R/pi (n.l)(n.v) / (l.z v.z) times the part of the
// wall, for a unit of surface, that both see over the crest.
TEST(GrooveBrdf, SingleReflectionOffOneWall) {
  const double slope = 0.9;
  const GrooveBrdf groove({.slope = 0.9f, .rising = glm::vec3(0.5f), .falling = glm::vec3(0), .strips = 100});
  const glm::dvec3 n(-std::sin(slope), 0, std::cos(slope));
  const auto lowest =
      [&](const glm::dvec3& d) {  // share of the wall, from the bottom, in the shadow of the crest
        const double q = d.z / (std::tan(slope) * std::max(-d.x, 1e-300));
        return std::max((1 - q) / (1 + q), 0.0);
      };
  for (const double a : {0.1, 0.6, 1.1, 1.4})
    for (const double b : {0.2, 0.9, 1.3})
      for (const double phi : {0.0, 0.8, 2.2, 3.1}) {
        const glm::dvec3 l = atAngles(a, phi), v = atAngles(b, 3.5 - phi);
        const double part = 1 - std::max(lowest(l), lowest(v));
        const double whole = 0.5 / kPi * std::max(glm::dot(n, l), 0.0) * std::max(glm::dot(n, v), 0.0) /
                             (l.z * v.z) * 0.5 / std::cos(slope);
        // Where both shadows end within one strip, shares a and b of it make a b of min(a, b): at most 1/4
        // too little.
        EXPECT_NEAR(groove.evaluate(l, v).x, whole * part, whole * 0.25 / 100 + 1e-7);
      }
}

// Crossed strings lose nothing; what is left is the quadrature of the albedo.
TEST(GrooveBrdf, WhiteGrooveReflectsAll) {
  for (const float slope : {0.3f, 0.785f, 1.3f}) {
    const GrooveBrdf white({.slope = slope, .rising = glm::vec3(1), .falling = glm::vec3(1), .strips = 48});
    for (const double theta : {0.0, 0.6, 1.3}) {
      const glm::dvec3 share = albedoOfBrdf(function(white), glm::vec3(atAngles(theta, 0.4)), 96);
      EXPECT_NEAR(share.x, 1, 2e-3) << slope << " at " << theta;
    }
  }
}

TEST(GrooveBrdf, IsReciprocal) {
  const GrooveBrdf groove({.slope = 1.0f});
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> theta(0, 1.57), phi(0, 2 * kPi);
  double most = 0;
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 l = atAngles(theta(generator), phi(generator)),
                     v = atAngles(theta(generator), phi(generator));
    const glm::dvec3 there = groove.evaluate(l, v), back = groove.evaluate(v, l);
    for (int c = 0; c < 3; ++c)
      most = std::max(most, std::abs(there[c] - back[c]) / std::max(there[c], 1e-300));
  }
  // Sums of four products, whose factors are means of means of the same positive numbers in either order: six
  // roundings of 1.1e-16 each way.
  EXPECT_LT(most, 1.4e-15);
}

TEST(GrooveBrdf, ColourTellsTheSide) {
  const GrooveBrdf groove(Groove{});
  const glm::dvec3 n(0, 0, 1);
  const glm::dvec3 left = groove.evaluate(n, atAngles(1.0, kPi)),
                   right = groove.evaluate(n, atAngles(1.0, 0));
  EXPECT_GT(left.z, 3 * left.x);    // seen from -x the wall that faces -x: blue
  EXPECT_GT(right.x, 3 * right.z);  // red
  // Turned by a half turn with its walls swapped it is the same.
  const GrooveBrdf swapped({.rising = Groove{}.falling, .falling = Groove{}.rising});
  const glm::dvec3 l = atAngles(0.7, 0.3), v = atAngles(1.1, 2.0);
  const glm::dvec3 turned = swapped.evaluate({-l.x, -l.y, l.z}, {-v.x, -v.y, v.z});
  EXPECT_LT(glm::length(turned - groove.evaluate(l, v)), 1e-12);
  EXPECT_EQ(groove.evaluate({1, 0, 0}, n), glm::dvec3(0));
}

TEST(GrooveBrdf, MoreStripsConverge) {
  const glm::dvec3 l = atAngles(0.9, 0.2), v = atAngles(0.8, 2.9);
  const auto f = [&](int strips) { return GrooveBrdf({.strips = strips}).evaluate(l, v).x; };
  const double fine = f(192);
  EXPECT_NEAR(f(48), fine, 0.02 * fine);
  EXPECT_LT(std::abs(f(96) - fine), std::abs(f(24) - fine));
}

TEST(GrooveBrdf, TableHoldsIt) {
  const GrooveBrdf groove(Groove{});
  const AnisotropicTable table = groove.table(8), general = tabulateAnisotropic(8, function(groove));
  ASSERT_EQ(table.values.size(), general.values.size());
  for (std::size_t i = 0; i < table.values.size(); ++i)
    EXPECT_LT(glm::length(table.values[i] - general.values[i]),
              1e-5f * glm::length(general.values[i]) + 1e-7f);
}

TEST(GrooveBrdf, TwentyTexelsASide) {
  const GrooveBrdf groove(Groove{});
  const AnisotropicTable table = groove.table(20);
  const SphereError error =
      compareOnSphere([&](auto& l, auto& v) { return table.evaluate(l, v); }, function(groove));
  EXPECT_LT(error.rms, 0.025);
}

}  // namespace
}  // namespace limn::brdf
