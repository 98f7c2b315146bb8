// Declares the ellipses that stand for what texels of a height field see: moments of the horizon, their means
// for minification, and the published fit.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/relief/horizon.h"
#include "glsl/relief/ellipse.glsl"

namespace limn::relief {

/// Returns the radius of the lit region of the disc along an azimuth, rho = cos(elevation of the horizon).
inline double litRadius(double tangent) {
  return 1 / std::sqrt(1 + tangent * tangent);
}

/// Returns the moment ellipse of a region that is star-shaped about 0 and has the radii `rho`, 0 to 1, along
/// evenly spread azimuths:
///   A = 1/2 int rho^2 df,  c = 1/(3A) int rho^3 (cos, sin) df,  S = 1/(4A) int rho^4 (cos, sin) (cos, sin)^T
///   df - c c^T.
/// A region of no area is an ellipse of no area. Throws UsageError for less than 3 azimuths.
LIMN_API glsl::ReliefEllipse momentEllipse(std::span<const double> rho);

/// Returns the moment ellipse of each texel.
LIMN_API std::vector<glsl::ReliefEllipse> momentEllipses(const Horizons& horizons);

/// Returns the part of the disc, 0 to 1, where an ellipse and the region of the radii `rho` differ.
LIMN_API double differingArea(const glsl::ReliefEllipse& ellipse, std::span<const double> rho);

/// Returns the ellipse that differs least from the region of the radii `rho`, searched for from `start`, its
/// moment ellipse: centre and covariance go on in steps that shrink to 1/250 of the mean radius. It errs less
/// than the moments, but its area is no longer that of the region.
LIMN_API glsl::ReliefEllipse nearestEllipse(std::span<const double> rho, const glsl::ReliefEllipse& start);

/// Returns the nearest ellipse of each texel.
LIMN_API std::vector<glsl::ReliefEllipse> nearestEllipses(const Horizons& horizons);

/// Takes the mean of ellipses: their areas A, A c and A (S + c c^T) average linearly, with A = 4 pi sqrt(det
/// S). The mean's own area is another one than that of A, since centres that lie apart make it wider.
class LIMN_API EllipseMean {
 public:
  void add(const glsl::ReliefEllipse& ellipse);
  /// Returns the mean, whose spread is the deviation of the centres per axis plus that of the roots of radius
  /// times radius.
  glsl::ReliefEllipse mean() const;

 private:
  double count_ = 0, area_ = 0, size_ = 0, squaredSize_ = 0, squaredCentre_ = 0;
  glm::dvec2 centre_{0}, areaCentre_{0};
  glm::dvec3 second_{0};  // xx, xy, yy
};

/// Returns the published fit to directions in the disc and whether the texel sees them: centre and axes from
/// the covariance of the lit ones, then a local search of the radii for the most lit minus shadowed
/// directions inside. No lit direction: an ellipse of no area. Throws UsageError for spans of different
/// lengths.
LIMN_API glsl::FittedEllipse fitPublished(std::span<const glm::vec2> directions,
                                          std::span<const std::uint8_t> lit);

/// Returns `count` random directions, uniform in the disc: by the cosine of the solid angle. The same for the
/// same seed.
LIMN_API std::vector<glm::vec2> randomDisc(int count, std::uint32_t seed);

}  // namespace limn::relief
