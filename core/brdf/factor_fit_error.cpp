#include "core/brdf/factor_fit_error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace limn::brdf {
namespace {

using glm::dvec3;

/// Towards the lights, with the viewer along +z and +y up.
using Lights = std::array<dvec3, 5>;
const Lights kChoosing{dvec3(0.5, 0.6, 0.62), dvec3(-0.7, 0.3, 0.65), dvec3(0, -0.8, 0.6),
                       dvec3(0.9, -0.1, 0.1), dvec3(-0.5, 0.7, -0.5)};
const Lights kHeldOut{dvec3(-0.3, 0.2, 0.93), dvec3(0.6, -0.5, 0.62), dvec3(-0.4, -0.8, 0.45),
                      dvec3(-0.9, 0.4, 0.15), dvec3(0.7, 0.5, -0.5)};

/// Rows are the tangent along the circle of latitude, the bitangent and the normal.
glm::dmat3 localFrame(const dvec3& n) {
  const dvec3 along = glm::cross(dvec3(0, 1, 0), n);
  const double size = glm::length(along);
  const dvec3 t = size > 1e-9 ? along / size : dvec3(1, 0, 0);
  return glm::transpose(glm::dmat3(t, glm::cross(n, t), n));
}

}  // namespace

SpherePicture::SpherePicture(const Brdf& exact, int size, PictureLights lights) {
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double px = (2.0 * x + 1) / size - 1, py = (2.0 * y + 1) / size - 1;
      const double height2 = 1 - px * px - py * py;
      if (height2 <= 0) continue;
      const glm::dmat3 toLocal = localFrame({px, py, std::sqrt(height2)});
      Pixel pixel{toLocal * dvec3(0, 0, 1), {}, dvec3(0)};
      for (const dvec3& light : lights == PictureLights::choosing ? kChoosing : kHeldOut) {
        const dvec3 l = toLocal * glm::normalize(light);
        if (!(l.z > 0)) continue;
        pixel.lights.push_back(l);
        pixel.radiance += exact(l, pixel.v) * l.z;
      }
      power_ += glm::dot(pixel.radiance, pixel.radiance);
      pixels_.push_back(std::move(pixel));
    }
}

double SpherePicture::errorOf(const Response& approximation) const {
  double sum = 0;
  for (const Pixel& pixel : pixels_) {
    dvec3 radiance(0);
    for (const dvec3& l : pixel.lights) radiance += approximation(l, pixel.v);
    const dvec3 difference = radiance - pixel.radiance;
    sum += glm::dot(difference, difference);
  }
  if (sum == 0) return 0;
  return power_ > 0 ? std::sqrt(sum / power_) : std::numeric_limits<double>::infinity();
}

dvec3 albedoOfResponse(const Response& response, const dvec3& v) {
  constexpr int kAlong = 96, kAround = 64;
  // The half vector at sqrt(1 - n.h) = t^2: strata crowd around n, where lobes are. d(omega_h) = 2 q dq
  // d(azimuth) with q = t^2, and d(omega_l) = 4 v.h d(omega_h).
  dvec3 sum(0);
  for (int i = 0; i < kAlong; ++i) {
    const double t = (i + 0.5) / kAlong, q = t * t;
    const double cosine = 1 - q * q, sine = q * std::sqrt(2 - q * q);
    for (int j = 0; j < kAround; ++j) {
      const double azimuth = 2 * std::numbers::pi * (j + 0.5) / kAround;
      const dvec3 h(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine);
      const double vDotH = glm::dot(v, h);
      if (!(vDotH > 0)) continue;
      const dvec3 l = 2 * vDotH * h - v;
      if (l.z > 0) sum += response(l, v) * (4 * vDotH * 2 * q * 2 * t);
    }
  }
  return sum * (2 * std::numbers::pi / (kAlong * kAround));
}

double largestAlbedo(const Response& response, bool isotropic) {
  constexpr int kAngles = 12, kDegrees = 8;  // up to 88 degrees
  const auto of = [&](int view) {
    const double theta = view % kAngles * kDegrees * std::numbers::pi / 180,
                 phi = view / kAngles * std::numbers::pi / 4;
    return albedoOfResponse(
        response, {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
  };
  return tbb::parallel_reduce(
      tbb::blocked_range<int>(0, kAngles * (isotropic ? 1 : 8)), 0.0,
      [&](const tbb::blocked_range<int>& views, double largest) {
        for (int view = views.begin(); view < views.end(); ++view) {
          const dvec3 albedo = of(view);
          largest = std::max({largest, albedo.x, albedo.y, albedo.z});
        }
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
}

}  // namespace limn::brdf
