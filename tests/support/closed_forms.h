// Published formulas that tests compare renderers with; none of it is code that the project renders with.
#pragma once

#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace limn::test {

/// Irradiance from a polygon of radiance 1 on a surface at `x` with normal n, clipped by its horizon:
/// Lambert's formula (1760), 1/2 sum of edge angles times the cosine between n and the edge's plane.
/// `vertices` clockwise or not.
inline double lambertIrradiance(const glm::dvec3& x, const glm::dvec3& n,
                                const std::vector<glm::dvec3>& vertices) {
  std::vector<glm::dvec3> above;
  for (size_t i = 0; i < vertices.size(); ++i) {
    const glm::dvec3 p = vertices[i] - x, q = vertices[(i + 1) % vertices.size()] - x;
    const double hp = glm::dot(n, p), hq = glm::dot(n, q);
    if (hp >= 0) above.push_back(p);
    if ((hp >= 0) != (hq >= 0)) above.push_back(p + hp / (hp - hq) * (q - p));
  }
  double sum = 0;
  for (size_t i = 0; i < above.size(); ++i) {
    const glm::dvec3 p = above[i], q = above[(i + 1) % above.size()], across = glm::cross(p, q);
    const double sine = glm::length(across);
    if (sine > 0) sum += std::atan2(sine, glm::dot(p, q)) * glm::dot(n, across) / sine;
  }
  return 0.5 * std::abs(sum);
}

/// Share of unpolarised light that a smooth interface from index n1 to n2 reflects (Fresnel 1823); `cosine`
/// of incidence.
inline double fresnel(double cosine, double n1, double n2) {
  const double sine2 = n1 * n1 / (n2 * n2) * (1 - cosine * cosine);
  if (sine2 >= 1) return 1;
  const double other = std::sqrt(1 - sine2);
  const double s = (n1 * cosine - n2 * other) / (n1 * cosine + n2 * other);
  const double p = (n2 * cosine - n1 * other) / (n2 * cosine + n1 * other);
  return 0.5 * (s * s + p * p);
}

/// Direction of light along d (unit) behind an interface of normal n (unit, against d): Snell's law; eta: the
/// index before it over the one behind.
inline glm::dvec3 snell(const glm::dvec3& d, const glm::dvec3& n, double eta) {
  const double cosine = -glm::dot(d, n);
  return eta * d + (eta * cosine - std::sqrt(1 - eta * eta * (1 - cosine * cosine))) * n;
}

inline glm::dvec3 mirrored(const glm::dvec3& d, const glm::dvec3& n) {
  return d - 2 * glm::dot(d, n) * n;
}

}  // namespace limn::test
