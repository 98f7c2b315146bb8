// Declares the environment as a light: lookup and importance sampling.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::scene {

/// Returns whether no light comes from the environment: there is no map, its scale is 0 or all of it is
/// black.
LIMN_API bool isBlack(const Environment& environment);

/// Samples an environment by tables of its pixels, which must not change. Its rotation and scale are those of
/// the time of asking.
class LIMN_API EnvironmentLight {
 public:
  /// Takes the environment, which must outlive the light.
  explicit EnvironmentLight(const Environment& environment);

  /// Returns whether any light comes from it.
  bool present() const { return total_ > 0 && environment_.scale != 0; }

  /// Returns the radiance from a world direction (unit), W/(sr m^2): bilinear between pixel centres, wrapping
  /// around; 0 when there is no map.
  glm::vec3 radiance(const glm::vec3& direction) const;

  /// Returns a world direction with density pdf() per steradian, from u in [0, 1)^2. Requires present().
  ///
  /// The density over the map is the bilinear interpolation of luminance times the sine of the row's polar
  /// angle, which is a sum of tent functions: a pixel is chosen by its weight, then a point under its tent.
  glm::vec3 sample(glm::vec2 u) const;
  float pdf(const glm::vec3& direction) const;

  /// Holds what comes from a direction, and how densely sample() chooses it.
  struct Sight {
    glm::vec3 radiance;  ///< W/(sr m^2)
    float pdf;           ///< 1/sr
  };
  /// Returns radiance() and pdf() of one direction, which share its place on the map. Requires present().
  Sight at(const glm::vec3& direction) const;

 private:
  double weight(int x, int y) const;
  glm::vec3 radianceAt(const glm::vec2& uv) const;
  float pdfAt(const glm::vec2& uv, const glm::vec3& lookup) const;

  const Environment& environment_;
  std::vector<float> rows_;     ///< cumulative weight of rows, height + 1, from 0 to 1
  std::vector<float> columns_;  ///< the same per row, (width + 1) * height
  std::vector<float> sines_;    ///< sines of the polar angle at row centres
  double total_ = 0;            ///< weight of all pixels
};

}  // namespace limn::scene
