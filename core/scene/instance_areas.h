// Declares how much an instance changes the areas of its mesh, for what is spread over surfaces by area.
#pragma once

#include <glm/glm.hpp>

#include "core/base/export.h"

namespace limn::scene {

/// Returns the factors by which a matrix changes the areas of what is perpendicular to each axis.
LIMN_API glm::dvec3 areaFactors(const glm::mat4& matrix);

/// Returns whether no factor is more than half as large again as the other: what is spread by area may stay.
LIMN_API bool areasAlike(const glm::dvec3& a, const glm::dvec3& b);

}  // namespace limn::scene
