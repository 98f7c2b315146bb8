#include "core/brdf/epfl_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/base/error.h"
#include "core/brdf/private/visible_normals.h"
#include "tests/unit/brdf/materials.h"
#include "tests/unit/brdf/tensor_builder.h"

namespace limn::brdf {
namespace {

using namespace test;
using testing::HasSubstr;

constexpr std::uint64_t kPolars = 24, kGrid = 33, kNdf = 129;

double thetaI(std::uint64_t i) {
  return kPi / 2 * static_cast<double>(i) / (kPolars - 1);
}

/// Of the density (1 + x)(2 - y) / 2.25 of the visible normals: the warp of one coordinate, u to place.
double warpX(double u) {
  return std::sqrt(1 + 3 * u) - 1;
}
double warpY(double u) {
  return 2 - std::sqrt(4 - 3 * u);
}

/// Rough gold: wide enough that the grids resolve it.
const Microfacets kGold{.m = 0.5};

/// A file of it, whose colours are what makes f right at the places that the warp leads to.
Arrays goldFile(std::uint64_t azimuths = 1) {
  Arrays arrays;
  arrays["phi_i"] = filled({azimuths}, [](auto& i) { return static_cast<double>(i[0]); });
  arrays["theta_i"] = filled({kPolars}, [](auto& i) { return thetaI(i[0]); });
  arrays["ndf"] = filled({2, kNdf}, [](auto& i) {
    const double x = onGrid(i[1], kNdf);
    return kGold.distribution(std::max(std::cos(kPi / 2 * x * x), 1e-2));
  });
  arrays["sigma"] = filled({2, kNdf}, [](auto& i) {
    const double x = onGrid(i[1], kNdf), cosine = std::max(std::cos(kPi / 2 * x * x), 1e-3);
    return cosine * (1 + kGold.masked(cosine));
  });
  arrays["vndf"] = filled({azimuths, kPolars, 3, 5}, [](auto& i) {
    return (1 + onGrid(i[3], 5)) * (2 - onGrid(i[2], 3)) * static_cast<double>(1 + i[1]);
  });
  arrays["rgb"] = filled({azimuths, kPolars, 3, kGrid, kGrid}, [](auto& i) {
    const double x = warpX(onGrid(i[4], kGrid)), phi = (2 * warpY(onGrid(i[3], kGrid)) - 1) * kPi;
    const double thetaH = kPi / 2 * x * x, theta = std::min(thetaI(i[1]), 1.55);
    const glm::dvec3 l(std::sin(theta), 0, std::cos(theta));
    const glm::dvec3 h(std::sin(thetaH) * std::cos(phi), std::sin(thetaH) * std::sin(phi), std::cos(thetaH));
    const glm::dvec3 v = 2 * glm::dot(h, l) * h - l;
    if (v.z <= 1e-3 || h.z <= 1e-2) return -1.0;
    const double smith = 1 / (1 + kGold.masked(l.z) + kGold.masked(v.z));
    const int c = static_cast<int>(i[2]);
    // f = F D G / (4 l.z v.z) = rgb D / (4 sigma v.z) with sigma = l.z (1 + Lambda).
    return Microfacets::fresnel(glm::dot(h, l), kGold.eta[c], kGold.k[c]) * smith * (1 + kGold.masked(l.z));
  });
  arrays["description"] = {.shape = {1}, .values = {0}};
  return arrays;
}

TabulatedBrdf isotropic(const Arrays& arrays, const glm::ivec3& size) {
  return std::get<TabulatedBrdf>(decodeEpfl(tensorFile(arrays), "file", {.angles = size}));
}

std::string refusal(const std::vector<std::byte>& bytes) {
  try {
    decodeEpfl(bytes, "paint.bsdf", {.angles = {4, 4, 4}, .texels = 2});
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("paint.bsdf: "));
    EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
    return error.what();
  }
  return "read";
}

TEST(VisibleNormals, InverseOfAProductOfLines) {
  std::vector<double> densities;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x) densities.push_back((1 + x / 4.0) * (2 - y / 2.0));
  const VisibleNormals normals(densities, {.width = 5, .height = 3});
  for (double x = 0; x <= 1; x += 0.1)
    for (double y = 0; y <= 1; y += 0.1) {
      const glm::dvec2 u = normals.invert({warpX(x), warpY(y)}, Cell(0, 1));
      EXPECT_NEAR(u.x, x, 1e-12);
      EXPECT_NEAR(u.y, y, 1e-12);
    }
}

// A density that is no product, x + y: rows by y/2 + y^2/2, and within one by (x^2/2 + x y) / (1/2 + y).
// Halfway to the uniform one both are means, before the division.
TEST(VisibleNormals, InverseOfABilinearDensityAndBetweenParameters) {
  const VisibleNormals normals(std::vector<double>{0, 5, 5, 10, 7, 7, 7, 7}, {.width = 2, .height = 2});
  const double x = 0.3, y = 0.6;
  const glm::dvec2 first = normals.invert({x, y}, Cell(0, 2)), second = normals.invert({x, y}, Cell(1, 2));
  EXPECT_NEAR(first.x, (x * x / 2 + x * y) / (0.5 + y), 1e-12);
  EXPECT_NEAR(first.y, y / 2 + y * y / 2, 1e-12);
  EXPECT_NEAR(second.x, x, 1e-12);
  EXPECT_NEAR(second.y, y, 1e-12);
  const glm::dvec2 half = normals.invert({x, y}, Cell(0.5, 2));
  EXPECT_NEAR(half.y, (first.y + y) / 2, 1e-12);
  EXPECT_NEAR(half.x, ((x * x / 2 + x * y) + x) / (0.5 + y + 1), 1e-12);
}

TEST(EpflFile, GivesBackTheMaterial) {
  const TabulatedBrdf table = isotropic(goldFile(), {64, 40, 24});
  const TabulatedBrdf exact = tabulate({64, 40, 24}, kGold);
  const SphereError error = compareOnSphere(lookup(table), lookup(exact));
  EXPECT_LT(error.rms, 0.02);
  EXPECT_LT(std::abs(error.bias), 0.01);
}

TEST(EpflFile, TwoAzimuthsThatSayTheSame) {
  const TabulatedBrdf one = isotropic(goldFile(), {10, 8, 6});
  const TabulatedBrdf two = isotropic(goldFile(2), {10, 8, 6});
  for (std::size_t i = 0; i < one.values.size(); ++i)
    EXPECT_NEAR(two.values[i].x, one.values[i].x, 1e-5f * (1 + one.values[i].x));
}

TEST(EpflFile, ConstantArraysAreAClosedForm) {
  // f = 1 / (4 cos(v)), of which the table holds the mean with 1 / (4 cos(l)).
  const TabulatedBrdf table = isotropic(smallFile(), {8, 8, 8});
  const auto [l, v] = directions(table.node(2, 2, 1));
  EXPECT_NEAR(table.evaluate(l, v).x, (1 / l.z + 1 / v.z) / 8, 1e-5f);
}

TEST(EpflFile, MissingAndMisshapenArraysEndInOneLine) {
  EXPECT_EQ(refusal(tensorFile(smallFile())), "read");
  for (const auto& [name, array] : smallFile()) {
    Arrays arrays = smallFile();
    arrays.erase(name);
    EXPECT_THAT(refusal(tensorFile(arrays)), HasSubstr("without the array '" + name + "'"));
    arrays[name] = {{1, 1, 1}, {1}};
    EXPECT_THAT(refusal(tensorFile(arrays)), HasSubstr("array '" + name + "' has 3 dimensions of type 10"));
    arrays[name] = {std::vector<std::uint64_t>(array.shape.size(), 0), {}};
    EXPECT_THAT(refusal(tensorFile(arrays)), HasSubstr("none of them empty"));
  }
  const auto replaced = [](const std::string& name, const Array& array) {
    Arrays arrays = smallFile();
    arrays[name] = array;
    return refusal(tensorFile(arrays));
  };
  EXPECT_THAT(replaced("phi_i", {{2}, {0, 1}}), HasSubstr("array 'vndf' is 1 x 2 grids"));
  EXPECT_THAT(replaced("theta_i", {{3}, {0, 1, 1.5f}}), HasSubstr("1 x 3 (phi_i, theta_i)"));
  EXPECT_THAT(replaced("vndf", {{1, 2, 1, 4}, std::vector<float>(8, 1)}), HasSubstr("array 'vndf'"));
  EXPECT_THAT(replaced("rgb", {{1, 2, 4, 2, 2}, std::vector<float>(32, 1)}), HasSubstr("has 4 channels"));
  EXPECT_THAT(replaced("rgb", {{1, 2, 3, 1, 1}, std::vector<float>(6, 1)}), HasSubstr("array 'rgb'"));
}

TEST(EpflFile, ValuesThatAreNoneEndInOneLine) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto with = [](const std::string& name, std::size_t index, float value) {
    Arrays arrays = smallFile();
    arrays.at(name).values.at(index) = value;
    return refusal(tensorFile(arrays));
  };
  for (const float value : {std::nanf(""), infinity, -1.0f})
    for (const std::string name : {"ndf", "sigma", "vndf"})
      EXPECT_THAT(with(name, 1, value), HasSubstr("array '" + name + "' holds"));
  EXPECT_THAT(with("rgb", 3, std::nanf("")), HasSubstr("array 'rgb' holds nan"));
  EXPECT_THAT(with("rgb", 3, infinity), HasSubstr("array 'rgb' holds inf"));
  EXPECT_EQ(with("rgb", 3, -1), "read");  // out of gamut
  for (const float value : {0.0f, -1.0f, 2.0f, std::nanf("")})
    EXPECT_THAT(with("theta_i", 1, value), HasSubstr("theta_i[1] is"));
  Arrays arrays = smallFile();
  arrays["vndf"].values.assign(8, 0);
  EXPECT_THAT(refusal(tensorFile(arrays)), HasSubstr("'vndf' is 0 everywhere"));
  arrays = smallFile();
  arrays["sigma"].values = {0, 0};
  EXPECT_THAT(refusal(tensorFile(arrays)), HasSubstr("nowhere a number"));
}

TEST(EpflFile, BrokenContainersEndInOneLine) {
  const std::vector<std::byte> good = tensorFile(smallFile());
  EXPECT_THAT(refusal({}), HasSubstr("'tensor_file'"));
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_NE(refusal({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)}), "read") << length;
  const auto with = [&](std::size_t at, auto number) {
    std::vector<std::byte> bytes = good;
    std::memcpy(bytes.data() + at, &number, sizeof number);
    return refusal(bytes);
  };
  EXPECT_THAT(with(0, 'T'), HasSubstr("'tensor_file'"));
  EXPECT_THAT(with(12, std::uint8_t{2}), HasSubstr("version 2.0; 1.0 is accepted"));
  EXPECT_NE(with(14, std::uint32_t{4000000000}), "read");
  // The first array is ndf: length and text of its name, dimensions, type, offset, sides.
  EXPECT_THAT(with(18, std::uint16_t{65535}), HasSubstr("ends within its table"));
  EXPECT_THAT(with(23, std::uint16_t{9}), HasSubstr("9 dimensions; at most 8"));
  EXPECT_THAT(with(25, std::uint8_t{0}), HasSubstr("type 0; 1 to 11"));
  EXPECT_THAT(with(25, std::uint8_t{12}), HasSubstr("type 12"));
  EXPECT_THAT(with(25, std::uint8_t{5}), HasSubstr("type 5"));
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  for (const std::uint64_t number : {most, most / 2 + 1, most / 8 + 2, std::uint64_t{1} << 32})
    for (const std::size_t at : {26u, 34u, 42u})
      EXPECT_THAT(with(at, number), HasSubstr("'ndf' lies beyond"));
}

}  // namespace
}  // namespace limn::brdf
