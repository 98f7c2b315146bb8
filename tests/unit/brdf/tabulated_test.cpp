#include "core/brdf/tabulated.h"

#include <gtest/gtest.h>

#include <random>

#include "core/base/error.h"
#include "tests/unit/brdf/materials.h"

namespace limn::brdf {
namespace {

using namespace test;

/// Directions above the horizon, evenly distributed.
class Directions {
 public:
  glm::vec3 operator()() {
    const float z = std::uniform_real_distribution(1e-3f, 1.0f)(generator_);
    const float phi = std::uniform_real_distribution(0.0f, 6.2831853f)(generator_);
    const float r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::mt19937 generator_{7};
};

TEST(TabulatedBrdf, AnglesLeadBackToTheDirections) {
  Directions random;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 l = random(), v = random();
    const HalfDifference angles = halfDifference(l, v);
    EXPECT_GE(angles.phiD, 0);
    EXPECT_LT(angles.phiD, static_cast<float>(kPi));
    const DirectionPair back = directions(angles);
    // Up to a turn around the normal and the names of the two.
    EXPECT_NEAR(glm::dot(back.l, back.v), glm::dot(l, v), 1e-5f);
    EXPECT_NEAR(std::min(back.l.z, back.v.z), std::min(l.z, v.z), 1e-5f);
    EXPECT_NEAR(std::max(back.l.z, back.v.z), std::max(l.z, v.z), 1e-5f);
    EXPECT_NEAR(std::cos(angles.thetaH), glm::normalize(l + v).z, 1e-5f);
    EXPECT_NEAR(std::cos(angles.thetaD), glm::dot(glm::normalize(l + v), l), 1e-5f);
  }
}

TEST(TabulatedBrdf, AnglesOfSpecialDirections) {
  const glm::vec3 n(0, 0, 1), side(0.6f, 0, 0.8f);
  const HalfDifference same = halfDifference(n, n);
  EXPECT_EQ(same.thetaH, 0);
  EXPECT_EQ(same.thetaD, 0);
  const HalfDifference mirror = halfDifference(side, {-0.6f, 0, 0.8f});
  EXPECT_NEAR(mirror.thetaH, 0, 1e-7f);
  EXPECT_NEAR(mirror.thetaD, std::asin(0.6f), 1e-6f);
  // In the plane of incidence phiD is 0, across it pi/2.
  EXPECT_NEAR(std::sin(halfDifference(side, n).phiD), 0, 1e-6f);
  EXPECT_NEAR(halfDifference({0.5f, 0.5f, std::sqrt(0.5f)}, {0.5f, -0.5f, std::sqrt(0.5f)}).phiD, kPi / 2,
              1e-6);
  const HalfDifference opposite = halfDifference({1, 0, 0}, {-1, 0, 0});
  EXPECT_FALSE(std::isnan(opposite.thetaH + opposite.thetaD + opposite.phiD));
}

/// A table whose values are given by its coordinates, [0, 1) each.
TabulatedBrdf fromCoordinates(const glm::ivec3& size, const std::function<float(const glm::vec3&)>& value) {
  TabulatedBrdf table{.size = size, .values = {}};
  for (int i = 0; i < size.x; ++i)
    for (int j = 0; j < size.y; ++j)
      for (int k = 0; k < size.z; ++k) table.values.emplace_back(value(glm::vec3(i, j, k) / glm::vec3(size)));
  return table;
}

// What is linear in the coordinates comes back exactly, which it would not if nodes stood half a step
// elsewhere.
TEST(TabulatedBrdf, IsLinearBetweenNodes) {
  const TabulatedBrdf table = fromCoordinates(
      {12, 10, 8}, [](const glm::vec3& u) { return 1 + 2 * u.x + 3 * u.y + 4 * std::abs(u.z - 0.5f); });
  Directions random;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 l = random(), v = random();
    const HalfDifference a = halfDifference(l, v);
    const float x = std::min(std::sqrt(a.thetaH * 2 / static_cast<float>(kPi)), 11.0f / 12);
    const float y = std::min(a.thetaD * 2 / static_cast<float>(kPi), 9.0f / 10),
                z = a.phiD / static_cast<float>(kPi);
    EXPECT_NEAR(table.evaluate(l, v).x, 1 + 2 * x + 3 * y + 4 * std::abs(z - 0.5f), 1e-4f);
  }
}

TEST(TabulatedBrdf, NodesHoldTheFunction) {
  const Microfacets metal{.m = 0.3};
  const TabulatedBrdf table = tabulate({20, 12, 10}, metal);
  int compared = 0;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 12; ++j)
      for (int k = 0; k < 10; ++k) {
        const auto [l, v] = directions(table.node(i, j, k));
        if (l.z < 0.05f || v.z < 0.05f) continue;
        const glm::vec3 found = table.evaluate(l, v), exact = metal(l, v);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], exact[c], 1e-3f * exact[c] + 1e-5f);
        ++compared;
      }
  EXPECT_GT(compared, 1200);
}

TEST(TabulatedBrdf, IsReciprocalAndIsotropic) {
  std::mt19937 generator(3);
  TabulatedBrdf table{.size = {9, 8, 7}, .values = {}};
  for (int i = 0; i < 9 * 8 * 7; ++i)
    table.values.emplace_back(std::uniform_real_distribution(0.0f, 1.0f)(generator));
  Directions random;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 l = random(), v = random();
    const float f = table.evaluate(l, v).x;
    EXPECT_NEAR(table.evaluate(v, l).x, f, 1e-4f);
    const auto turned = [](const glm::vec3& d) {
      return glm::vec3(0.6f * d.x - 0.8f * d.y, 0.8f * d.x + 0.6f * d.y, d.z);
    };
    EXPECT_NEAR(table.evaluate(turned(l), turned(v)).x, f, 1e-4f);
  }
}

TEST(TabulatedBrdf, BelowTheHorizonAndEmptyIsZero) {
  const TabulatedBrdf white = fromCoordinates({1, 1, 1}, [](const glm::vec3&) { return 1.0f; });
  const glm::vec3 n(0, 0, 1);
  EXPECT_EQ(white.evaluate(n, n), glm::vec3(1));
  EXPECT_EQ(white.evaluate(n, {1, 0, 0}), glm::vec3(0));
  EXPECT_EQ(white.evaluate({0.6f, 0, -0.8f}, n), glm::vec3(0));
  EXPECT_EQ(white.evaluate(n, glm::vec3(NAN)), glm::vec3(0));
  EXPECT_EQ(TabulatedBrdf{}.evaluate(n, n), glm::vec3(0));
  EXPECT_EQ(AnisotropicTable{}.evaluate(n, n), glm::vec3(0));
}

TEST(TabulatedBrdf, GapsAreFilledFromNeighbours) {
  // f depends on thetaH alone; a quarter of all nodes has no value.
  TabulatedBrdf table = fromCoordinates({10, 8, 8}, [](const glm::vec3& u) { return 1 + u.x; });
  const TabulatedBrdf whole = table;
  for (std::size_t node = 0; node < table.values.size(); ++node)
    if (node / 8 % 8 >= 6) table.values[node] = {1, -1, 1};
  ASSERT_TRUE(fillInvalid(table));
  for (std::size_t node = 0; node < table.values.size(); ++node)
    EXPECT_NEAR(table.values[node].y, whole.values[node].y, 0.05f);
  // A layer at a time, so that order does not matter: what lies between 1 and 3 is 2, across phiD's seam,
  // too.
  TabulatedBrdf seam{.size = {1, 1, 3}, .values = {glm::vec3(-1), glm::vec3(1), glm::vec3(3)}};
  ASSERT_TRUE(fillInvalid(seam));
  EXPECT_EQ(seam.values[0], glm::vec3(2));
  TabulatedBrdf none{.size = {1, 1, 2}, .values = {glm::vec3(-1), glm::vec3(-2)}};
  EXPECT_FALSE(fillInvalid(none));
  EXPECT_EQ(none.values[1], glm::vec3(-2));
}

TEST(TabulatedBrdf, FunctionsWithoutValuesAreRefused) {
  for (const float value : {NAN, -1.0f, INFINITY, 2e10f})
    EXPECT_THROW(tabulate({4, 4, 4}, [&](const glm::vec3&, const glm::vec3&) { return glm::vec3(value); }),
                 Error);
  // A pole at one place is a gap.
  const TabulatedBrdf table = tabulate({4, 4, 4}, [](const glm::vec3& l, const glm::vec3&) {
    return glm::vec3(l.z > 0.99f ? INFINITY : 1.0f);
  });
  for (const glm::vec3& f : table.values) EXPECT_EQ(f, glm::vec3(1));
}

// Published for other lights: 0.004, 0.010 and 0.003. The bounds are a quarter above, or the same.
TEST(TabulatedBrdf, SmallTablesOfMicrofacets) {
  const auto error = [](const Microfacets& exact) {
    const TabulatedBrdf table = tabulate({32, 16, 16}, exact);
    return compareOnSphere(lookup(table), exact).rms;
  };
  EXPECT_LT(error({.m = 0.3}), 0.005);
  EXPECT_LT(error({.m = 0.1}), 0.0125);
  EXPECT_LT(error(plastic(0.15)), 0.003);
}

TEST(TabulatedBrdf, HoldsTheMeanWhereTheFunctionIsNotReciprocal) {
  const TabulatedBrdf table =
      tabulate({6, 6, 6}, [](const glm::vec3& l, const glm::vec3&) { return glm::vec3(l.z); });
  const auto [l, v] = directions(table.node(2, 2, 1));
  EXPECT_NEAR(table.evaluate(l, v).x, 0.5f * (l.z + v.z), 1e-5f);
}

TEST(TabulatedBrdf, AlbedoOfClosedForms) {
  const glm::vec3 high = glm::normalize(glm::vec3(0.2f, 0.1f, 1)),
                  low = glm::normalize(glm::vec3(3, 1, 0.5f));
  for (const glm::vec3& v : {high, low, glm::vec3(0, 0, 1)}) {
    const glm::dvec3 lambert = albedoOfBrdf([](auto&, auto&) { return glm::vec3(0.159154943f); }, v);
    EXPECT_NEAR(lambert.x, 0.5, 5e-4);
    // int cos^2 = 2 pi / 3.
    const glm::dvec3 cosine = albedoOfBrdf([](const glm::vec3& l, auto&) { return glm::vec3(l.z); }, v);
    EXPECT_NEAR(cosine.x, 2 * kPi / 3, 2e-3);
  }
  EXPECT_EQ(albedoOfBrdf([](auto&, auto&) { return glm::vec3(1); }, {1, 0, 0}), glm::dvec3(0));
}

// White microfacets head-on lose only what the lobe sends below the horizon: next to nothing at m = 0.1.
TEST(TabulatedBrdf, AlbedoOfATable) {
  const Microfacets mirror{.m = 0.1, .eta = glm::dvec3(1), .k = glm::dvec3(1e6)};
  const TabulatedBrdf table = tabulate({90, 90, 30}, mirror);
  const glm::vec3 v = glm::normalize(glm::vec3(0.5f, 0, 1));
  EXPECT_NEAR(albedoOfBrdf(mirror, v).x, 1, 5e-3);
  EXPECT_NEAR(albedoOfBrdf(lookup(table), v).x, albedoOfBrdf(mirror, v).x, 5e-3);
}

TEST(AnisotropicTable, TexelsHoldTheFunctionAndLinesBetweenThem) {
  // Linear in the coordinates of the square, of which the horizon is the edge.
  const AnisotropicTable places{.size = 6, .values = {}};
  const auto f = [](const glm::vec3& l, const glm::vec3& v) {
    return glm::vec3(l.z + 2 * v.z, l.x * v.y, l.y);
  };
  const AnisotropicTable table = tabulateAnisotropic(6, f);
  for (int a = 0; a < 36; ++a)
    for (int b = 0; b < 36; ++b) {
      const glm::vec3 l = places.texelDirection(a % 6, a / 6), v = places.texelDirection(b % 6, b / 6);
      EXPECT_NEAR(glm::length(l), 1, 1e-6f);
      EXPECT_GT(l.z, 0);
      const glm::vec3 difference = table.evaluate(l, v) - f(l, v);
      EXPECT_LT(glm::length(difference), 1e-5f);
    }
}

TEST(AnisotropicTable, ConvergesOnSmoothFunctions) {
  const auto f = [](const glm::vec3& l, const glm::vec3& v) { return glm::vec3(1 + l.x * v.x + l.y * l.z); };
  const auto error = [&](int size) {
    const AnisotropicTable table = tabulateAnisotropic(size, f);
    return compareOnSphere([&](auto& l, auto& v) { return table.evaluate(l, v); }, f).rms;
  };
  const double coarse = error(8), fine = error(16);
  EXPECT_LT(coarse, 0.05);
  EXPECT_LT(fine, 0.6 * coarse);
  const AnisotropicTable one = tabulateAnisotropic(1, f);
  EXPECT_EQ(one.evaluate({0.6f, 0, 0.8f}, {0, 0, 1}), glm::vec3(1));
}

}  // namespace
}  // namespace limn::brdf
