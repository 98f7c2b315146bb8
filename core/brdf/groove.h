// Declares the BRDF of a surface of V-shaped grooves with two colours, simulated: the anisotropic material
// whose colour changes with the direction that it is seen from.
#pragma once

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

  /// Returns the table of it, for which the light of each texel is distributed once.
  AnisotropicTable table(int size) const;

 private:
  /// Each strip's length times the cosine of d there times its share that lies between the crests as seen
  /// along d, over d.z: of the light that a unit of surface receives from d, what falls on the strip.
  std::vector<double> exposure(const glm::dvec3& d) const;
  /// Returns the radiance of each strip, all bounces included, under light of such exposure; seen with the
  /// exposure of the viewer's direction, its sum is f.
  std::vector<glm::dvec3> radiosity(const std::vector<double>& light) const;

  double tangent_ = 1, cosine_ = 1, sine_ = 0;  ///< of the slope
  std::size_t strips_ = 0;                      ///< of one wall; those of the rising wall come first
  std::vector<glm::dvec3> transport_;           ///< radiance of a strip by the light on another, symmetric
};

}  // namespace limn::brdf
