#include "core/brdf/factor_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <numbers>

#include "core/base/error.h"
#include "core/brdf/private/table_checks.h"
#include "glsl/materials/factored.glsl"

namespace limn::brdf {
namespace {

using glm::dvec3;
using glm::ivec3;
using glm::vec3;

const double kRootPi = std::sqrt(std::numbers::pi);

float kept(float value, TableFormat format) {
  switch (format) {
    case TableFormat::float32:
      return value;
    case TableFormat::half:
      return glm::unpackHalf1x16(glm::packHalf1x16(std::clamp(value, -65504.f, 65504.f)));
    case TableFormat::byte:
      return std::round(255 * std::clamp(value, 0.f, 1.f)) / 255;
  }
  return value;
}

double clampedRoughness(const TorranceSparrow& material) {
  return std::max(material.roughness, kLeastRoughness);
}

/// Dawson's integral by its power series, which converges everywhere and keeps its digits for |x| up to 2.
double dawson(double x) {
  double term = x, sum = x;
  for (int k = 1; k < 200 && std::abs(term) > 1e-17 * std::abs(sum); ++k) {
    term *= -2 * x * x / (2 * k + 1);
    sum += term;
  }
  return sum;
}

std::size_t formatBytes(TableFormat format) {
  return format == TableFormat::float32 ? 4 : format == TableFormat::half ? 2 : 1;
}

}  // namespace

void checkTexels(int width, int height) {
  if (width < 2 || height < 2)
    throw UsageError(fmt::format("factored tables need 2 x 2 texels or more, not {} x {}", width, height));
}

void checkRoughness(double roughness) {
  if (!(roughness >= 0 && roughness <= 1))
    throw UsageError(fmt::format("roughness is {}: a number of [0, 1] is needed", roughness));
}

void checkRefraction(const dvec3& eta, const dvec3& k) {
  for (int c = 0; c < 3; ++c)
    if (!(eta[c] > 0 && eta[c] < 1e6 && k[c] >= 0 && k[c] < 1e6))
      throw UsageError(fmt::format("index of refraction {} + {} i: eta above 0 and k of 0 or more are needed",
                                   eta[c], k[c]));
}

FactorTable FactorTable::of(const ivec3& size, TableFormat format,
                            const std::function<dvec3(const dvec3& place)>& value) {
  FactorTable table{size.x, size.y, size.z, format, {}};
  table.texels.reserve(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                       static_cast<std::size_t>(size.z));
  const dvec3 last(glm::max(size - 1, ivec3(1)));
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) table.texels.emplace_back(value(dvec3(x, y, z) / last));
  table.round();
  return table;
}

void FactorTable::round() {
  for (vec3& texel : texels)
    for (int c = 0; c < 3; ++c) texel[c] = kept(texel[c], format);
}

std::size_t FactorTable::bytes() const {
  return texels.size() * 3 * formatBytes(format);
}

dvec3 FactoredBrdf::evaluate(const dvec3& l, const dvec3& v) const {
  if (!(l.z > 0 && v.z >= 0)) return dvec3(0);
  const vec3 light(l), view(v);
  const glsl::FactoredAngles angles = glsl::factored_angles(vec3(0, 0, 1), view, light);
  vec3 product(0);
  switch (factorisation) {
    case Factorisation::tables:
      product = glsl::factored_response(tables[0], tables[1], 0, angles, warped);
      break;
    case Factorisation::dfg:
      product = glsl::factored_dfg_response(tables[0], 0, tables[0].depth, angles);
      break;
    case Factorisation::pqp:
      product = glsl::factored_pqp_response(tables[0], 0, tables[0].depth, angles);
      break;
    case Factorisation::pqp_disc:
      product = glsl::factored_pqp_disc_response(tables[0], 0, tables[0].depth / 2, view, light, warped);
      break;
    case Factorisation::dfg_disc:
      product =
          glsl::factored_dfg_disc_response(tables[0], tables[1], 0, tables[1].depth, view, light, warped);
      break;
    case Factorisation::svd:
      product = glsl::factored_svd_response(tables[0], tables[1], 0, tables[0].depth, view, light);
      break;
    case Factorisation::trilinear:
      product = glsl::factored_volume_response(tables[0], 0, tables[0].depth, view, light);
      break;
    case Factorisation::slopes:
      product =
          glsl::factored_slopes_response(tables[0], tables[1], 0, alpha, independent, view, light, warped);
      break;
    case Factorisation::fibres:
      product = glsl::factored_fibres_response(tables[0], 0, view, light);
      break;
  }
  return scale * dvec3(product) + floor * l.z;
}

std::size_t FactoredBrdf::bytes() const {
  std::size_t sum = 0;
  for (const FactorTable& table : tables) sum += table.bytes();
  return sum;
}

double fresnelReflectance(double cosine, double eta, double k) {
  if (eta == 1 && k == 0) return 0;
  if (cosine <= 0) return 1;
  const double cos2 = std::min(cosine * cosine, 1.0), sin2 = 1 - cos2;
  const double difference = eta * eta - k * k - sin2;
  const double size =
      std::hypot(difference, 2 * eta * k);  // a^2 + b^2, a + ib the refracted cosine times eta
  const double twice = 2 * std::min(cosine, 1.0) * std::sqrt(std::max(0.0, 0.5 * (size + difference)));
  const double across = (size + cos2 - twice) / (size + cos2 + twice);
  const double straight = cos2 * size + sin2 * sin2, mixed = twice * sin2;
  return std::clamp(0.5 * across * (1 + (straight - mixed) / (straight + mixed)), 0.0, 1.0);
}

double schlickReflectance(double cosine, double eta, double k) {
  const double straight = fresnelReflectance(1, eta, k);
  return straight + (1 - straight) * std::pow(1 - std::clamp(cosine, 0.0, 1.0), 5);
}

dvec3 reflectance(FresnelTerm term, double cosine, const dvec3& eta, const dvec3& k) {
  dvec3 result;
  for (int c = 0; c < 3; ++c)
    result[c] = term == FresnelTerm::exact ? fresnelReflectance(cosine, eta[c], k[c])
                                           : schlickReflectance(cosine, eta[c], k[c]);
  return result;
}

double normalDistribution(const TorranceSparrow& material, double fromNormal) {
  const double m = clampedRoughness(material);
  const double cosine = 1 - fromNormal * fromNormal;
  if (material.distribution == NormalDistribution::gaussian) {
    const double angle = 2 * std::asin(std::min(1.0, fromNormal * std::numbers::sqrt2 / 2));
    return std::exp(-angle * angle / (m * m)) / (std::numbers::pi * m * dawson(m));
  }
  if (!(cosine > 0)) return 0;
  const double cos2 = cosine * cosine, sin2 = fromNormal * fromNormal * (2 - fromNormal * fromNormal);
  const double exponent = -sin2 / (cos2 * m * m);
  return exponent < -700 ? 0 : std::exp(exponent) / (std::numbers::pi * m * m * cos2 * cos2);
}

double cosineLambda(double cosine, double roughness) {
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  if (sine == 0) return 0;
  const double a = cosine / (roughness * sine);
  return std::max(0.0, 0.5 * (roughness * sine * std::exp(-a * a) / kRootPi - cosine * std::erfc(a)));
}

namespace {

/// Is the cosine of a direction and its cosineLambda().
struct Masked {
  double cosine, lambda;
};
Masked maskedAt(const TorranceSparrow& material, double cosine) {
  return {cosine, cosineLambda(cosine, clampedRoughness(material))};
}
double maskingOfBoth(Masking masking, const Masked& l, const Masked& v) {
  if (masking == Masking::product) return l.cosine / (l.cosine + l.lambda) / (4 * (v.cosine + v.lambda));
  if (l.cosine <= 0 && v.cosine <= 0) return 1 / (4 * (l.lambda + v.lambda));
  return l.cosine / (4 * (l.cosine * v.cosine + v.cosine * l.lambda + l.cosine * v.lambda));
}

/// Returns what a factor is at the places of the texels along an axis.
template <class Value>
auto alongAxis(int texels, const Value& value) {
  std::vector<decltype(value(0.0))> row;
  row.reserve(static_cast<size_t>(texels));
  for (int i = 0; i < texels; ++i) row.push_back(value(static_cast<double>(i) / (texels - 1)));
  return row;
}

/// Returns the table of a function of what stands at a texel's column and at its row.
template <class Column, class Row, class Value>
FactorTable crossTable(const std::vector<Column>& columns, const std::vector<Row>& rows, TableFormat format,
                       const Value& value) {
  FactorTable table{static_cast<int>(columns.size()), static_cast<int>(rows.size()), 1, format, {}};
  table.texels.reserve(columns.size() * rows.size());
  for (const Row& row : rows)
    for (const Column& column : columns) table.texels.emplace_back(value(column, row));
  table.round();
  return table;
}

/// Returns the largest D. The Gaussian of the angle has it at n; Beckmann's distribution, with 1 / (n.h)^2 =
/// q, is q^2 exp(-(q - 1) / m^2), which rises away from n where the width m is above sqrt(1/2).
double largestDistribution(const TorranceSparrow& material) {
  const double m = clampedRoughness(material);
  const bool wide = material.distribution == NormalDistribution::beckmann && 2 * m * m > 1;
  return normalDistribution(material, wide ? std::sqrt(1 - 1 / (std::numbers::sqrt2 * m)) : 0);
}

}  // namespace

double maskingOverCosine(const TorranceSparrow& material, double nDotL, double nDotV) {
  return maskingOfBoth(material.masking, maskedAt(material, nDotL), maskedAt(material, nDotV));
}

FactoredBrdf torranceSparrowTables(const TorranceSparrow& material, int width, int height, bool warped,
                                   TableFormat format) {
  checkTexels(width, height);
  checkRoughness(material.roughness);
  checkRefraction(material.eta, material.k);
  const bool bytes = format == TableFormat::byte;
  const double largest = largestDistribution(material);  // Fresnel's term is at most 1
  const double unit =
      bytes ? std::numbers::pi / 4 : 1;  // what T2 is divided by: G / (pi n.v) is what is clamped
  FactoredBrdf result;
  result.warped = warped;
  result.name = fmt::format("tables {} x {}, {}", width, height, warped ? "warped" : "cosines");
  result.scale = dvec3(largest * unit);
  // What depends on one coordinate is worked out once for all texels that share it.
  const auto fresnel = [&](double place) {
    return reflectance(material.fresnel, place, material.eta, material.k);
  };
  const auto distribution = [&](double place) {
    return normalDistribution(material, warped ? 1 - place : std::sqrt(1 - place)) / largest;
  };
  const auto masked = [&](double place) { return maskedAt(material, warped ? place * place : place); };
  result.tables.push_back(crossTable(alongAxis(width, fresnel), alongAxis(height, distribution), format,
                                     [](const dvec3& f, double d) { return f * d; }));
  result.tables.push_back(crossTable(alongAxis(width, masked), alongAxis(height, masked), format,
                                     [&](const Masked& l, const Masked& v) {
                                       const double value = maskingOfBoth(material.masking, l, v) / unit;
                                       return dvec3(bytes ? std::min(value, 1.0) : value);
                                     }));
  return result;
}

}  // namespace limn::brdf

namespace limn::glsl {
namespace {

/// The two texels around `place` of an axis of `size` texels, and the weight of the second: as OpenGL 4.5,
/// section 8.14.3, with clamping to the edge.
struct Neighbours {
  int low, high;
  float weight;
};

Neighbours neighbours(float coordinate, int size) {
  const float u = coordinate * static_cast<float>(size) - 0.5f;
  const float low = std::floor(u);
  const int first = static_cast<int>(low);
  return {std::clamp(first, 0, size - 1), std::clamp(first + 1, 0, size - 1), u - low};
}

}  // namespace

vec3 factored_lookup(const brdf::FactorTable& table, vec2 place, int layer) {
  const vec2 uv =
      factored_coordinates(place, vec2(static_cast<float>(table.width), static_cast<float>(table.height)));
  const Neighbours x = neighbours(uv.x, table.width), y = neighbours(uv.y, table.height);
  const vec3 low = mix(table.at(x.low, y.low, layer), table.at(x.high, y.low, layer), x.weight);
  const vec3 high = mix(table.at(x.low, y.high, layer), table.at(x.high, y.high, layer), x.weight);
  return mix(low, high, y.weight);
}

}  // namespace limn::glsl
