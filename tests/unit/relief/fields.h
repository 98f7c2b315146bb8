// Height fields of the tests: periodic tiles of size x size texels over 1 m x 1 m.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "core/relief/height_field.h"
#include "core/relief/horizon.h"
#include "glsl/relief/horizon_map.glsl"

namespace limn::relief::test {

/// Returns the field of a function of u and v whose slopes have the given root of the mean square.
inline HeightField fieldOf(int size, double rmsSlope,
                           const std::function<double(double u, double v)>& height) {
  std::vector<float> values;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      values.push_back(static_cast<float>(height((x + 0.5) / size, (y + 0.5) / size)));
  const HeightField plain({size, size}, values, glm::dvec2(1));
  double sum = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const glm::dvec3 n = plain.normal({x, y});
      sum += (n.x * n.x + n.y * n.y) / (n.z * n.z);
    }
  return {{size, size}, values, glm::dvec2(1), rmsSlope / std::sqrt(sum / (size * size))};
}

/// Returns a sum of waves whose amplitude falls with the square of their frequency, with phases of a fixed
/// pattern.
inline HeightField noise(int size, double rmsSlope = 0.26) {
  return fieldOf(size, rmsSlope, [](double u, double v) {
    double sum = 0;
    for (int i = 0; i <= 6; ++i)
      for (int j = -6; j <= 6; ++j) {
        const int square = i * i + j * j;
        if (square == 0 || square > 36) continue;
        const double phase =
            std::fmod(37.77 * i + 71.13 * j + 5.1 * i * j + 9.7 * j * j, 2 * std::numbers::pi);
        sum += std::cos(2 * std::numbers::pi * (i * u + j * v) + phase) / square;
      }
    return sum;
  });
}

/// Returns bumps and dents in rows, 3 of each along an axis.
inline HeightField eggCrate(int size, double rmsSlope = 0.47) {
  return fieldOf(size, rmsSlope, [](double u, double v) {
    return std::sin(6 * std::numbers::pi * u) * std::sin(6 * std::numbers::pi * v);
  });
}

/// Returns 6 rows of 3 bricks with bevelled edges, every second row moved by half a brick.
inline HeightField bricks(int size, double rmsSlope = 0.76) {
  return fieldOf(size, rmsSlope, [](double u, double v) {
    const double row = std::floor(6 * v), y = 6 * v - row;
    const double along = 3 * u + (static_cast<int>(row) % 2 == 0 ? 0 : 0.5), x = along - std::floor(along);
    const double edge = std::min(std::min(x, 1 - x) / 3, std::min(y, 1 - y) / 6);  // in tiles
    const double part = std::fmin(std::fmax((edge - 0.012) / 0.03, 0), 1);
    return part * part * (3 - 2 * part);
  });
}

/// Returns endless V-shaped grooves along v, whose walls rise by `slope` metres per metre: a crest at texel
/// 0, a bottom at size / 2.
inline HeightField groove(int size, double slope) {
  std::vector<float> values;
  for (int x = 0; x < size; ++x)
    values.push_back(static_cast<float>(std::abs(x - size / 2)) / static_cast<float>(size));
  return {{size, 1}, values, glm::dvec2(1, 1), slope};
}

/// Returns the unit vector above a place of the disc.
inline glm::vec3 over(const glm::vec2& d) {
  return {d, std::sqrt(std::max(1 - glm::dot(d, d), 0.0f))};
}

/// Returns the horizons by exactHorizon(), which is slow.
inline Horizons exactHorizons(const HeightField& field, int azimuths) {
  Horizons result{.azimuths = azimuths, .texels = field.texels(), .tangents = {}};
  for (int i = 0; i < azimuths; ++i)
    for (int y = 0; y < field.size().y; ++y)
      for (int x = 0; x < field.size().x; ++x)
        result.tangents.push_back(static_cast<float>(exactHorizon(field, {x, y}, result.angle(i))));
  return result;
}

/// Says whether a place on the field sees the direction, exactly.
inline bool sees(const HeightField& field, const glm::dvec2& place, const glm::vec3& l) {
  const double azimuth = std::atan2(static_cast<double>(l.y), static_cast<double>(l.x));
  return glsl::horizon_lit(l, static_cast<float>(exactHorizon(field, place, azimuth)));
}

struct NamedField {
  std::string name;
  HeightField field;
};

}  // namespace limn::relief::test
