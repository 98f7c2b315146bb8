// The light that Lambertian bumps of a height field send each other along traced paths, texel by texel.
#pragma once

#include <cstddef>
#include <numbers>
#include <vector>

#include "core/relief/interreflection.h"

namespace limn::relief::test {

inline double between(const HeightField& field, const std::vector<double>& values, const glm::dvec2& place) {
  const glm::dvec2 corner = glm::floor(place), part = place - corner;
  const glm::ivec2 at(corner);
  const auto value = [&](int x, int y) { return values[field.index(at + glm::ivec2(x, y))]; };
  return glm::mix(glm::mix(value(0, 0), value(1, 0), part.x), glm::mix(value(0, 1), value(1, 1), part.x),
                  part.y);
}

/// Returns what each texel sees along its paths, the mean by weight: `radiance` of texels, bilinear between
/// them, and `sky`.
inline std::vector<double> gather(const HeightField& field, const BouncePaths& paths,
                                  const std::vector<double>& radiance, double sky) {
  std::vector<double> result(field.texels());
  const auto count = static_cast<std::size_t>(paths.paths);
  for (std::size_t texel = 0; texel < result.size(); ++texel) {
    double sum = 0;
    for (std::size_t i = texel * count; i < (texel + 1) * count; ++i) {
      const BouncePath& path = paths.list[i];
      sum += static_cast<double>(path.weight) * (path.hits() ? between(field, radiance, path.place) : sky);
    }
    result[texel] = sum / std::numbers::pi;
  }
  return result;
}

/// Returns the radiance of a Lambertian field after `bounces` bounces, B_k = L0 + albedo gather(B_(k-1)),
/// from B_0 = L0 = `direct`.
inline std::vector<double> bounce(const HeightField& field, const BouncePaths& paths,
                                  const std::vector<double>& direct, double albedo, double sky, int bounces) {
  std::vector<double> result = direct;
  for (int i = 0; i < bounces; ++i) {
    result = gather(field, paths, result, sky);
    for (std::size_t texel = 0; texel < result.size(); ++texel)
      result[texel] = direct[texel] + albedo * result[texel];
  }
  return result;
}

/// Returns the radiance of each texel under a directional light, `irradiance` across its direction l: albedo
/// / pi n.l where a ray towards it leaves the field, 0 elsewhere.
inline std::vector<double> directRadiance(const HeightField& field, const glm::dvec3& l, double albedo,
                                          double irradiance) {
  std::vector<double> result(field.texels());
  for (int y = 0; y < field.size().y; ++y)
    for (int x = 0; x < field.size().x; ++x) {
      const double cosine = glm::dot(field.normal({x, y}), l);
      if (l.z > 0 && cosine > 0 && !traceRay(field, {x, y}, l))
        result[field.index({x, y})] = albedo / std::numbers::pi * cosine * irradiance;
    }
  return result;
}

}  // namespace limn::relief::test
