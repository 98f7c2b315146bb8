// The RGL's files of anisotropic materials: what a part of the circle of azimuths says of the rest.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "core/base/error.h"
#include "core/brdf/epfl_file.h"
#include "core/brdf/measured_file.h"
#include "core/brdf/measured_model.h"
#include "glsl/materials/measured.glsl"
#include "tests/unit/brdf/materials.h"
#include "tests/unit/brdf/tensor_builder.h"

namespace limn::brdf {
namespace {

using namespace test;
using glm::dvec3;
using testing::HasSubstr;

/// How many parts of the circle as large as that in the file there are.
constexpr std::array<int, 3> kParts{1, 2, 4};

/// Azimuths from -pi that divide such a part.
Array azimuths(int parts, std::uint64_t count) {
  return filled({count}, [&](auto& i) { return kPi * (2 * onGrid(i[0], count) / parts - 1); });
}

/// Turns or mirrors l and v to where the part was measured, as Mitsuba's reader of these files does.
void bring(int parts, dvec3& l, dvec3& v) {
  if (parts == 1) return;
  const double y = l.y > 0 ? -1 : 1, x = parts == 2 ? y : l.x > 0 ? -1.0 : 1.0;
  for (dvec3* d : {&l, &v}) *d = dvec3(x * d->x, y * d->y, d->z);
}

AnisotropicTable anisotropic(const Arrays& arrays, int texels) {
  return std::get<AnisotropicTable>(decodeEpfl(tensorFile(arrays), "file", {.texels = texels}));
}

/// Calls check(l, v, value) at all pairs of texels.
template <class Check>
void atTexels(const AnisotropicTable& table, const Check& check) {
  std::vector<dvec3> directions;
  for (int y = 0; y < table.size; ++y)
    for (int x = 0; x < table.size; ++x) directions.emplace_back(table.texelDirection(x, y));
  std::size_t i = 0;
  for (const dvec3& v : directions)
    for (const dvec3& l : directions) check(l, v, table.values.at(i++));
}

/// The smallest file of a part of the circle. Its colours are those of three azimuths, and its distribution
/// of normals is 1 at the normal and has another value at each of four azimuths of the horizon.
Arrays part(int parts) {
  Arrays arrays = smallFile();
  arrays["phi_i"] = azimuths(parts, 3);
  arrays["ndf"] = {{5, 2}, {1, 1, 1, 2, 1, 4, 1, 3, 1, 1}};
  arrays["vndf"] = {{3, 2, 2, 2}, std::vector<float>(24, 1)};
  arrays["rgb"] = filled({3, 2, 3, 2, 2}, [](auto& i) { return static_cast<double>(i[0] * (1 + i[2])); });
  return arrays;
}

/// f of it: linear in the azimuth of l, the ring of four values, and the root of the angle from the normal.
double exactly(int parts, dvec3 l, dvec3 v, int channel) {
  bring(parts, l, v);
  const dvec3 h = glm::normalize(l + v);
  const double colour = (std::atan2(l.y, l.x) + kPi) / (2 * kPi) * parts * 2;
  constexpr double ring[] = {1, 2, 4, 3, 1};
  const double place = (std::atan2(h.y, h.x) + kPi) / (2 * kPi) * 4, share = place - std::floor(place);
  const int below = static_cast<int>(place) % 4;
  const double horizon = (1 - share) * ring[below] + share * ring[below + 1];
  const double x = std::sqrt(std::atan2(std::hypot(h.x, h.y), h.z) * 2 / kPi);
  return colour * (1 + channel) * (1 + x * (horizon - 1)) / (4 * v.z);
}

TEST(EpflAnisotropic, PartsOfTheCircleAreAClosedForm) {
  for (const int parts : kParts)
    atTexels(anisotropic(part(parts), 6), [&](const dvec3& l, const dvec3& v, const glm::vec3& value) {
      for (int c = 0; c < 3; ++c) {
        const double expected = 0.5 * (exactly(parts, l, v, c) + exactly(parts, v, l, c));
        EXPECT_NEAR(static_cast<double>(value[c]), expected, 2e-4 * (1 + expected)) << parts;
      }
    });
}

/// Brushed metal without Fresnel's term: Ward's distribution of normals, with the scratches at `turned`
/// radians from the tangent, and Smith's correlated masking.
struct Brushed {
  double along = 0.4, across = 0.8, turned = 0;

  dvec3 local(const dvec3& d) const {
    const double c = std::cos(turned), s = std::sin(turned);
    return {c * d.x + s * d.y, c * d.y - s * d.x, d.z};
  }
  double distribution(const dvec3& h) const {
    const dvec3 m = local(h);
    const double slope2 = std::pow(m.x / along, 2) + std::pow(m.y / across, 2);
    return std::exp(-slope2 / (m.z * m.z)) / (kPi * along * across * std::pow(m.z, 4));
  }
  double masked(const dvec3& d) const {
    const dvec3 m = local(d);
    const double a = m.z / std::max(std::hypot(along * m.x, across * m.y), 1e-9);
    return (std::erf(a) - 1) / 2 + std::exp(-a * a) / (2 * a * std::sqrt(kPi));
  }
  double operator()(const dvec3& l, const dvec3& v) const {
    return distribution(glm::normalize(l + v)) / (1 + masked(l) + masked(v)) / (4 * l.z * v.z);
  }
};

dvec3 spherical(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// A file of it, with visible normals of uniform density on the square. Its colours are what is left of f.
Arrays brushedFile(const Brushed& metal, int parts) {
  constexpr std::uint64_t kPolars = 24, kGrid = 33, kNdf = 129;
  const auto azimuthCount = static_cast<std::uint64_t>(64 / parts + 1);
  const auto onSquare = [](double x, double y) { return spherical(kPi / 2 * x * x, (2 * y - 1) * kPi); };
  const auto above = [](dvec3 d) { return glm::normalize(dvec3(d.x, d.y, std::max(d.z, 1e-2))); };
  const auto projected = [&](const dvec3& l) { return l.z * (1 + metal.masked(l)); };
  Arrays arrays;
  arrays["phi_i"] = azimuths(parts, azimuthCount);
  arrays["theta_i"] = filled({kPolars}, [](auto& i) { return kPi / 2 * onGrid(i[0], kPolars); });
  arrays["ndf"] = filled({kNdf, kNdf}, [&](auto& i) {
    return metal.distribution(above(onSquare(onGrid(i[1], kNdf), onGrid(i[0], kNdf))));
  });
  arrays["sigma"] = filled({kNdf, kNdf}, [&](auto& i) {
    return projected(above(onSquare(onGrid(i[1], kNdf), onGrid(i[0], kNdf))));
  });
  arrays["vndf"] = {{azimuthCount, kPolars, 2, 2}, std::vector<float>(azimuthCount * kPolars * 4, 1)};
  arrays["rgb"] = filled({azimuthCount, kPolars, 3, kGrid, kGrid}, [&](auto& i) {
    const double phi = kPi * (2 * onGrid(i[0], azimuthCount) / parts - 1);
    const dvec3 l = above(spherical(kPi / 2 * onGrid(i[1], kPolars), phi));
    const dvec3 h = onSquare(onGrid(i[4], kGrid), onGrid(i[3], kGrid)), v = 2 * glm::dot(h, l) * h - l;
    return v.z <= 1e-3 ? 0 : (1 + metal.masked(l)) / (1 + metal.masked(l) + metal.masked(v));
  });
  return arrays;
}

/// Half a circle holds scratches of any direction, a quarter those along or across the tangent.
TEST(EpflAnisotropic, GivesBackBrushedMetal) {
  for (const int parts : kParts) {
    const Brushed metal{.turned = parts == 4 ? 0 : 0.5};
    double error2 = 0, exact2 = 0, difference = 0, mean = 0;
    atTexels(anisotropic(brushedFile(metal, parts), 12),
             [&](const dvec3& l, const dvec3& v, const glm::vec3& value) {
               const double weight = l.z * v.z, exact = weight * metal(l, v);
               const double found = weight * static_cast<double>(value.x);
               EXPECT_EQ(value.x, value.z);
               error2 += (found - exact) * (found - exact);
               exact2 += exact * exact;
               difference += found - exact;
               mean += exact;
             });
    EXPECT_LT(std::sqrt(error2 / exact2), 0.02) << parts;
    EXPECT_LT(std::abs(difference / mean), 0.01) << parts;
  }
}

/// Such a file is a material of scenes, too, with the sizes that files have without further words.
TEST(EpflAnisotropic, IsAModelOverPairsOfDirections) {
  const MeasuredBrdf read = decodeMeasured(tensorFile(part(4)), "satin.bsdf");
  const glsl::MaterialModel model = measuredModel(std::get<AnisotropicTable>(read)).model;
  EXPECT_EQ(model.options, glsl::model_option_pairs);
  EXPECT_EQ(glsl::measured_size(model.nodes), glm::uvec3(EpflNodes{}.texels, 0, 0));
  EXPECT_TRUE(glsl::model_anisotropic(model));
}

std::string refusedArrays(const Arrays& arrays) {
  try {
    decodeEpfl(tensorFile(arrays), "satin.bsdf", {.texels = 4});
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("satin.bsdf: "));
    EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
    return error.what();
  }
  return "read";
}

TEST(EpflAnisotropic, OtherAzimuthsEndInOneLine) {
  EXPECT_EQ(refusedArrays(part(4)), "read");
  const auto at = [](std::vector<float> phi) {
    Arrays arrays = part(1);
    arrays["phi_i"].values = std::move(phi);
    return refusedArrays(arrays);
  };
  EXPECT_THAT(at({-3, -1, -0.9f}), HasSubstr("phi_i spans 2.1 radians; a circle, a half or a quarter"));
  EXPECT_THAT(at({0, 0.1f, 0.2f}), HasSubstr("phi_i spans 0.2 radians"));
  EXPECT_THAT(at({-6, 0, 6.2f}), HasSubstr("phi_i spans 12.2 radians"));
  EXPECT_THAT(at({0, 3, 3}), HasSubstr("phi_i[2] is 3; angles"));
  for (const float value : {std::nanf(""), std::numeric_limits<float>::infinity(), 7.0f, -7.0f})
    EXPECT_THAT(at({-3, 0, value}), HasSubstr("phi_i[2] is"));
  Arrays arrays = part(2);
  arrays["rgb"].shape = {1, 2, 9, 2, 2};
  EXPECT_THAT(refusedArrays(arrays),
              HasSubstr("array 'rgb' is 1 x 2 grids of 2 x 2; 3 x 2 (phi_i, theta_i)"));
  arrays = part(2);
  arrays["sigma"].values = {0, 0};
  EXPECT_THAT(refusedArrays(arrays), HasSubstr("no number from 0 to 1e10 between two directions"));
}

}  // namespace
}  // namespace limn::brdf
