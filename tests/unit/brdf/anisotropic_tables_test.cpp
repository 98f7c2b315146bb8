// Tables of the models that turn with the tangent, Ward's and Banks's, against the models.
#include "core/brdf/anisotropic_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/brdf/factor_fit.h"
#include "core/brdf/factor_fit_error.h"
#include "core/brdf/model_brdf.h"
#include "glsl/materials/factored.glsl"
#include "tests/unit/brdf/exact_models.h"
#include "tests/unit/materials/models.h"

namespace limn::brdf {
namespace {

using glm::dvec2;
using glm::dvec3;
using std::numbers::pi;

Ward aluminium(double along, double across) {
  return {.eta = {1.35, 0.97, 0.62}, .k = {7.5, 6.4, 5.3}, .roughness = {along, across}};
}

dvec3 direction(double cosine, double azimuth) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

/// f from the equations, with masking by the slope's width along the azimuth of each direction.
Brdf exactWard(const Ward& material) {
  return [material](const dvec3& l, const dvec3& v) {
    const dvec3 h = glm::normalize(l + v);
    const dvec2 m = material.roughness;
    const double slope2 = std::pow(h.x / (h.z * m.x), 2) + std::pow(h.y / (h.z * m.y), 2);
    const double d = std::exp(-slope2) / (pi * m.x * m.y * std::pow(h.z, 4));
    const auto lambda = [&](const dvec3& w) {
      const double azimuth = std::atan2(w.y, w.x);
      return exactLambda(w.z, std::hypot(m.x * std::cos(azimuth), m.y * std::sin(azimuth)));
    };
    const double ofL = lambda(l), ofV = lambda(v);
    const double g =
        material.masking == Masking::correlated ? 1 / (1 + ofL + ofV) : 1 / ((1 + ofL) * (1 + ofV));
    dvec3 f;
    for (int c = 0; c < 3; ++c)
      f[c] = exactFresnel(std::min(glm::dot(l, h), 1.0), {material.eta[c], -material.k[c]}) * d * g /
             (4 * l.z * v.z);
    return f;
  };
}

/// The lobe as the largest r.v over the normals of a fibre: with the angles a and b of l and v to the plane
/// across it, cos(a + b).
Brdf exactBanks(const Banks& material) {
  return [material](const dvec3& l, const dvec3& v) {
    const double cosine = std::cos(std::asin(l.x) + std::asin(v.x));
    return material.kd * std::sqrt(1 - l.x * l.x) +
           material.ks * (cosine > 0 ? std::pow(cosine, material.exponent) : 0.0);
  };
}

Banks hair(double exponent) {
  return {.kd = dvec3(0), .ks = {0.4, 0.3, 0.2}, .exponent = exponent};
}

/// The error in a picture, recorded.
double pictureError(const Brdf& exact, const FactoredBrdf& tables, const std::string& name) {
  const SpherePicture picture(exact, 96);
  const double error = picture.errorOf([&](const dvec3& l, const dvec3& v) { return tables.evaluate(l, v); });
  testing::Test::RecordProperty(name, std::to_string(error));
  return error;
}

// The integral of D n.h over the projected hemisphere is 1, that is of D over the disc of (h.t, h.b).
TEST(AnisotropicTables, SlopesCoverTheSurfaceOnce) {
  for (const dvec2 m : {dvec2(0.05, 0.5), dvec2(0.3, 0.1), dvec2(1, 1)}) {
    const Ward material{.roughness = m};
    double sum = 0;
    constexpr int kSteps = 1500;
    for (int y = 0; y < kSteps; ++y)
      for (int x = 0; x < kSteps; ++x) {
        const dvec2 root = dvec2(x + 0.5, y + 0.5) / double(kSteps);  // strata crowd around n
        sum += slopeDistribution(material, root * root) * 4 * root.x * root.y;
      }
    // d(omega) n.h = dx dy, in four quadrants.
    EXPECT_NEAR(4 * sum / (kSteps * kSteps), 1, 1e-4) << m.x << ' ' << m.y;
  }
}

TEST(AnisotropicTables, EqualRoughnessIsBeckmannsDistribution) {
  for (double m : {0.05, 0.3, 1.0})
    for (double angle : {0.0, 0.1, 0.7, 1.5}) {
      const double sine = std::sin(angle);
      TorranceSparrow round;
      round.roughness = m;
      const double expected = normalDistribution(round, std::sqrt(2.0) * std::sin(angle / 2));
      EXPECT_NEAR(slopeDistribution({.roughness = dvec2(m)}, {0.6 * sine, -0.8 * sine}), expected,
                  1e-9 * expected + 1e-12);
    }
}

TEST(AnisotropicTables, FineTablesAreTheModels) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  Ward independent = aluminium(0.1, 0.4);
  independent.masking = Masking::product;
  const Banks silk{.kd = {0.1, 0.05, 0}, .ks = {0.3, 0, 0.2}, .exponent = 32};
  constexpr int kTexels = 512;
  struct Case {
    Brdf exact;
    FactoredBrdf tables;
  };
  const Case cases[] = {
      {exactWard(aluminium(0.1, 0.4)), wardTables(aluminium(0.1, 0.4), kTexels, true, TableFormat::float32)},
      {exactWard(aluminium(1, 0.2)), wardTables(aluminium(1, 0.2), kTexels, false, TableFormat::float32)},
      {exactWard(independent), wardTables(independent, kTexels, true, TableFormat::float32)},
      {exactBanks(silk), banksTable(silk, kTexels, TableFormat::float32)}};
  for (const Case& c : cases) {
    const dvec3 largest = c.exact({0, 0, 1}, {0, 0, 1});
    for (int i = 0; i < 2000; ++i) {
      const dvec3 l = direction(0.05 + 0.95 * uniform(random), 6.28 * uniform(random));
      const dvec3 v = direction(0.05 + 0.95 * uniform(random), 6.28 * uniform(random));
      const dvec3 expected = c.exact(l, v) * l.z, found = c.tables.evaluate(l, v);
      // Roots of 1 - (w.t)^2 are infinitely steep at a fibre's end: linear interpolation between places d
      // apart errs by up to sqrt(2 d) / 4 there.
      const double apart = 2.0 / (kTexels - 1);
      const bool end = c.tables.factorisation == Factorisation::fibres &&
                       std::max(std::abs(l.x), std::abs(v.x)) > 1 - 8 * apart;
      for (int channel = 0; channel < 3; ++channel) {
        const double more = end ? c.tables.scale[channel] * l.z * std::sqrt(2 * apart) / 4 : 0;
        EXPECT_NEAR(found[channel], expected[channel],
                    2e-3 * expected[channel] + 2e-4 * largest[channel] + more)
            << c.tables.name << ' ' << l.z << ' ' << v.z;
      }
    }
  }
}

// glsl/materials/ward.glsl and banks.glsl, with what a material's numbers mean there.
TEST(AnisotropicTables, TheExactModelsAreTheRenderers) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(0, 1);
  const std::vector<glm::vec3> none;
  const Ward metal{.eta = dvec3(1e-3), .k = dvec3(1000), .roughness = {0.1, 0.4}};
  const Banks fibres{.kd = dvec3(0.1), .ks = dvec3(0.3), .exponent = 32};
  const std::pair<Brdf, Brdf> pairs[] = {
      {exactWard(metal), modelBrdf(glsl::microfacets(glsl::model_ward, {0.1f, 0.4f}), none)},
      {exactBanks(fibres), modelBrdf(glsl::banksModel(0.1f, 0.3f, 32), none)}};
  for (const auto& [exact, model] : pairs)
    for (int i = 0; i < 1000; ++i) {
      const dvec3 l = direction(0.05 + 0.95 * uniform(random), 6.28 * uniform(random));
      const dvec3 v = direction(0.05 + 0.95 * uniform(random), 6.28 * uniform(random));
      const double expected = exact(l, v).x;
      EXPECT_NEAR(model(l, v).x, expected, 1e-4 * expected + 1e-6) << l.z << ' ' << v.z;
    }
}

// D over square roots: 2.4e-3 at 64 texels for roughness 0.05 and 0.5, and over angle and azimuth 1.1e-2.
TEST(AnisotropicTables, RootsHoldNarrowLobesWhereAnglesDoNot) {
  const Brdf exact = exactWard(aluminium(0.05, 0.5));
  const auto error = [&](int texels, bool warped) {
    const FactoredBrdf tables = wardTables(aluminium(0.05, 0.5), texels, warped, TableFormat::half);
    return pictureError(exact, tables, (warped ? "roots_" : "angles_") + std::to_string(texels));
  };
  EXPECT_NEAR(error(64, true), 2.4e-3, 4e-4);
  EXPECT_NEAR(error(64, false), 1.1e-2, 2e-3);
  EXPECT_LE(error(128, true), 1e-3);
}

TEST(AnisotropicTables, HundredAndTwentyEightTexelsSuffice) {
  for (const dvec2 m : {dvec2(0.1, 0.1), dvec2(0.1, 0.4), dvec2(0.5, 0.15), dvec2(0.3, 1)}) {
    const Ward material = aluminium(m.x, m.y);
    EXPECT_LE(pictureError(exactWard(material), wardTables(material, 128, true, TableFormat::half),
                           "ward_" + std::to_string(m.x) + "_" + std::to_string(m.y)),
              3e-3);
  }
  EXPECT_LE(pictureError(exactBanks(hair(32)), banksTable(hair(32), 128, TableFormat::half), "banks_32"),
            2e-3);
  // Linear interpolation of a lobe of width 1 / sqrt(p) errs by p over the square of the number of texels.
  EXPECT_LE(pictureError(exactBanks(hair(200)), banksTable(hair(200), 128, TableFormat::half), "banks_200"),
            2e-3 * 200 / 32);
}

// Over the root of h.l. An index of 200 has a dip of Fresnel's term at 89.7 degrees: 64 texels miss it.
TEST(AnisotropicTables, RowsOfFresnelsTermHoldItsDip) {
  const auto worst = [](double eta, int texels) {
    const Ward material{.eta = dvec3(eta), .k = dvec3(0), .roughness = dvec2(0.1)};
    const FactoredBrdf tables = wardTables(material, texels, true, TableFormat::float32);
    double most = 0;
    constexpr int kSteps = 100000;
    for (int i = 0; i <= kSteps; ++i) {
      const double root = static_cast<double>(i) / kSteps;
      const glm::vec3 found =
          glsl::factored_lookup(tables.tables[1], glm::vec2(static_cast<float>(root), 0.f), 0);
      most = std::max(most, std::abs(static_cast<double>(found.x) - fresnelReflectance(root * root, eta, 0)));
    }
    testing::Test::RecordProperty("fresnel_" + std::to_string(int(eta)) + "_" + std::to_string(texels),
                                  std::to_string(most));
    return most;
  };
  EXPECT_LE(worst(1.5, 64), 4e-4);
  EXPECT_LE(worst(5, 64), 7e-4);
  EXPECT_LE(worst(200, 256), 1.6e-3);
  EXPECT_GT(worst(200, 64), 0.02);
}

// A distribution wider than sqrt(1/2) is largest away from n; bytes end at the largest value.
TEST(AnisotropicTables, BytesHoldTheWidestDistributionUncut) {
  const Ward material = aluminium(1, 0.5);
  EXPECT_LE(pictureError(exactWard(material), wardTables(material, 128, true, TableFormat::byte), "byte"),
            0.01);
}

TEST(AnisotropicTables, TablesAreAsLargeAsTheySay) {
  EXPECT_EQ(wardTables(aluminium(0.1, 0.4), 64, true, TableFormat::half).bytes(), (64u + 2) * 64 * 6);
  EXPECT_EQ(banksTable(hair(32), 64, TableFormat::half).bytes(), 64u * 64 * 6);
}

TEST(AnisotropicTables, ExtremesAreFinite) {
  const dvec3 up(0, 0, 1), along(1, 0, 0), across(0, 1, 0), low = direction(1e-6, 0),
                                                            back = direction(1e-6, pi);
  const auto expectFinite = [&](const FactoredBrdf& tables) {
    for (const dvec3& l : {up, along, across, low, back, -up})
      for (const dvec3& v : {up, along, across, low, back, -up}) {
        const dvec3 f = tables.evaluate(l, v);
        for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(f[c]) && f[c] >= 0) << tables.name;
      }
  };
  for (TableFormat format : {TableFormat::float32, TableFormat::half, TableFormat::byte}) {
    for (const dvec2 m : {dvec2(0), dvec2(0, 1), dvec2(1)})
      for (double eta : {1.0, 200.0})
        for (Masking masking : {Masking::correlated, Masking::product})
          for (bool warped : {false, true})
            expectFinite(wardTables({.eta = dvec3(eta), .k = dvec3(0), .roughness = m, .masking = masking}, 2,
                                    warped, format));
    for (double exponent : {0.0, 32.0, 1e6}) {
      expectFinite(banksTable(hair(exponent), 2, format));
      expectFinite(banksTable({.kd = dvec3(0), .ks = dvec3(0), .exponent = exponent}, 2, format));
    }
  }
}

TEST(AnisotropicTables, SettingsThatMakeNoTablesAreNamed) {
  EXPECT_THROW(wardTables(aluminium(0.1, 0.4), 1, true, TableFormat::half), UsageError);
  EXPECT_THROW(wardTables(aluminium(0.1, 1.1), 64, true, TableFormat::half), UsageError);
  EXPECT_THROW(wardTables(aluminium(std::nan(""), 0.1), 64, true, TableFormat::half), UsageError);
  Ward material;
  material.eta.y = 0;
  EXPECT_THROW(wardTables(material, 64, true, TableFormat::half), UsageError);
  EXPECT_THROW(banksTable(hair(32), 1, TableFormat::half), UsageError);
  EXPECT_THROW(banksTable(hair(-1), 64, TableFormat::half), UsageError);
  EXPECT_THROW(banksTable({.kd = dvec3(-0.1), .ks = dvec3(0)}, 64, TableFormat::half), UsageError);
  FitSettings settings;
  settings.factorisation = Factorisation::fibres;
  EXPECT_THROW(fitBrdf(exactBanks(hair(32)), settings), UsageError);
}

}  // namespace
}  // namespace limn::brdf
