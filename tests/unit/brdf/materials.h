// BRDFs in double precision that tables are compared with, and the sphere that they are compared on.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>

#include "core/brdf/tabulated.h"

namespace limn::brdf::test {

constexpr double kPi = std::numbers::pi;

/// Beckmann's distribution with width m, Smith's correlated masking, exact Fresnel reflection; over a
/// Lambertian floor.
struct Microfacets {
  double m = 0.3;
  glm::dvec3 eta{0.18, 0.42, 1.37}, k{3.42, 2.35, 1.77};  // gold
  glm::dvec3 diffuse{0};

  double distribution(double cosine) const {
    const double c2 = cosine * cosine, tan2 = (1 - c2) / c2;
    return std::exp(-tan2 / (m * m)) / (kPi * m * m * c2 * c2);
  }
  /// Smith's Lambda.
  double masked(double cosine) const {
    const double a = cosine / (m * std::sqrt(std::max(1 - cosine * cosine, 1e-300)));
    return (std::erf(a) - 1) / 2 + std::exp(-a * a) / (2 * a * std::sqrt(kPi));
  }
  static double fresnel(double cosine, double n, double kappa) {
    const double c2 = cosine * cosine, s2 = 1 - c2, n2 = n * n, k2 = kappa * kappa;
    const double t = n2 - k2 - s2, a2b2 = std::sqrt(t * t + 4 * n2 * k2);
    const double a = std::sqrt(std::max((a2b2 + t) / 2, 0.0));
    const double rs = (a2b2 + c2 - 2 * a * cosine) / (a2b2 + c2 + 2 * a * cosine);
    const double u = c2 * a2b2 + s2 * s2, w = 2 * a * cosine * s2;
    return rs * (1 + (u - w) / (u + w)) / 2;
  }
  glm::vec3 operator()(const glm::vec3& from, const glm::vec3& to) const {
    const glm::dvec3 l(from), v(to), h = glm::normalize(l + v);
    const double g = 1 / (1 + masked(l.z) + masked(v.z));
    const double rest = distribution(h.z) * g / (4 * l.z * v.z);
    glm::dvec3 f = diffuse / kPi;
    for (int c = 0; c < 3; ++c) f[c] += rest * fresnel(glm::dot(h, l), eta[c], k[c]);
    return glm::vec3(f);
  }
};

inline Microfacets plastic(double m) {
  return {.m = m, .eta = glm::dvec3(1.5), .k = glm::dvec3(0), .diffuse = {0.4, 0.1, 0.05}};
}

/// What separates the picture of a sphere under a BRDF from that under the exact one.
struct SphereError {
  double rms = 0;   ///< over the RMS of the exact picture
  double bias = 0;  ///< mean of the difference over the mean of the exact picture
};

/// Returns it for a sphere that is seen from afar, 96 pixels across, with tangents along the parallels, in
/// five lights.
inline SphereError compareOnSphere(const BrdfFunction& f, const BrdfFunction& exact) {
  const glm::vec3 lights[] = {{0, 0, 1}, {0.6f, 0.5f, 0.62f}, {-0.8f, 0.3f, 0.52f}, {0.2f, -0.9f, 0.39f}};
  double error2 = 0, exact2 = 0, difference = 0, mean = 0;
  constexpr int pixels = 96;
  for (int y = 0; y < pixels; ++y)
    for (int x = 0; x < pixels; ++x) {
      const glm::vec2 p = (2.0f * glm::vec2(x, y) + 1.0f) / static_cast<float>(pixels) - 1.0f;
      if (glm::dot(p, p) >= 1) continue;
      const glm::vec3 n(p, std::sqrt(1 - glm::dot(p, p)));
      const glm::vec3 t = glm::normalize(glm::cross(glm::vec3(0, 1, 0), n)), b = glm::cross(n, t);
      const auto local = [&](const glm::vec3& d) {
        return glm::vec3(glm::dot(d, t), glm::dot(d, b), glm::dot(d, n));
      };
      const glm::vec3 v = local({0, 0, 1});
      glm::dvec3 found(0), right(0);
      for (const glm::vec3& light : lights) {
        const glm::vec3 l = local(glm::normalize(light));
        if (!(l.z > 0)) continue;
        found += glm::dvec3(f(l, v) * l.z);
        right += glm::dvec3(exact(l, v) * l.z);
      }
      for (int c = 0; c < 3; ++c) {
        error2 += (found[c] - right[c]) * (found[c] - right[c]);
        exact2 += right[c] * right[c];
        difference += found[c] - right[c];
        mean += right[c];
      }
    }
  return {std::sqrt(error2 / exact2), difference / mean};
}

inline BrdfFunction lookup(const TabulatedBrdf& table) {
  return [&table](const glm::vec3& l, const glm::vec3& v) { return table.evaluate(l, v); };
}

}  // namespace limn::brdf::test
