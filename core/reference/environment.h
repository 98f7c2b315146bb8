// The environment as a light: lookup and importance sampling.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::reference {

class LIMN_API EnvironmentLight {
 public:
  explicit EnvironmentLight(const scene::Environment& environment);

  bool present() const { return total_ > 0; }

  /// Radiance from a world direction (unit), W/(sr m^2): bilinear between pixel centres, wrapping around; 0
  /// without map.
  glm::vec3 radiance(const glm::vec3& direction) const;

  /// World direction with density pdf() per steradian, from u in [0, 1)^2. Only if present().
  ///
  /// The density over the map is the bilinear interpolation of luminance times the sine of the row's polar
  /// angle, which is a sum of tents: a pixel is chosen by its weight, then a place under its tent.
  glm::vec3 sample(glm::vec2 u) const;
  float pdf(const glm::vec3& direction) const;

 private:
  double weight(int x, int y) const;

  const scene::Environment& environment_;
  std::vector<float> rows_;     ///< cumulative weight of rows, height + 1, from 0 to 1
  std::vector<float> columns_;  ///< the same per row, (width + 1) * height
  std::vector<float> sines_;    ///< of the polar angle at the rows' centres
  double total_ = 0;            ///< weight of all pixels
};

}  // namespace limn::reference
