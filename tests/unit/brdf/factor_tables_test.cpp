// The two tables of Torrance and Sparrow's model against the model: factors, coordinates, formats.
#include "core/brdf/factor_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "core/base/error.h"
#include "core/brdf/factor_fit_error.h"
#include "glsl/materials/factored.glsl"
#include "tests/unit/brdf/exact_models.h"

namespace limn::brdf {
namespace {

using glm::dvec3;

TorranceSparrow rough(double m) {
  TorranceSparrow material;
  material.roughness = m;
  return material;
}

double errorOf(const SpherePicture& picture, const FactoredBrdf& tables) {
  return picture.errorOf([&](const dvec3& l, const dvec3& v) { return tables.evaluate(l, v); });
}

dvec3 towards(double cosine, double azimuth) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

TEST(FactorTables, FresnelIsThatOfTheComplexRefractedAngle) {
  for (const auto& [eta, k] :
       {std::pair{1.5, 0.0}, {5.0, 0.0}, {200.0, 0.0}, {1.0001, 0.0}, {1.0, 2.0}, {0.2, 3.4}, {1.4, 7.6}})
    for (double cosine = 1; cosine > 0; cosine -= 0.01)
      EXPECT_NEAR(fresnelReflectance(cosine, eta, k), exactFresnel(cosine, {eta, -k}), 1e-9)
          << eta << ' ' << k << ' ' << cosine;
  EXPECT_EQ(fresnelReflectance(0, 1.5, 0), 1);
  EXPECT_EQ(fresnelReflectance(0.3, 1, 0), 0);
  EXPECT_EQ(fresnelReflectance(0.3, 0.5, 0), 1) << "total internal reflection";
}

// Schlick's approximation is exact at normal and at grazing incidence.
TEST(FactorTables, SchlicksReflectanceIsOffBetweenNormalAndGrazing) {
  struct Interface {
    double eta, k, most;
  };
  for (const auto& [eta, k, most] : {Interface{1.5, 0, 0.036}, {5, 0, 0.26}, {1.37, 7.62, 0.12}, {1, 0, 1}}) {
    double worst = 0;
    for (int i = 0; i <= 1000; ++i)
      worst = std::max(
          worst, std::abs(schlickReflectance(i / 1000.0, eta, k) - fresnelReflectance(i / 1000.0, eta, k)));
    RecordProperty("schlick_" + std::to_string(eta) + "_" + std::to_string(k), std::to_string(worst));
    EXPECT_NEAR(worst / most, 1, 0.1) << eta << ' ' << k;
    EXPECT_DOUBLE_EQ(schlickReflectance(1, eta, k), fresnelReflectance(1, eta, k));
  }
  const FactoredBrdf exact = torranceSparrowTables(rough(0.3), 32, 32, true, TableFormat::float32);
  TorranceSparrow material = rough(0.3);
  material.fresnel = FresnelTerm::schlick;
  const FactoredBrdf tables = torranceSparrowTables(material, 32, 32, true, TableFormat::float32);
  for (const double cosine : {0.9, 0.5, 0.3}) {  // of both to h, which is n
    const dvec3 l = towards(cosine, 0), v = towards(cosine, std::numbers::pi);
    EXPECT_NEAR(tables.evaluate(l, v).x / exact.evaluate(l, v).x,
                schlickReflectance(cosine, 1.5, 0) / fresnelReflectance(cosine, 1.5, 0), 0.01)
        << cosine;
  }
}

// The integral of D n.h over the hemisphere, in sqrt(1 - n.h) = q: d(omega) = 4 pi q dq.
double projectedArea(const TorranceSparrow& material) {
  constexpr int kSteps = 200000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double q = (i + 0.5) / kSteps;
    sum += normalDistribution(material, q) * (1 - q * q) * 4 * std::numbers::pi * q / kSteps;
  }
  return sum;
}

TEST(FactorTables, DistributionsCoverTheSurfaceOnce) {
  for (double m : {1e-3, 0.01, 0.1, 0.5, 1.0}) EXPECT_NEAR(projectedArea(rough(m)), 1, 1e-4) << m;
  TorranceSparrow gaussian;
  gaussian.distribution = NormalDistribution::gaussian;
  for (double m : {0.01, 0.1, 0.5}) {
    gaussian.roughness = m;
    EXPECT_NEAR(projectedArea(gaussian), 1, 1e-5) << m;
  }
  gaussian.roughness = 1;  // what lies beyond the horizon is missing from the integral
  EXPECT_NEAR(projectedArea(gaussian), 1, 0.02);
}

TEST(FactorTables, MaskingOverTheCosineHasNoSingularity) {
  for (double m : {1e-3, 0.05, 0.1, 0.4, 1.0}) {
    const double grazing = std::sqrt(std::numbers::pi) / (2 * m);
    EXPECT_NEAR(maskingOverCosine(rough(m), 0.5, 0) / grazing, 1, 1e-12) << m;
    EXPECT_NEAR(maskingOverCosine(rough(m), 0.5, 1e-7) / grazing, 1, 2e-3) << m;
    EXPECT_TRUE(std::isfinite(maskingOverCosine(rough(m), 0, 0)));
    EXPECT_EQ(maskingOverCosine(rough(m), 0, 0.5), 0);
  }
  TorranceSparrow product = rough(0.3);
  product.masking = Masking::product;
  const double ofL = exactLambda(0.2, 0.3), ofV = exactLambda(0.4, 0.3);
  EXPECT_NEAR(maskingOverCosine(product, 0.2, 0.4), 1 / ((1 + ofL) * (1 + ofV) * 4 * 0.4), 1e-12);
  EXPECT_NEAR(maskingOverCosine(rough(0.3), 0.2, 0.4), 1 / ((1 + ofL + ofV) * 4 * 0.4), 1e-12);
}

// What the published clamp of G / (pi n.v) to 1 keeps at m = 0.1.
TEST(FactorTables, ClampTakesTheHighlightAtGrazingViews) {
  const auto kept = [](double cosine) {
    return 1 / std::max(1.0, maskingOverCosine(rough(0.1), 1, cosine) * 4 / std::numbers::pi);
  };
  EXPECT_NEAR(kept(0.2), 0.63, 0.005);
  EXPECT_NEAR(kept(0.1), 0.32, 0.005);
  EXPECT_NEAR(kept(0.05), 0.19, 0.005);
}

TEST(FactorTables, TexelsHoldTheFactorsAtTheirPlaces) {
  const FactoredBrdf tables = torranceSparrowTables(rough(0.3), 16, 8, true, TableFormat::float32);
  ASSERT_EQ(tables.tables.size(), 2u);
  EXPECT_EQ(tables.bytes(), 2u * 16 * 8 * 12);
  // Head-on, all angles are those of the last texels.
  const dvec3 up(0, 0, 1);
  EXPECT_NEAR(tables.evaluate(up, up).x, exactTorranceSparrow(rough(0.3))(up, up).x, 1e-6);
}

TEST(FactorTables, FineTablesAreTheModel) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  TorranceSparrow aluminium = rough(0.2);
  aluminium.eta = {1.35, 0.97, 0.62};
  aluminium.k = {7.5, 6.4, 5.3};
  aluminium.masking = Masking::product;
  TorranceSparrow gaussian = rough(0.5);
  gaussian.distribution = NormalDistribution::gaussian;
  for (const TorranceSparrow& material : {rough(0.1), rough(1), aluminium, gaussian}) {
    const Brdf exact = exactTorranceSparrow(material);
    const FactoredBrdf tables = torranceSparrowTables(material, 512, 512, true, TableFormat::float32);
    for (int i = 0; i < 2000; ++i) {
      const dvec3 l = towards(0.05 + 0.95 * uniform(random), 6.28 * uniform(random));
      const dvec3 v = towards(0.05 + 0.95 * uniform(random), 6.28 * uniform(random));
      const dvec3 expected = exact(l, v) * l.z, found = tables.evaluate(l, v);
      const double largest = exact({0, 0, 1}, {0, 0, 1}).x;
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], 2e-3 * expected[c] + 1e-4 * largest)
            << material.roughness << ' ' << l.z << ' ' << v.z;
    }
  }
}

// Near n the float n.h has lost what a narrow lobe needs; |n - h| has not.
TEST(FactorTables, DistanceFromTheNormalKeepsItsDigits) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  const TorranceSparrow narrow = rough(0.01);
  double byDistance = 0, byCosine = 0;
  for (int i = 0; i < 20000; ++i) {
    const dvec3 n = towards(2 * uniform(random) - 1, 6.28 * uniform(random));
    const dvec3 across = glm::normalize(glm::cross(n, towards(0.3, 6.28 * uniform(random))));
    const double angle = 0.02 * uniform(random);
    const dvec3 h = n * std::cos(angle) + across * std::sin(angle);
    const double exact = normalDistribution(narrow, std::numbers::sqrt2 * std::sin(angle / 2));
    // l = v = h: the half vector of float directions.
    const glsl::FactoredAngles a = glsl::factored_angles(glm::vec3(n), glm::vec3(h), glm::vec3(h));
    byDistance = std::max(byDistance,
                          std::abs(normalDistribution(narrow, static_cast<double>(a.h_from_n)) / exact - 1));
    const float cosine = std::min(glm::dot(glm::vec3(n), glm::vec3(h)), 1.f);
    byCosine = std::max(
        byCosine,
        std::abs(normalDistribution(narrow, std::sqrt(1 - static_cast<double>(cosine))) / exact - 1));
  }
  RecordProperty("by_distance_1e6", static_cast<int>(1e6 * byDistance));
  RecordProperty("by_cosine_1e6", static_cast<int>(1e6 * byCosine));
  EXPECT_LT(byDistance, 1.5e-3);
  EXPECT_GT(byCosine, 2 * byDistance);
}

// Linear interpolation errs by the square of the texel over the lobe's width, in the coordinate the texels
// lie over. The published coordinates have texels wider than the lobe, to which the law does not apply: their
// errors are figures.
TEST(FactorTables, WarpedCoordinatesFollowTheWidthOfTheLobe) {
  const std::map<std::pair<double, int>, double> figures{
      {{0.1, 32}, 1.40},  {{0.1, 64}, 0.60},  {{0.1, 128}, 0.194}, {{0.1, 256}, 0.0523},
      {{0.05, 32}, 3.85}, {{0.05, 64}, 2.42}, {{0.05, 128}, 1.36}, {{0.05, 256}, 0.598}};
  for (double m : {0.1, 0.05}) {
    const SpherePicture picture(exactTorranceSparrow(rough(m)), 192);
    for (int n : {32, 64, 128, 256}) {
      const double published =
          errorOf(picture, torranceSparrowTables(rough(m), n, n, false, TableFormat::float32));
      const double warped =
          errorOf(picture, torranceSparrowTables(rough(m), n, n, true, TableFormat::float32));
      RecordProperty("m" + std::to_string(static_cast<int>(100 * m)) + "_" + std::to_string(n),
                     std::to_string(published) + " " + std::to_string(warped));
      EXPECT_NEAR(published / figures.at({m, n}), 1, 0.03) << m << ' ' << n;
      const double law = 0.4 / (n * m * n * m);
      if (law < 0.1) {
        EXPECT_NEAR(warped / law, 1, 0.15) << m << ' ' << n;
        EXPECT_GT(published, 30 * warped) << m << ' ' << n;
      }
      const double publishedLaw = 0.33 / std::pow(n * m * m, 2);
      if (publishedLaw < 0.1) {
        EXPECT_NEAR(published / publishedLaw, 1, 0.15) << m << ' ' << n;
      }
    }
  }
}

TEST(FactorTables, HundredAndTwentyEightWarpedTexelsSufficeFromATenthOn) {
  for (double m : {0.1, 0.2, 0.4, 1.0}) {
    const SpherePicture picture(exactTorranceSparrow(rough(m)));
    const double warped =
        errorOf(picture, torranceSparrowTables(rough(m), 128, 128, true, TableFormat::half));
    EXPECT_LE(warped, 3e-3) << m;
    if (m == 0.1) {
      const double published =
          errorOf(picture, torranceSparrowTables(rough(m), 128, 128, false, TableFormat::half));
      EXPECT_GE(published, 50 * warped);
    }
  }
}

TEST(FactorTables, HalfFloatsSufficeAndBytesWithTheClampDoNot) {
  for (const auto& [m, ofBytes] : {std::pair(0.1, 0.044), std::pair(0.4, 0.109)}) {
    const SpherePicture picture(exactTorranceSparrow(rough(m)));
    const double full =
        errorOf(picture, torranceSparrowTables(rough(m), 128, 128, true, TableFormat::float32));
    const double half = errorOf(picture, torranceSparrowTables(rough(m), 128, 128, true, TableFormat::half));
    const double byte = errorOf(picture, torranceSparrowTables(rough(m), 128, 128, true, TableFormat::byte));
    EXPECT_NEAR(half, full, 2.0 / 2048) << "two values of 11 bits";
    EXPECT_GT(byte, 10 * half) << m;
    EXPECT_NEAR(byte / ofBytes, 1, 0.05) << m;
    RecordProperty("byte_1e4_" + std::to_string(static_cast<int>(10 * m)), static_cast<int>(1e4 * byte));
  }
}

// A Beckmann distribution wider than sqrt(1/2) is largest away from n; bytes end at the largest value.
TEST(FactorTables, BytesHoldWideDistributionsUncut) {
  constexpr int kTexels = 65;
  for (double m : {0.5, 0.8, 1.0}) {
    TorranceSparrow mirror = rough(m);
    mirror.eta = dvec3(1e-3);
    mirror.k = dvec3(1000);
    const FactoredBrdf tables = torranceSparrowTables(mirror, 2, kTexels, true, TableFormat::byte);
    const double largest = tables.scale.x / (std::numbers::pi / 4);
    for (int y = 0; y < kTexels; ++y)
      EXPECT_NEAR(largest * static_cast<double>(tables.tables[0].at(1, y, 0).x),
                  normalDistribution(mirror, 1 - static_cast<double>(y) / (kTexels - 1)),
                  largest * (0.5 / 255 + 1e-4))
          << m << ' ' << y;
  }
}

TEST(FactorTables, ExtremesAreFinite) {
  for (double m : {0.0, 1e-3, 1.0})
    for (double eta : {1.0, 1.0001, 200.0})
      for (bool warped : {false, true})
        for (NormalDistribution distribution : {NormalDistribution::beckmann, NormalDistribution::gaussian})
          for (TableFormat format : {TableFormat::float32, TableFormat::half, TableFormat::byte}) {
            TorranceSparrow material = rough(m);
            material.eta = dvec3(eta);
            material.distribution = distribution;
            const FactoredBrdf tables = torranceSparrowTables(material, 2, 2, warped, format);
            const dvec3 up(0, 0, 1), along(1, 0, 0), low = towards(1e-6, 0),
                                                     back = towards(1e-6, std::numbers::pi);
            for (const dvec3& l : {up, along, low, back, -up})
              for (const dvec3& v : {up, along, low, back, -up}) {
                const dvec3 f = tables.evaluate(l, v);
                for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(f[c]) && f[c] >= 0) << m << ' ' << eta;
              }
          }
}

// Tables of several BRDFs lie behind each other: layers of each kind are found from the first on.
TEST(FactorTables, LayersOfOtherBrdfsAreNotLookedUp) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(0, 1);
  FactorTable own{8, 8, 4, TableFormat::float32, {}};
  for (int i = 0; i < 8 * 8 * 4; ++i)
    own.texels.emplace_back(uniform(random), uniform(random), uniform(random));
  FactorTable second = own;
  second.depth = 8;  // others' layers before
  second.texels.insert(second.texels.begin(), own.texels.size(), glm::vec3(7));
  // Of Fresnel's rows there is one for every two discs.
  FactorTable ownRows{8, 1, 2, TableFormat::float32, {own.texels.begin(), own.texels.begin() + 16}};
  FactorTable rows = ownRows;
  rows.depth = 4;
  rows.texels.insert(rows.texels.begin(), ownRows.texels.size(), glm::vec3(7));
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 l(towards(uniform(random), 6.28 * uniform(random)));
    const glm::vec3 v(towards(uniform(random), 6.28 * uniform(random)));
    const glsl::FactoredAngles a = glsl::factored_angles({0, 0, 1}, v, l);
    EXPECT_EQ(glsl::factored_response(second, second, 4, a, true),
              glsl::factored_response(own, own, 0, a, true));
    EXPECT_EQ(glsl::factored_dfg_response(second, 4, 4, a), glsl::factored_dfg_response(own, 0, 4, a));
    EXPECT_EQ(glsl::factored_pqp_response(second, 4, 4, a), glsl::factored_pqp_response(own, 0, 4, a));
    EXPECT_EQ(glsl::factored_pqp_disc_response(second, 4, 2, v, l, true),
              glsl::factored_pqp_disc_response(own, 0, 2, v, l, true));
    EXPECT_EQ(glsl::factored_dfg_disc_response(second, rows, 4, 2, v, l, true),
              glsl::factored_dfg_disc_response(own, ownRows, 0, 2, v, l, true));
    EXPECT_EQ(glsl::factored_svd_response(second, second, 4, 4, v, l),
              glsl::factored_svd_response(own, own, 0, 4, v, l));
    EXPECT_EQ(glsl::factored_volume_response(second, 4, 4, v, l),
              glsl::factored_volume_response(own, 0, 4, v, l));
  }
}

// A sum of products is the sum of what each is by itself.
TEST(FactorTables, ProductsAreAdded) {
  std::mt19937 random(17);
  std::uniform_real_distribution<float> uniform(0, 1);
  FactorTable logs{8, 8, 4, TableFormat::float32, {}}, rows{8, 1, 2, TableFormat::float32, {}};
  for (int i = 0; i < 8 * 8 * 4; ++i)
    logs.texels.emplace_back(uniform(random), uniform(random), uniform(random));
  for (int i = 0; i < 8 * 2; ++i) rows.texels.emplace_back(uniform(random), uniform(random), uniform(random));
  const auto expectSum = [](const glm::vec3& both, const glm::vec3& one, const glm::vec3& other) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(both[c], one[c] + other[c], 1e-5f * both[c]);
  };
  for (int i = 0; i < 20; ++i) {
    const glm::vec3 l(towards(uniform(random), 6.28 * uniform(random)));
    const glm::vec3 v(towards(uniform(random), 6.28 * uniform(random)));
    const glsl::FactoredAngles a = glsl::factored_angles({0, 0, 1}, v, l);
    expectSum(glsl::factored_dfg_response(logs, 0, 2, a), glsl::factored_dfg_response(logs, 0, 1, a),
              glsl::factored_dfg_response(logs, 1, 1, a));
    expectSum(glsl::factored_pqp_response(logs, 0, 2, a), glsl::factored_pqp_response(logs, 0, 1, a),
              glsl::factored_pqp_response(logs, 1, 1, a));
    const auto discs = [&](int first, int terms) {
      return glsl::factored_pqp_disc_response(logs, first, terms, v, l, true);
    };
    expectSum(discs(0, 2), discs(0, 1), discs(2, 1));
    const auto withRows = [&](int first, int terms) {
      return glsl::factored_dfg_disc_response(logs, rows, first, terms, v, l, true);
    };
    expectSum(withRows(0, 2), withRows(0, 1), withRows(2, 1));
    // Fresnel's factor alone is what sets the two apart.
    const float place = glsl::factored_cosine_place(a.l_dot_h);
    const glm::vec3 factor = glm::exp(glsl::factored_lookup(rows, {place, 0}, 0));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(withRows(0, 1)[c], discs(0, 1)[c] * factor[c], 1e-5f);
  }
}

// Slices of a volume are met at their places, the last one too.
TEST(FactorTables, VolumesAreLinearBetweenSlices) {
  const FactorTable table =
      FactorTable::of({4, 4, 5}, TableFormat::float32, [](const dvec3& p) { return p; });
  std::mt19937 random(13);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 l(towards(0.1 + 0.9 * uniform(random), 6.28 * uniform(random)));
    const glm::vec3 v(towards(uniform(random), 6.28 * uniform(random)));
    const glm::vec3 place = glsl::factored_volume_place(v, l);
    const glm::vec3 found = glsl::factored_volume_response(table, 0, 5, v, l) / l.z;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], place[c], 1e-5f);
  }
  const glm::vec3 up(0, 0, 1), aside(towards(0.5, 0));
  EXPECT_NEAR(glsl::factored_volume_response(table, 0, 5, up, up).x, 1, 1e-6);
  EXPECT_TRUE(std::isfinite(glsl::factored_volume_response(table, 0, 5, aside, up).z));
}

TEST(FactorTables, SettingsThatMakeNoTablesAreNamed) {
  EXPECT_THROW(torranceSparrowTables(rough(0.1), 1, 64, true, TableFormat::half), UsageError);
  EXPECT_THROW(torranceSparrowTables(rough(-1), 64, 64, true, TableFormat::half), UsageError);
  EXPECT_THROW(torranceSparrowTables(rough(std::nan("")), 64, 64, true, TableFormat::half), UsageError);
  TorranceSparrow material;
  material.eta.y = 0;
  EXPECT_THROW(torranceSparrowTables(material, 64, 64, true, TableFormat::half), UsageError);
}

}  // namespace
}  // namespace limn::brdf
