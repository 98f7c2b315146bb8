// Declares the BRDF of a surface of V-shaped grooves with two colours, simulated: the anisotropic material
// whose colour changes with the direction that it is seen from.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"
#include "core/brdf/tabulated.h"

namespace limn::brdf {

/// Grooves side by side along y, each of two plane Lambertian walls that meet at its bottom.
struct Groove {
  float slope = 0.785398163f;           ///< angle of the walls against the surface, radians, (0, pi/2)
  glm::vec3 rising{0.1f, 0.15f, 0.8f};  ///< albedo, 0 to 1, of the wall that faces -x: it rises towards +x
  glm::vec3 falling{0.8f, 0.1f, 0.1f};  ///< of the wall that faces +x
  int strips = 48;                      ///< that each wall is cut into, of one radiosity each
};

/// The BRDF of grooves much smaller than a pixel, in the limit of infinitely many: light that arrives between
/// the crests, all of its bounces, and what of it leaves between the crests.
class LIMN_API GrooveBrdf {
 public:
  explicit GrooveBrdf(const Groove& groove);

  /// Returns f(l, v), 1/sr, computed in double precision; 0 where a direction lies on or below the horizon.
  /// It is reciprocal to rounding.
  glm::dvec3 evaluate(const glm::dvec3& l, const glm::dvec3& v) const;

  /// Returns the table of it.
  AnisotropicTable table(int size) const;

 private:
  /// Is what of the light that a unit of surface receives from a direction falls on a wall.
  struct Wall {
    double amount = 0;      ///< on a strip that lies wholly between the crests as seen along the direction
    std::size_t strip = 0;  ///< the lowest one that lies there in part
    double hidden = 0;      ///< the part of it that does not
  };
  using Walls = std::array<Wall, 2>;  ///< rising, falling

  /// Returns it for a unit vector towards the light. A strip's amount is its length times the cosine of d
  /// there over d.z.
  Walls exposure(const glm::dvec3& d) const;
  /// Returns f, given the exposures to both directions.
  glm::dvec3 reflected(const Walls& light, const Walls& view) const;
  /// Adds up a channel's radiance of each strip by light on each, in rows of the strips of both walls.
  void addSums(const std::vector<double>& transport, int channel);
  /// Returns where the sums of a pair of walls hold that of the strips from `i` on, the first wall's, and
  /// from `j` on.
  std::size_t index(std::size_t pair, std::size_t i, std::size_t j) const {
    return (pair * (strips_ + 1) + i) * (strips_ + 1) + j;
  }

  double tangent_ = 1, cosine_ = 1, sine_ = 0;  ///< of the slope
  std::size_t strips_ = 0;                      ///< of one wall
  /// Holds sums over strips of the radiance of one by light on another, all bounces included, the same for
  /// both ways: of pairs of rising and rising, rising and falling, and falling and falling walls.
  std::vector<glm::dvec3> sums_;
};

}  // namespace limn::brdf
