// Factorisations of the renderer's own metals and plastic: error in a picture, light that is reflected.
#include "core/brdf/factor_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/brdf/factor_fit_error.h"
#include "core/brdf/groove.h"
#include "core/brdf/model_brdf.h"
#include "tests/unit/brdf/exact_models.h"

namespace limn::brdf {
namespace {

using glm::dvec3;

Response responseOf(const FactoredBrdf& fit) {
  return [&fit](const dvec3& l, const dvec3& v) { return fit.evaluate(l, v); };
}

FitSettings settingsOf(Factorisation factorisation, int texels, int terms = 1) {
  FitSettings settings;
  settings.factorisation = factorisation;
  settings.texels = texels;
  settings.terms = terms;
  return settings;
}

/// The largest difference of directional albedos up to 85 degrees.
double albedoError(const Brdf& exact, const FactoredBrdf& fit) {
  double worst = 0;
  for (int degrees : {0, 20, 40, 60, 75, 85}) {
    const double theta = degrees * std::numbers::pi / 180;
    const dvec3 v(std::sin(theta), 0, std::cos(theta));
    const dvec3 difference =
        albedoOfResponse(responseOf(fit), v) -
        albedoOfResponse([&](const dvec3& l, const dvec3& view) { return exact(l, view) * l.z; }, v);
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(difference[c]));
  }
  return worst;
}

FactoredBrdf fitted(const Brdf& brdf, const FitSettings& settings, const std::string& of = "") {
  FactoredBrdf fit = fitBrdf(brdf, settings);
  testing::Test::RecordProperty(fit.name + of, std::to_string(fit.error));
  return fit;
}

TEST(FactorFitError, TheExactModelHasNone) {
  const Brdf exact = metal(0.3f);
  const SpherePicture picture(exact, 64);
  EXPECT_EQ(picture.errorOf([&](const dvec3& l, const dvec3& v) { return exact(l, v) * l.z; }), 0);
  EXPECT_NEAR(picture.errorOf([&](const dvec3& l, const dvec3& v) { return 1.1 * exact(l, v) * l.z; }), 0.1,
              1e-12);
  EXPECT_NEAR(picture.errorOf([](const dvec3&, const dvec3&) { return dvec3(0); }), 1, 1e-12);
}

// What a fit says of itself is not by the picture that its floor was chosen by.
TEST(FactorFitError, IsThatUnderHeldOutLights) {
  const Brdf exact = plastic(0.3f);
  FitSettings settings = settingsOf(Factorisation::dfg, 16);
  settings.samples = 2000;
  const FactoredBrdf fit = fitBrdf(exact, settings);
  EXPECT_EQ(fit.error, SpherePicture(exact, 128, PictureLights::heldOut).errorOf(responseOf(fit)));
  EXPECT_NE(fit.error, SpherePicture(exact, 128, PictureLights::choosing).errorOf(responseOf(fit)));
}

TEST(FactorFitError, AlbedosOfClosedForms) {
  for (double cosine : {1.0, 0.5, 0.1}) {
    const dvec3 v(std::sqrt(1 - cosine * cosine), 0, cosine);
    const auto lambert = [](const dvec3& l, const dvec3&) { return dvec3(0.8 * l.z / std::numbers::pi); };
    EXPECT_NEAR(albedoOfResponse(lambert, v).x, 0.8, 2e-3) << cosine;
    // A cone of half vectors around n reflects a share of D's projected area: f n.l = D v.h / n.v has no
    // masking.
    TorranceSparrow narrow;
    narrow.roughness = 0.02;
    const auto facets = [&](const dvec3& l, const dvec3& view) {
      const dvec3 h = glm::normalize(l + view);
      return dvec3(exactDistribution(narrow, h) / (4 * view.z));
    };
    EXPECT_NEAR(albedoOfResponse(facets, dvec3(0, 0, 1)).x, 1, 1e-2);
  }
}

TEST(FactorFit, DfgOnMetals) {
  for (float alpha : {0.3f, 0.1f}) {
    const FactoredBrdf fit =
        fitted(metal(alpha), settingsOf(Factorisation::dfg, 64), " of " + std::to_string(alpha));
    EXPECT_LE(fit.error, 0.01) << alpha;
    EXPECT_LE(albedoError(metal(alpha), fit), 0.015) << alpha;
    EXPECT_EQ(fit.bytes(), 64u * 3 * 3 * 2);
  }
}

TEST(FactorFit, DfgOnPlastic) {
  FitSettings settings = settingsOf(Factorisation::dfg, 64);
  const FactoredBrdf fit = fitted(plastic(0.15f), settings);
  EXPECT_LE(fit.error, 0.02);
  EXPECT_LE(albedoError(plastic(0.15f), fit), 0.015);
  settings.refine = false;
  EXPECT_GT(fitBrdf(plastic(0.15f), settings).error, fit.error) << "Gauss-Newton is what meets the picture";
}

TEST(FactorFit, BakedIntoTwoTables) {
  const FactoredBrdf baked = fitted(metal(0.3f), settingsOf(Factorisation::tables, 128));
  EXPECT_EQ(baked.factorisation, Factorisation::tables);
  EXPECT_LE(baked.error, 0.01);
  const FactoredBrdf fit = fitted(metal(0.3f), settingsOf(Factorisation::dfg, 64));
  EXPECT_LE(SpherePicture([&](const dvec3& l, const dvec3& v) {
              return fit.evaluate(l, v) / l.z;
            }).errorOf(responseOf(bakedTables(fit, 128, true, TableFormat::half))),
            5e-3);
}

// A sum is no product: without its diffuse floor plastic is met several times worse.
TEST(FactorFit, HomomorphicNeedsTheFloorTakenOut) {
  FitSettings settings = settingsOf(Factorisation::pqp, 64);
  settings.refine = false;
  EXPECT_LE(fitted(metal(0.3f), settings, " of metal 0.3").error, 0.010);
  EXPECT_LE(fitted(metal(0.1f), settings, " of metal 0.1").error, 0.006);
  const double with = fitted(plastic(0.15f), settings, " of plastic").error;
  settings.floor = false;
  const double without = fitBrdf(plastic(0.15f), settings).error;
  EXPECT_GT(without, 2 * with);
}

// Over directions, a narrow lobe needs the disc warped towards n.
TEST(FactorFit, HomomorphicOverDiscs) {
  FitSettings settings = settingsOf(Factorisation::pqp_disc, 32);
  settings.warped = false;
  const double plain = fitted(metal(0.1f), settings).error;
  settings.warped = true;
  const double warped = fitted(metal(0.1f), settings).error;
  EXPECT_LE(warped, 0.027);
  EXPECT_LT(warped, 0.08 * plain);
}

/// The error of pqp_disc over that of dfg_disc: what the factor F(h.l) is worth.
double gainByFresnel(const Brdf& brdf, int texels, const std::string& of) {
  FitSettings settings = settingsOf(Factorisation::pqp_disc, texels);
  settings.samples = 8000;
  const FactoredBrdf without = fitted(brdf, settings, " of " + of);
  settings.factorisation = Factorisation::dfg_disc;
  const FactoredBrdf with = fitted(brdf, settings, " of " + of);
  EXPECT_EQ(with.bytes() - without.bytes(), static_cast<std::size_t>(texels) * 3 * 2);
  return without.error / with.error;
}

// By 1.3 on a groove of two colours, 2 on metals, 2.8 on plastic and 3.6 on rough glass with a grain.
TEST(FactorFit, FresnelsFactorOverDiscs) {
  const auto groove = std::make_shared<GrooveBrdf>(Groove{});
  EXPECT_GT(
      gainByFresnel([&](const dvec3& l, const dvec3& v) { return groove->evaluate(l, v); }, 16, "groove"),
      1.2);
  EXPECT_GT(gainByFresnel(metal(0.3f), 32, "metal"), 1.7);
  EXPECT_GT(gainByFresnel(plastic(0.15f), 32, "plastic"), 2);
  glsl::MaterialModel glass{};
  glass.kind = glsl::model_ward;
  glass.eta = glm::vec3(1.5f);
  glass.ks = glm::vec3(1);
  glass.roughness = {0.2f, 0.5f};
  const std::vector<glm::vec3> none;
  EXPECT_GT(gainByFresnel(modelBrdf(glass, none), 32, "glass with a grain"), 2.5);
}

// A diffuse part and a lobe are two products: together they need no floor.
TEST(FactorFit, TwoProductsNeedNoFloor) {
  for (Factorisation factorisation : {Factorisation::dfg, Factorisation::pqp}) {
    FitSettings settings = settingsOf(factorisation, 64);
    settings.samples = 8000;
    settings.floor = false;
    const FactoredBrdf one = fitted(plastic(0.15f), settings);
    settings.terms = 2;
    const FactoredBrdf two = fitted(plastic(0.15f), settings);
    EXPECT_EQ(two.floor, dvec3(0));
    EXPECT_EQ(two.bytes(), 2 * one.bytes());
    EXPECT_LE(two.error, 0.014) << two.name;
    EXPECT_LT(two.error, 0.1 * one.error) << two.name;
    EXPECT_LE(albedoError(plastic(0.15f), two), 0.015) << two.name;
  }
}

// Nothing makes one half turn of the view the mirror of the other: this grain reflects 0.55 (1 - v.x) of
// uniform light, more than all of it on one side alone.
TEST(FactorFit, ReflectsAtMostAllLightToEveryAzimuth) {
  const Brdf exact = [](const dvec3& l, const dvec3& v) {
    return dvec3(0.55 / std::numbers::pi * (1 - l.x) * (1 - v.x));
  };
  FitSettings settings = settingsOf(Factorisation::pqp_disc, 16);
  settings.samples = 4000;
  const FactoredBrdf fit = fitBrdf(exact, settings);
  for (int degrees : {0, 40, 80}) {
    const double theta = degrees * std::numbers::pi / 180;
    const dvec3 away(-std::sin(theta), 0, std::cos(theta)), near(std::sin(theta), 0, std::cos(theta));
    EXPECT_LE(albedoOfResponse(responseOf(fit), away).x, 1.001) << degrees;
    EXPECT_LE(albedoOfResponse(responseOf(fit), near).x, 1.001) << degrees;
  }
}

TEST(FactorFit, SvdGainsByTerms) {
  FitSettings settings = settingsOf(Factorisation::svd, 24, 1);
  const FactoredBrdf one = fitted(metal(0.3f), settings);
  settings.terms = 4;
  const FactoredBrdf four = fitted(metal(0.3f), settings);
  EXPECT_LE(one.error, 0.14);
  EXPECT_LE(four.error, 0.053);
  EXPECT_LT(four.error, 0.7 * one.error);
  EXPECT_EQ(four.bytes(), 4 * one.bytes());
}

TEST(FactorFit, TrilinearTableIsTheRival) {
  const FactoredBrdf rival = fitted(metal(0.3f), settingsOf(Factorisation::trilinear, 32));
  EXPECT_EQ(rival.bytes(), 32u * 16 * 16 * 6);
  EXPECT_LE(rival.error, 0.007);
}

}  // namespace
}  // namespace limn::brdf
