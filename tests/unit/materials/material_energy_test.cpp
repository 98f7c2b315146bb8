// Energy and reciprocity of the material models.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/unit/materials/models.h"

namespace limn::glsl {
namespace {

/// The floor adds its albedo, and ks scales the lobe.
TEST(MaterialEnergy, PartsAddUp) {
  for (const uint kind : {model_torrance_sparrow, model_ward}) {
    MaterialModel m = microfacets(kind, vec2(0.3f));
    const vec3 v = directionAt(0.6, 0.2);
    const double lobe = furnace(m, v);
    m.kd = vec3(0.25f);
    m.ks = vec3(0.5f);
    EXPECT_NEAR(furnace(m, v), 0.25 + 0.5 * lobe, 2e-4);
  }
}

/// int_0^pi 2 sin^2 a max(-cos(a + b), 0)^p da, b: the angle of v to the tangent.
double coneIntegral(double p, double b) {
  constexpr int n = 100000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double a = M_PI * (i + 0.5) / n;
    sum += 2 * std::sin(a) * std::sin(a) * std::pow(std::max(-std::cos(a + b), 0.0), p) * M_PI / n;
  }
  return sum;
}

TEST(MaterialEnergy, BanksHasItsIntegrals) {
  for (const double azimuth : {0.0, 0.5, 1.5})
    for (const double c : {0.05, 0.5, 1.0}) {
      const vec3 v = directionAt(c, azimuth);
      for (const uint options : {0u, model_option_printed})
        EXPECT_NEAR(furnace(banksModel(1, 0, 32, options), v), 8.0 / 3, 2e-3) << c << ' ' << azimuth;
      for (const float p : {1.f, 2.f, 32.f, 1000.f}) {
        const double lobe = furnace(banksModel(0, 1, p), v);
        EXPECT_NEAR(lobe, coneIntegral(double(p), std::acos(double(v.x))), 1e-3 * lobe + 1e-4)
            << p << ' ' << c;
        EXPECT_LE(lobe, 2 * std::sqrt(2 * M_PI / double(p)));
      }
    }
  const double p = 32;  // across the tangent, in closed form
  EXPECT_NEAR(furnace(banksModel(0, 1, 32), vec3(0, 0, 1)),
              2 * std::sqrt(M_PI) * std::exp(std::lgamma(0.5 * p + 1.5) - std::lgamma(0.5 * p + 2)), 1e-3);
}

/// With equal l.t and v.t, n'.h falls from .999 to .757 as l and v turn apart; the lobe of Stalling et al.
/// does not change.
TEST(MaterialEnergy, OnlyStallingsBanksIsAFunctionOfTheTwoAnglesToTheTangent) {
  const auto at = [](double azimuth) {
    const double along = 0.0447, across = std::sqrt(1 - along * along);
    return vec3(float(along), float(across * std::sin(azimuth)), float(across * std::cos(azimuth)));
  };
  EXPECT_NEAR(banks_printed_lobe(1, at(0), at(0)), 0.999, 5e-4);
  EXPECT_NEAR(banks_printed_lobe(1, at(-0.71), at(0.71)), 0.757, 2e-3);
  EXPECT_NEAR(banks_cone_lobe(1, at(-0.71), at(0.71)), banks_cone_lobe(1, at(0), at(0)), 1e-6);
}

/// Where the scale is applied, all of Banks' energy is in bounds: banks_excess() is the largest furnace or
/// more.
TEST(MaterialEnergy, ExcessOfBanksIsABound) {
  for (const uint options : {0u, model_option_printed})
    for (const float p : {0.f, 1.f, 4.f, 8.f, 16.f, 100.f})
      for (const double c : {0.02, 0.5, 1.0})
        for (const double azimuth : {0.0, 0.8, 1.5}) {
          const MaterialModel m = banksModel(0.1f, 0.3f, p, options);
          EXPECT_LE(furnace(m, directionAt(c, azimuth), 128), double(banks_excess(m)) + 1e-3)
              << options << ' ' << p << ' ' << c << ' ' << azimuth;
        }
}

TEST(MaterialEnergy, ReciprocalModelsAreReciprocal) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit;
  for (const NamedModel& named : allModels()) {
    const MaterialModel& m = named.model;
    if (m.kind == model_banks || m.kind == model_phong || m.options == model_option_blend) continue;
    for (int i = 0; i < 300; ++i) {
      const vec3 v = directionAt(0.01 + 0.99 * unit(random), 6.28 * unit(random));
      const double width = double(std::min(m.roughness.x, m.roughness.y));
      const vec3 facet = directionAt(std::cos(std::min(2 * width, 1.0) * unit(random)), 6.28 * unit(random));
      const vec3 l = i % 3 == 0 ? directionAt(0.01 + 0.99 * unit(random), 6.28 * unit(random))
                                : normalize(2.f * dot(v, facet) * facet - v);
      if (!(l.z > 0.01f)) continue;
      const float there = model_response(m, v, l).y / l.z, back = model_response(m, l, v).y / v.z;
      ASSERT_NEAR(there, back, 2e-5f * there + 1e-30f) << named.name;
    }
  }
}

}  // namespace
}  // namespace limn::glsl
