#include "core/brdf/anisotropic_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/brdf/private/table_checks.h"

namespace limn::brdf {
namespace {

using glm::dvec2;
using glm::dvec3;

dvec2 clampedRoughness(const Ward& material) {
  return glm::max(material.roughness, dvec2(kLeastRoughness));
}

/// Returns the half vector's components along the tangent and across it at a place of D's table: the inverse
/// of factored_slope_place().
dvec2 halfAt(const dvec3& place, bool warped) {
  if (warped) return dvec2(place.x * place.x, place.y * place.y);
  const double angle = 0.5 * std::numbers::pi * place.x, azimuth = 0.5 * std::numbers::pi * place.y;
  return std::sin(angle) * dvec2(std::cos(azimuth), std::sin(azimuth));
}

/// Returns cos^p of the angle between l and the cone of the mirrored v; 0 where it is not acute.
double coneLobe(double lAlong, double vAlong, double exponent) {
  const double cosine =
      std::sqrt(std::max(0.0, (1 - lAlong * lAlong) * (1 - vAlong * vAlong))) - lAlong * vAlong;
  return cosine > 0 ? std::pow(std::min(cosine, 1.0), exponent) : 0;
}

/// Returns the largest D. With q = 1 / (n.h)^2 it is q^2 exp(-(q - 1) / m^2) along the wider axis, which
/// rises away from n where the width m is above sqrt(1/2).
double largestDistribution(const Ward& material) {
  const dvec2 m = clampedRoughness(material);
  const int wider = m.x > m.y ? 0 : 1;
  dvec2 h(0);
  h[wider] = std::sqrt(1 - 1 / std::max(1.0, 2 * m[wider] * m[wider]));
  return slopeDistribution(material, h);
}

}  // namespace

double slopeDistribution(const Ward& material, const dvec2& h) {
  const dvec2 m = clampedRoughness(material), scaled = h / m;
  const double cos2 = 1 - glm::dot(h, h);
  if (!(cos2 > 0)) return 0;
  const double exponent = -glm::dot(scaled, scaled) / cos2;
  return exponent < -700 ? 0 : std::exp(exponent) / (std::numbers::pi * m.x * m.y * cos2 * cos2);
}

FactoredBrdf wardTables(const Ward& material, int texels, bool warped, TableFormat format) {
  checkTexels(texels, texels);
  for (int axis = 0; axis < 2; ++axis) checkRoughness(material.roughness[axis]);
  checkRefraction(material.eta, material.k);
  const double largest = largestDistribution(material);
  FactoredBrdf result;
  result.factorisation = Factorisation::slopes;
  result.warped = warped;
  result.name = fmt::format("slopes {} x {}, {}", texels, texels, warped ? "warped" : "angles");
  result.scale = dvec3(largest);
  result.alpha = glm::vec2(clampedRoughness(material));
  result.independent = material.masking == Masking::product;
  result.tables.push_back(FactorTable::of({texels, texels, 1}, format, [&](const dvec3& place) {
    return dvec3(slopeDistribution(material, halfAt(place, warped)) / largest);
  }));
  result.tables.push_back(FactorTable::of({texels, 2, 1}, format, [&](const dvec3& place) {
    if (place.y > 0) return dvec3(cosineLambda(place.x, 1));
    return reflectance(material.fresnel, place.x * place.x, material.eta, material.k);
  }));
  return result;
}

FactoredBrdf banksTable(const Banks& material, int texels, TableFormat format) {
  checkTexels(texels, texels);
  for (int c = 0; c < 3; ++c)
    if (!(material.kd[c] >= 0 && material.ks[c] >= 0 && material.kd[c] < 1e6 && material.ks[c] < 1e6))
      throw UsageError(fmt::format("Banks's coefficients {} and {}: numbers of 0 or more are needed",
                                   material.kd[c], material.ks[c]));
  if (!(material.exponent >= 0 && material.exponent < 1e9))
    throw UsageError(fmt::format("exponent {}: a number of 0 or more is needed", material.exponent));
  FactoredBrdf result;
  result.factorisation = Factorisation::fibres;
  result.name = fmt::format("fibres {} x {}", texels, texels);
  result.scale = material.kd + material.ks;
  const dvec3 share = material.ks / glm::max(result.scale, dvec3(1e-300));  // of the lobe
  result.tables.push_back(FactorTable::of({texels, texels, 1}, format, [&](const dvec3& place) {
    const double l = 2 * place.x - 1, v = 2 * place.y - 1;
    const double sine = std::sqrt(std::max(0.0, 1 - l * l));
    return (1.0 - share) * sine + share * coneLobe(l, v, material.exponent);
  }));
  return result;
}

}  // namespace limn::brdf
