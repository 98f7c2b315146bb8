// Energy and reciprocity of the material models.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/unit/materials/models.h"

namespace limn::glsl {
namespace {

const std::vector<double> kEnergyCosines = {0.01, 0.05, 0.2, 0.6, 1};

/// The model with kd and ks as the loader limits them.
MaterialModel limited(MaterialModel m) {
  const float most = std::max(model_excess(m), 1.f);
  m.kd /= most;
  m.ks /= most;
  return m;
}

/// The floor of microfacets is added to their lobe.
double allowed(const MaterialModel& m) {
  const bool microfacets = m.kind == model_torrance_sparrow || m.kind == model_ward;
  return 1 + 1e-3 + (microfacets ? double(m.kd.x) : 0.0);
}

TEST(MaterialEnergy, NoModelReflectsMoreThanArrives) {
  for (const NamedModel& named : allModels()) {
    const MaterialModel m = limited(named.model);
    for (const double azimuth : {0.0, 1.2})
      for (const double c : kEnergyCosines)
        if (azimuth == 0 || model_anisotropic(m)) {
          EXPECT_LE(furnace(m, directionAt(c, azimuth)), allowed(m))
              << named.name << ' ' << c << ' ' << azimuth;
        }
  }
}

/// From below the horizon, where shading normals turn to, no more is reflected either. Next to it, the half
/// vectors of float directions at roughness 0.001 have 3 % of noise, which adds up to 0.05 %.
TEST(MaterialEnergy, NorDoesItFromBelowTheHorizon) {
  for (const NamedModel& named : allModels())
    for (const double c : {0.0, -0.05, -0.3}) {
      const MaterialModel m = limited(named.model);
      EXPECT_LE(furnace(m, directionAt(c, 0.6)), allowed(m) + 5e-4) << named.name << ' ' << c;
    }
}

/// Beckmann's masking hides too few of the normals of the other distribution.
TEST(MaterialEnergy, GainOfTheGaussianOfTheAngleIsABound) {
  for (const uint options : {0u, model_option_product})
    for (const float m : {0.05f, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f, 0.9f, 1.f}) {
      const MaterialModel model =
          microfacets(model_torrance_sparrow, vec2(m), options | model_option_gaussian);
      EXPECT_LE(furnace(model, vec3(1, 0, 0)), 1.0005 + double(gaussian_angle_gain(model))) << m;
    }
  const auto gain = [](float m, uint options) {
    return furnace(microfacets(model_torrance_sparrow, vec2(m), options | model_option_gaussian),
                   vec3(1, 0, 0)) -
           1;
  };
  EXPECT_NEAR(gain(0.1f, 0), 0.0016, 5e-4);
  EXPECT_NEAR(gain(0.5f, 0), 0.042, 1e-3);
  EXPECT_NEAR(gain(0.9f, 0), 0.088, 1e-3);
  EXPECT_NEAR(gain(0.6f, model_option_product), 0.008, 1e-3);
}

TEST(MaterialEnergy, NarrowMirrorsReflectAll) {
  for (const uint kind : {model_torrance_sparrow, model_ward})
    for (const uint options : {0u, model_option_product})
      for (const float m : {1e-3f, 0.01f}) {
        for (const double c : {0.2, 0.5, 1.0})
          EXPECT_NEAR(furnace(microfacets(kind, vec2(m), options), directionAt(c, 0.4)), 1, 1e-3)
              << m << ' ' << c;
      }
  EXPECT_NEAR(
      furnace(microfacets(model_torrance_sparrow, vec2(0.01f), model_option_gaussian), directionAt(0.5, 0)),
      1, 1e-3);
}

/// A narrow lobe has the reflectance of the interface.
TEST(MaterialEnergy, NarrowLobesReflectFresnelsShare) {
  MaterialModel m = microfacets(model_torrance_sparrow, vec2(0.01f));
  m.k = vec3(0);
  for (const float eta : {1.f, 1.0001f, 1.5f, 5.f, 200.f})
    for (const double c : {0.3, 0.7, 1.0}) {
      m.eta = vec3(eta);
      EXPECT_NEAR(furnace(m, directionAt(c, 0)), double(fresnel(float(c), eta, 0)), 1e-3) << eta << ' ' << c;
    }
}

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

/// The share of the power lobe above the horizon: (1 + n.v) / 2 at p = 1, all of it for n = v, half of it at
/// n.v = 0.
TEST(MaterialEnergy, PhongReflectsTheShareOfItsLobeAboveTheHorizon) {
  for (const double c : {0.0, 0.01, 0.2, 0.5, 0.8, 1.0}) {
    EXPECT_NEAR(furnace(phongModel(0, 1, 1), directionAt(c, 1)), 0.5 * (1 + c), 5e-4) << c;
    EXPECT_NEAR(furnace(phongModel(0.3f, 0.7f, 1), directionAt(c, 1)), 0.3 + 0.35 * (1 + c), 5e-4) << c;
    EXPECT_NEAR(furnace(phongModel(0, 1, 0), directionAt(c, 1)), 1 - std::acos(c) / M_PI, 1e-3) << c;
  }
  for (const float p : {0.f, 1.f, 10.f, 100.f, 1000.f, 1e5f}) {
    EXPECT_NEAR(furnace(phongModel(0, 1, p), vec3(0, 0, 1)), 1, 1e-4) << p;
    EXPECT_NEAR(furnace(phongModel(0, 1, p), vec3(1, 0, 0)), 0.5, 1e-3) << p;
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

TEST(MaterialEnergy, CosinePowersHaveTheIntegralOfTheGammaFunction) {
  for (const float p : {0.f, 0.25f, 1.f, 2.f, 10.f, 100.f, 1e4f, 1e6f}) {
    const double x = 0.5 * double(p);
    const double exact = std::sqrt(M_PI) * std::exp(std::lgamma(x + 0.5) - std::lgamma(x + 1));
    EXPECT_NEAR(double(cosine_power_integral(p)) / exact, 1, 1e-5) << p;
  }
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
          EXPECT_LE(furnace(m, directionAt(c, azimuth), 10000), double(banks_excess(m)) + 1e-3)
              << options << ' ' << p << ' ' << c << ' ' << azimuth;
        }
}

/// 1 with the mirror for a white base (physical), F more (sum); the ratios of the three at albedo 1/2.
TEST(MaterialEnergy, CoatsHaveTheirClosedForms) {
  for (const float eta : {1.f, 1.0001f, 1.5f, 5.f, 200.f})
    for (const double c : kEnergyCosines) {
      const vec3 v = directionAt(c, 0);
      const double mirror = double(coated_mirror(coatedModel(1, eta, 0), v.z).x);
      EXPECT_NEAR(furnace(coatedModel(1, eta, model_option_physical), v) + mirror, 1, 1e-3)
          << eta << ' ' << c;
      EXPECT_NEAR(furnace(coatedModel(1, eta, model_option_blend), v) + mirror, 1, 1e-4) << eta << ' ' << c;
      EXPECT_NEAR(furnace(coatedModel(0.7f, eta, 0), v), 0.7, 1e-4);
    }
  const MaterialModel sum = coatedModel(1, 1.5f, 0);
  EXPECT_NEAR(1 + coated_mirror(sum, 1).x, 1.04, 1e-3);
  EXPECT_NEAR(1 + coated_mirror(sum, 0.2f).x, 1.34, 0.02);
  const vec3 v = directionAt(0.7, 0);
  EXPECT_NEAR(furnace(coatedModel(0.5f, 1.5f, model_option_blend), v) /
                  furnace(coatedModel(0.5f, 1.5f, model_option_physical), v),
              1.74, 0.005);
}

/// Coats that absorb, whose mean of F is within 0.0075, and coats of a thinner medium than air.
TEST(MaterialEnergy, AlbedoOfAnyCoatIsTheMeanFurnace) {
  for (const vec2 index : {vec2(1.5f, 1), vec2(1.5f, 2), vec2(0.9f, 0), vec2(0.5f, 0)})
    for (const uint options : {model_option_blend, model_option_physical}) {
      MaterialModel m = coatedModel(1, index.x, options);
      m.k = vec3(index.y);
      constexpr int rings = 64;
      double mean = 0;
      for (int i = 0; i < rings; ++i)
        mean += furnace(m, directionAt(std::sqrt((i + 0.5) / rings), 0), 4000) / rings;
      EXPECT_NEAR(double(model_albedo(m).x), mean, 0.015) << index.x << ' ' << index.y << ' ' << options;
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

/// The estimate of the hemispherical reflectance, against the mean of furnaces.
TEST(MaterialEnergy, AlbedoIsAboutTheMeanFurnace) {
  for (const NamedModel& named : allModels()) {
    constexpr int rings = 8;
    double mean = 0;
    const int sectors = model_anisotropic(named.model) ? 4 : 1;
    for (int i = 0; i < rings; ++i)
      for (int j = 0; j < sectors; ++j)
        mean += furnace(named.model,
                        directionAt(std::sqrt((i + 0.5) / rings), M_PI / 2 * (j + 0.5) / sectors), 10000) /
                (rings * sectors);
    EXPECT_NEAR(double(model_albedo(named.model).x), mean, 0.05) << named.name;
  }
}

}  // namespace
}  // namespace limn::glsl
