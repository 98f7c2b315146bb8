// Bumps of a floor that light each other, with and without a technique that answers for it.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/gpu/bump_floor.h"

namespace limn {

class BumpBouncesTest : public BumpFloorTest {
 protected:
  static constexpr float kAlbedo = 0.7f;
  static inline const std::vector<std::string> kSpaces{"pixel", "texture"};
  using Values = std::vector<std::pair<std::string, std::string>>;

  static scene::Scene bumps(const glm::vec3& towards, relief::HeightField field) {
    scene::Scene scene = floorUnder(towards, {std::move(field)});
    scene.materials[0].baseColour = glm::vec4(kAlbedo, kAlbedo, kAlbedo, 1);
    return scene;
  }

  /// Bumps and dents in rows, 3 of each along an axis, whose RMS slope is 0.94.
  static relief::HeightField eggCrate(double scale = 0.141) {
    constexpr int size = 64;
    std::vector<float> values;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        values.push_back(std::sin(6 * glsl::pi * (static_cast<float>(x) + 0.5f) / size) *
                         std::sin(6 * glsl::pi * (static_cast<float>(y) + 0.5f) / size));
    return {{size, size}, values, glm::dvec2(2), scale};
  }

  static glm::vec3 slantedLight() {
    const float elevation = 35 * glsl::pi / 180;
    return {std::cos(elevation) * std::cos(0.5f), std::sin(elevation), std::cos(elevation) * std::sin(0.5f)};
  }

  Image light(const scene::Scene& scene, const Values& values,
              std::vector<frame::PassReport>* passes = nullptr) {
    return drawn(scene, Term::indirect, {technique("bump_interreflection", values)}, passes);
  }

  /// The sum over the points of the floor.
  static double sumOf(const Image& picture) {
    double sum = 0;
    forEachPoint(picture, [&](float value, const glm::vec3&) { sum += static_cast<double>(value); });
    return sum;
  }
};

}  // namespace limn
