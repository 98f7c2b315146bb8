#include "core/brdf/tabulated.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/base/error.h"
#include "core/brdf/private/fill_unknown.h"
#include "glsl/materials/measured.glsl"

namespace limn::brdf {
namespace {

/// Nodes this near to the horizon take their values from neighbours: a BRDF may have a pole there.
constexpr float kLeastCosine = 1e-4f;

bool isValue(const glm::vec3& f) {
  for (int channel = 0; channel < 3; ++channel)
    if (!(f[channel] >= 0 && f[channel] <= kLargestValue)) return false;
  return true;
}

bool isNegative(const glm::vec3& f) {
  return f.x < 0 || f.y < 0 || f.z < 0;
}

/// Returns the nodes beside one along the axes: up to six, of which those across the seam of phiD are two.
GridNeighbours neighboursOf(const glm::ivec3& size, std::size_t node) {
  const auto m = static_cast<std::size_t>(size.y), p = static_cast<std::size_t>(size.z);
  const std::size_t k = node % p, j = node / p % m, i = node / p / m;
  const std::size_t row = node - k;
  GridNeighbours beside;
  if (i > 0) beside.add(node - p * m);
  if (i + 1 < static_cast<std::size_t>(size.x)) beside.add(node + p * m);
  if (j > 0) beside.add(node - p);
  if (j + 1 < m) beside.add(node + p);
  beside.add(row + (k + 1) % p);
  beside.add(row + (k + p - 1) % p);
  return beside;
}

}  // namespace

HalfDifference halfDifference(const glm::vec3& l, const glm::vec3& v) {
  const glm::vec3 angles = glsl::half_difference_angles(v, l);
  return {angles.x, angles.y, angles.z};
}

DirectionPair directions(const HalfDifference& angles) {
  const float cosine = std::cos(angles.thetaH), sine = std::sin(angles.thetaH);
  const glm::vec3 t(cosine, 0, -sine), b(0, 1, 0), h(sine, 0, cosine);
  const glm::vec3 across = std::sin(angles.thetaD) * (std::cos(angles.phiD) * t + std::sin(angles.phiD) * b);
  const glm::vec3 along = std::cos(angles.thetaD) * h;
  return {along + across, along - across};
}

HalfDifference TabulatedBrdf::node(int i, int j, int k) const {
  const glm::vec3 share = glm::vec3(i, j, k) / glm::vec3(size);
  return {0.5f * std::numbers::pi_v<float> * share.x * share.x, 0.5f * std::numbers::pi_v<float> * share.y,
          std::numbers::pi_v<float> * share.z};
}

glm::vec3 TabulatedBrdf::evaluate(const glm::vec3& l, const glm::vec3& v) const {
  if (!(l.z > 0 && v.z > 0) || values.empty()) return glm::vec3(0);
  return glsl::measured_isotropic(values.data(), glm::uvec3(size), v, l);
}

bool fillInvalid(TabulatedBrdf& table) {
  std::vector<char> known;
  for (const glm::vec3& value : table.values) known.push_back(isNegative(value) ? 0 : 1);
  const bool any = std::ranges::find(known, 1) != known.end();
  fillUnknown(table.values, known, [&](std::size_t node) { return neighboursOf(table.size, node); });
  return any;
}

std::size_t nodeCount(const glm::ivec3& size) {
  return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
         static_cast<std::size_t>(size.z);
}

TabulatedBrdf tabulate(const glm::ivec3& size, const BrdfFunction& f) {
  TabulatedBrdf table{.size = size, .values = {}};
  table.values.reserve(nodeCount(size));
  for (int i = 0; i < size.x; ++i)
    for (int j = 0; j < size.y; ++j)
      for (int k = 0; k < size.z; ++k) {
        const auto [l, v] = directions(table.node(i, j, k));
        glm::vec3 value(-1);
        if (l.z > kLeastCosine && v.z > kLeastCosine) {
          const glm::vec3 mean = 0.5f * (f(l, v) + f(v, l));
          if (isValue(mean)) value = mean;
        }
        table.values.push_back(value);
      }
  if (!fillInvalid(table)) throw Error("a BRDF that is nowhere a number from 0 to 1e10");
  return table;
}

glm::vec3 AnisotropicTable::texelDirection(int x, int y) const {
  const glm::vec2 s = (2.0f * glm::vec2(x, y) + 1.0f) / static_cast<float>(size) - 1.0f;
  const float length = glm::length(s);
  const glm::vec2 p = length > 0 ? s * (std::max(std::abs(s.x), std::abs(s.y)) / length) : s;
  const float square = glm::dot(p, p);
  return glm::vec3(2.0f * p, 1 - square) / (1 + square);
}

glm::vec3 AnisotropicTable::evaluate(const glm::vec3& l, const glm::vec3& v) const {
  if (!(l.z > 0 && v.z > 0) || values.empty()) return glm::vec3(0);
  return glsl::measured_pairs(values.data(), static_cast<uint32_t>(size), v, l);
}

AnisotropicTable tabulateAnisotropic(int size, const BrdfFunction& f) {
  AnisotropicTable table{.size = size, .values = {}};
  std::vector<glm::vec3> texels;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) texels.push_back(table.texelDirection(x, y));
  table.values.reserve(texels.size() * texels.size());
  for (const glm::vec3& v : texels)
    for (const glm::vec3& l : texels) table.values.push_back(f(l, v));
  return table;
}

AnisotropicTable tabulateReciprocal(int size, const BrdfFunction& f) {
  AnisotropicTable table = tabulateAnisotropic(size, f);
  const std::size_t directions = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  for (std::size_t v = 0; v < directions; ++v)
    for (std::size_t l = 0; l <= v; ++l) {
      glm::vec3 &one = table.values[v * directions + l], &other = table.values[l * directions + v];
      if (!isValue(one)) one = other;
      if (!isValue(one)) throw Error("a BRDF that is no number from 0 to 1e10 between two directions");
      if (!isValue(other)) other = one;
      one = other = 0.5f * (one + other);
    }
  return table;
}

glm::dvec3 albedoOfBrdf(const BrdfFunction& f, const glm::vec3& v, int steps) {
  glm::dvec3 sum(0);
  if (!(v.z > 0)) return sum;
  constexpr double pi = std::numbers::pi;
  for (int i = 0; i < steps; ++i) {
    const double share = (i + 0.5) / steps, theta = pi / 2 * share * share;
    for (int j = 0; j < steps; ++j) {
      const double phi = 2 * pi * (j + 0.5) / steps;
      const glm::dvec3 h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const double cosine = glm::dot(h, glm::dvec3(v));
      const glm::dvec3 l = 2 * cosine * h - glm::dvec3(v);
      if (cosine <= 0 || l.z <= 0) continue;
      // dl = 4 (h.v) dh, and dh = sin(theta) dtheta dphi with dtheta = pi share dshare.
      sum += glm::dvec3(f(glm::vec3(l), v)) * (l.z * 4 * cosine * std::sin(theta) * share);
    }
  }
  return sum * (pi * 2 * pi / steps / steps);
}

}  // namespace limn::brdf
