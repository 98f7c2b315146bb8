// Skies, views and errors for measuring what prefiltered environments cost.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>

#include "glsl/numeric/geometry.glsl"
#include "tests/unit/glsl/random.h"

namespace limn::glsl {

/// A sky over a dark ground with four lamps.
struct Sky {
  std::string name;
  std::array<double, 4> strengths, sharpness;  ///< of the lamps: Gaussians on the sphere

  double radiance(const vec3& d) const {
    static const std::array lamps{normalize(vec3(1, 2, 0.5f)), normalize(vec3(-2, 1, 1)),
                                  normalize(vec3(0.2f, 0.4f, -1)), normalize(vec3(-0.5f, -0.3f, 1))};
    double sum = 0.15 + 0.35 / (1 + std::exp(-20 * static_cast<double>(d.y)));
    for (size_t i = 0; i < lamps.size(); ++i)
      sum += strengths[i] * std::exp(sharpness[i] * (static_cast<double>(dot(d, lamps[i])) - 1));
    return sum;
  }
};

/// Standard deviations of 13 to 26 degrees, and of 4 to 15.
inline const std::array kSkies{Sky{"wide lamps", {4, 3, 2, 2}, {20, 12, 8, 5}},
                               Sky{"narrow lamps", {20, 8, 5, 3}, {180, 60, 30, 15}}};

constexpr int kSide = 64;  ///< of the grid of samples

inline vec2 gridPoint(int i) {
  return {(static_cast<float>(i % kSide) + 0.5f) / kSide, (static_cast<float>(i / kSide) + 0.5f) / kSide};
}

/// Surfaces seen at angles from the normal within a range, degrees.
struct Views {
  double low, high;
  Random random{9};

  std::pair<vec3, vec3> next() {
    std::uniform_real_distribution<double> between(std::cos(high * M_PI / 180), std::cos(low * M_PI / 180)),
        turn(0, 2 * M_PI);
    const vec3 n = random.direction();
    const double cosine = between(random.engine), sine = std::sqrt(1 - cosine * cosine),
                 azimuth = turn(random.engine);
    return {n, from_local(frame_around(n), vec3(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine))};
  }
};

/// RMS of differences over the RMS of exact values.
struct RelativeError {
  double squares = 0, signal = 0;

  void add(double value, double exact) {
    squares += (value - exact) * (value - exact);
    signal += exact * exact;
  }
  double value() const { return std::sqrt(squares / signal); }
};

constexpr int kViews = 100;

}  // namespace limn::glsl
