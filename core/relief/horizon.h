// Declares how high above the base plane the horizon of a height field's texels lies.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"
#include "core/relief/height_field.h"

namespace limn::relief {

/// Returns the tangent of the elevation of the horizon of a place on the field along an azimuth (radians from
/// T towards B), at least 0: the steepest sight line from it to the bilinear field, exactly. Lines end after
/// 64 sizes of the map.
LIMN_API double exactHorizon(const HeightField& field, const glm::dvec2& place, double azimuth);

/// Holds the horizons of all texels of a field along `azimuths` directions, of which number i is at 2 pi i /
/// azimuths.
struct LIMN_API Horizons {
  int azimuths = 0;
  std::size_t texels = 0;
  std::vector<float> tangents;  ///< of elevations, at least 0; texels run fastest

  float tangent(int azimuth, std::size_t texel) const {
    return tangents[static_cast<std::size_t>(azimuth) * texels + texel];
  }
  double angle(int azimuth) const;
};

/// Returns the horizons by sweeps of parallel lines, one for each row or column of texels, which keep the
/// convex hull of what they have passed on a stack (Timonen and Westerholm 2010, Scalable Height Field
/// Self-Shadowing): a time per azimuth that is proportional to the texels, but for the logarithm of a search
/// in the hull. Texels between two lines get the mean of what they see in both; the two texels next to them
/// are looked at exactly. Lines begin where what they leave out rises by less than 1/64 above any texel, but
/// at most 8 sizes of the map ahead, of the longer side in metres and of the longer axis in texels. Throws
/// UsageError for less than one azimuth.
LIMN_API Horizons sweepHorizons(const HeightField& field, int azimuths);

}  // namespace limn::relief
