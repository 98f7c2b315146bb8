// Fits of what nobody should want to fit: they end in finite tables or in one line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "core/base/error.h"
#include "core/brdf/factor_fit.h"
#include "core/brdf/factor_fit_solver.h"
#include "tests/unit/brdf/exact_models.h"

namespace limn::brdf {
namespace {

using glm::dvec3;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr Factorisation kAll[] = {Factorisation::tables,   Factorisation::dfg,      Factorisation::pqp,
                                  Factorisation::pqp_disc, Factorisation::dfg_disc, Factorisation::svd,
                                  Factorisation::trilinear};

FitSettings small(Factorisation factorisation, int texels = 8, int terms = 1) {
  FitSettings settings;
  settings.factorisation = factorisation;
  settings.texels = texels;
  settings.terms = terms;
  settings.samples = 2000;
  return settings;
}

/// Sums of as many products as one likes, up to two.
std::vector<int> termsOf(Factorisation factorisation) {
  return mostTerms(factorisation) > 1 ? std::vector{1, 2} : std::vector{1};
}

void expectFinite(const FactoredBrdf& fit) {
  EXPECT_TRUE(std::isfinite(fit.error)) << fit.name;
  for (const FactorTable& table : fit.tables)
    for (const glm::vec3& texel : table.texels)
      for (int c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(texel[c])) << fit.name;
  for (double lz : {1.0, 0.5, 1e-3, 0.0})
    for (double vz : {1.0, 0.5, 1e-3, 0.0})
      for (double azimuth : {0.0, 1.0, std::numbers::pi}) {
        const double ls = std::sqrt(1 - lz * lz), vs = std::sqrt(1 - vz * vz);
        const dvec3 f = fit.evaluate({ls * std::cos(azimuth), ls * std::sin(azimuth), lz}, {vs, 0, vz});
        for (int c = 0; c < 3; ++c)
          EXPECT_TRUE(std::isfinite(f[c]) && f[c] >= 0) << fit.name << ' ' << lz << ' ' << vz;
      }
}

TEST(FactorFitStability, TwoTexelsAreFinite) {
  for (Factorisation factorisation : kAll)
    for (int terms : termsOf(factorisation))
      expectFinite(fitBrdf(plastic(0.15f), small(factorisation, 2, terms)));
}

TEST(FactorFitStability, NothingToFitIsAnError) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (Factorisation factorisation : kAll) {
    const FitSettings settings = small(factorisation);
    EXPECT_THAT([&] { fitBrdf(nullptr, settings); }, ThrowsMessage<Error>(HasSubstr("no BRDF")));
    EXPECT_THAT([&] { fitBrdf([](auto&, auto&) { return dvec3(0); }, settings); },
                ThrowsMessage<Error>(HasSubstr("0 or less at every pair")));
    EXPECT_THAT([&] { fitBrdf([](auto&, auto&) { return dvec3(-1); }, settings); },
                ThrowsMessage<Error>(HasSubstr("0 or less at every pair")));
    EXPECT_THAT([&] { fitBrdf([&](auto&, auto&) { return dvec3(nan); }, settings); },
                ThrowsMessage<Error>(HasSubstr("not finite at any pair")));
  }
}

TEST(FactorFitStability, SettingsOutOfRangeAreNamed) {
  FitSettings settings;
  settings.texels = 1;
  EXPECT_THAT([&] { fitBrdf(metal(0.3f), settings); }, ThrowsMessage<UsageError>(HasSubstr("1 texels")));
  settings = small(Factorisation::svd, 64);
  EXPECT_THAT([&] { fitBrdf(metal(0.3f), settings); }, ThrowsMessage<UsageError>(HasSubstr("64 texels")));
  settings = small(Factorisation::svd);
  settings.terms = 0;
  EXPECT_THAT([&] { fitBrdf(metal(0.3f), settings); }, ThrowsMessage<UsageError>(HasSubstr("0 terms")));
  for (Factorisation factorisation : kAll) {
    settings = small(factorisation, 8, mostTerms(factorisation) + 1);
    EXPECT_THAT([&] { fitBrdf(metal(0.3f), settings); }, ThrowsMessage<UsageError>(HasSubstr(" terms: 1 ")));
  }
  for (const FitSettings& unfit : {small(Factorisation::trilinear), small(Factorisation::dfg, 8, 2)})
    EXPECT_THROW(bakedTables(fitBrdf(metal(0.3f), unfit), 8, true, TableFormat::half), UsageError);
}

// f = albedo / pi is a product of any kind, with a floor and without. Two tables hold n.l = x^2 over x,
// between whose 8 texels lines err by (1 / 7)^2 / 4 = 0.005 of n.l = 1, over pictures of n.l of about half.
double constantBound(Factorisation factorisation, bool floor) {
  return factorisation == Factorisation::tables && !floor ? 1e-2 : 5e-3;
}

TEST(FactorFitStability, ConstantsAreMet) {
  const dvec3 albedo(0.8, 0.5, 0);
  for (Factorisation factorisation : kAll)
    for (bool floor : {false, true})
      for (int terms : termsOf(factorisation)) {
        FitSettings settings = small(factorisation, 8, terms);
        settings.floor = floor;
        settings.samples = 10000;
        const FactoredBrdf fit = fitBrdf([&](auto&, auto&) { return albedo / std::numbers::pi; }, settings);
        expectFinite(fit);
        EXPECT_LT(fit.error, constantBound(factorisation, floor)) << fit.name << ' ' << floor;
      }
}

// For half vectors and differences on the horizon no light and view are above it: what svd has in those
// texels comes from their neighbours, and a constant is met by as many terms as one likes.
TEST(FactorFitStability, SvdMeetsConstantsUpToTheHorizon) {
  for (int terms : {1, 4}) {
    FitSettings settings = small(Factorisation::svd);
    settings.floor = false;
    settings.terms = terms;
    const FactoredBrdf fit = fitBrdf([](auto&, auto&) { return dvec3(0.5 / std::numbers::pi); }, settings);
    EXPECT_LT(fit.error, 1e-3) << terms;
    const dvec3 low(std::sqrt(1 - 1e-4), 0, 1e-2), back(-low.x, 0, 1e-2);
    EXPECT_NEAR(fit.evaluate(low, low).x / low.z, 0.5 / std::numbers::pi, 2e-3) << terms;
    EXPECT_NEAR(fit.evaluate(low, back).x / low.z, 0.5 / std::numbers::pi, 2e-3) << terms;
  }
}

TEST(FactorFitStability, NoiseNegativesAndHolesAreFinite) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 1);
  const Brdf clean = metal(0.3f);
  const Brdf noisy = [&](const dvec3& l, const dvec3& v) {
    const dvec3 f = clean(l, v) * (1 + 0.3 * noise(random)) + dvec3(0.05 * noise(random));
    return l.x > 0.9 ? dvec3(std::numeric_limits<double>::infinity()) : f;
  };
  for (Factorisation factorisation : kAll)
    for (int terms : termsOf(factorisation)) {
      FitSettings settings = small(factorisation, 16, terms);
      settings.samples = 8000;
      const FactoredBrdf fit = fitBrdf(noisy, settings);
      expectFinite(fit);
      EXPECT_LT(fit.error, 1) << fit.name;
    }
}

TEST(FactorFitStability, MirrorsAndOneChannelAreFinite) {
  for (Factorisation factorisation : kAll)
    for (int terms : termsOf(factorisation)) {
      expectFinite(fitBrdf(metal(1e-3f), small(factorisation, 8, terms)));
      const Brdf red = [exact = metal(0.3f)](const dvec3& l, const dvec3& v) {
        return exact(l, v) * dvec3(1, 0, 0);
      };
      const FactoredBrdf fit = fitBrdf(red, small(factorisation, 8, terms));
      expectFinite(fit);
      EXPECT_EQ(fit.evaluate({0, 0, 1}, {0, 0, 1}).y, 0) << fit.name;
    }
}

// Twice as much light as arrives: the fit reflects all of it, and no more.
TEST(FactorFitStability, MoreLightThanArrivesIsDividedOut) {
  const FactoredBrdf fit =
      fitBrdf([](auto&, auto&) { return dvec3(2, 1, 1) / std::numbers::pi; }, small(Factorisation::dfg));
  EXPECT_NEAR(fit.evaluate({0, 0, 1}, {0, 0, 1}).x * std::numbers::pi, 1, 0.01);
  EXPECT_NEAR(fit.evaluate({0, 0, 1}, {0, 0, 1}).y * std::numbers::pi, 0.5, 0.01);
}

TEST(SparseEquations, LeastSquaresOfAnOverdeterminedSystem) {
  // Line y = a + b x through (0, 1), (1, 2), (2, 4): b = 3 / 2, a = 5 / 6.
  SparseEquations equations;
  const double y[] = {1, 2, 4};
  for (int x = 0; x < 3; ++x) {
    equations.add(0, 1);
    equations.add(1, x);
    equations.finish(y[x]);
  }
  const std::vector<double> solution = equations.solve({0, 0, 7}, 10, 1e-14);
  EXPECT_NEAR(solution[0], 5.0 / 6, 1e-12);
  EXPECT_NEAR(solution[1], 1.5, 1e-12);
  EXPECT_EQ(solution[2], 7) << "no equation names it";
}

}  // namespace
}  // namespace limn::brdf
