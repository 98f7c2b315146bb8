// Declares how far an approximation is from a BRDF: in a picture, and in the light that it reflects.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"
#include "core/brdf/factor_tables.h"

namespace limn::brdf {

/// Says which lights a picture is taken under: those that fits are chosen by, or others of as many
/// elevations, which no fit has looked at.
enum class PictureLights { choosing, heldOut };

/// Is a sphere of one material seen from afar under five directional lights of equal strength, one of them
/// behind it: half vectors from n to the horizon, views and lights up to grazing.
class LIMN_API SpherePicture {
 public:
  /// Evaluates `exact` in a picture of `size` x `size` pixels. The sphere is turned so that its tangents
  /// follow its circles of latitude, which matters to anisotropic materials alone.
  explicit SpherePicture(const Brdf& exact, int size = 128, PictureLights lights = PictureLights::choosing);

  /// Returns the root of the mean square of the error over that of the exact picture, over pixels and
  /// channels; 0 where both are black, infinite where only the exact picture is.
  double errorOf(const Response& approximation) const;

 private:
  struct Pixel {
    glm::dvec3 v;
    std::vector<glm::dvec3> lights;  // above the surface
    glm::dvec3 radiance;
  };
  std::vector<Pixel> pixels_;
  double power_ = 0;  // sum of squares of the exact picture
};

/// Returns the directional albedo of a response per channel, the share of the light from a uniform
/// environment that is reflected to v: the integral of `response`, which has the cosine unlike what
/// albedoOfBrdf() takes, over l, by a rule in the half vector that resolves lobes down to a width of about
/// 0.02.
LIMN_API glm::dvec3 albedoOfResponse(const Response& response, const glm::dvec3& v);

/// Returns the largest directional albedo of any channel, over views from head-on to 88 degrees at eight
/// azimuths around the normal, as no symmetry is taken for granted (one where the response is `isotropic`).
/// Several threads ask the response at once.
LIMN_API double largestAlbedo(const Response& response, bool isotropic);

}  // namespace limn::brdf
