// BRDFs that tests of tables and fits compare with: Torrance and Sparrow's in double precision, written from
// its equations by other ways than core's, and the renderer's own metal and plastic.
#pragma once

#include <cmath>
#include <complex>
#include <glm/glm.hpp>
#include <numbers>

#include "core/brdf/factor_tables.h"
#include "glsl/surface/brdf.glsl"

namespace limn::brdf {

/// Fresnel's reflectance from the complex refracted angle.
inline double exactFresnel(double cosine, const std::complex<double>& eta) {
  const double sine2 = 1 - cosine * cosine;
  const std::complex<double> refracted = std::sqrt(1.0 - sine2 / (eta * eta));
  const std::complex<double> across = (cosine - eta * refracted) / (cosine + eta * refracted);
  const std::complex<double> along = (eta * cosine - refracted) / (eta * cosine + refracted);
  return 0.5 * (std::norm(across) + std::norm(along));
}

/// Dawson's integral by Simpson's rule.
inline double exactDawson(double x) {
  constexpr int kSteps = 2000;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = x * i / kSteps;
    sum += std::exp(t * t - x * x) * (i == 0 || i == kSteps ? 1 : i % 2 ? 4 : 2);
  }
  return sum * x / (3 * kSteps);
}

inline double exactLambda(double cosine, double m) {
  const double tangent = std::tan(std::acos(cosine));
  if (tangent < 1e-12) return 0;
  const double a = 1 / (m * tangent);
  return (std::erf(a) - 1) / 2 + std::exp(-a * a) / (2 * a * std::sqrt(std::numbers::pi));
}

inline double exactDistribution(const TorranceSparrow& material, const glm::dvec3& h) {
  const double m = material.roughness, angle = std::atan2(std::hypot(h.x, h.y), h.z);
  if (material.distribution == NormalDistribution::gaussian)
    return std::exp(-angle * angle / (m * m)) / (std::numbers::pi * m * exactDawson(m));
  const double tangent = std::tan(angle);
  return std::exp(-tangent * tangent / (m * m)) / (std::numbers::pi * m * m * std::pow(std::cos(angle), 4));
}

inline Brdf exactTorranceSparrow(const TorranceSparrow& material) {
  const double gaussianNorm = exactDawson(material.roughness);
  return [material, gaussianNorm](const glm::dvec3& l, const glm::dvec3& v) {
    const glm::dvec3 h = glm::normalize(l + v);
    const double m = material.roughness, ofL = exactLambda(l.z, m), ofV = exactLambda(v.z, m);
    const double g =
        material.masking == Masking::correlated ? 1 / (1 + ofL + ofV) : 1 / ((1 + ofL) * (1 + ofV));
    const double angle = std::atan2(std::hypot(h.x, h.y), h.z);
    const double d = material.distribution == NormalDistribution::gaussian
                         ? std::exp(-angle * angle / (m * m)) / (std::numbers::pi * m * gaussianNorm)
                         : exactDistribution(material, h);
    glm::dvec3 f;
    for (int c = 0; c < 3; ++c)
      f[c] = exactFresnel(std::min(glm::dot(l, h), 1.0), {material.eta[c], -material.k[c]}) * d * g /
             (4 * l.z * v.z);
    return f;
  };
}

/// The renderer's own BRDF.
inline Brdf rendererBrdf(const glm::vec3& baseColour, float metallic, float alpha) {
  const glsl::SurfaceBrdf surface =
      glsl::surface_brdf(baseColour, metallic, std::sqrt(alpha), 1, glm::vec3(1), 1.5f);
  return [surface](const glm::dvec3& l, const glm::dvec3& v) {
    return glm::dvec3(glsl::brdf(surface, {0, 0, 1}, glm::vec3(v), glm::vec3(l)));
  };
}
inline Brdf metal(float alpha) {
  return rendererBrdf({0.95f, 0.64f, 0.54f}, 1, alpha);
}
inline Brdf plastic(float alpha) {
  return rendererBrdf({0.6f, 0.3f, 0.1f}, 0, alpha);
}

}  // namespace limn::brdf
