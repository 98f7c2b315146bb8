// Declares the exact light transport from a disc.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "core/base/export.h"
#include "glsl/indirect/illumination_sample.glsl"

namespace limn::radiosity {

/// Returns the irradiance, per unit of radiance, that a disc gives a point: pi times its form factor, of the
/// part above the horizon of `up`. `offset` leads from the point to the disc's centre, `normal` is the way
/// the disc faces, both in any one unit. The disc counts as a regular polygon of its area (within 0.4 %).
LIMN_API float discIrradiance(const glm::vec3& offset, const glm::vec3& normal, float area,
                              const glm::vec3& up);

/// Returns the same perpendicular to the direction of a disc as of one point: exact on the disc's axis, and
/// at most pi. `cosine`: at the disc.
inline float axisTransport(float area, float cosine, float distance2) {
  const float shown = area * cosine;
  return shown > 0 ? shown / (distance2 + glsl::inverse_pi * shown) : 0;
}

/// Returns about what angle a sender spans, as glsl::incident_light() has it.
inline float sampleSpread(float area, float distance2) {
  constexpr float most = glsl::incident_max_spread;
  return area >= most * most * distance2 ? most : std::sqrt(area / distance2);
}

}  // namespace limn::radiosity
