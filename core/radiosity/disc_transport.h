// Declares the exact light transport from a disc.
#pragma once

#include <glm/glm.hpp>

#include "core/base/export.h"

namespace limn::radiosity {

/// Returns the irradiance, per unit of radiance, that a disc gives a point: pi times its form factor, of the
/// part above the horizon of `up`. `offset` leads from the point to the disc's centre, `normal` is the way
/// the disc faces, both in any one unit. The disc counts as a regular polygon of its area (within 0.4 %).
LIMN_API float discIrradiance(const glm::vec3& offset, const glm::vec3& normal, float area,
                              const glm::vec3& up);

}  // namespace limn::radiosity
