// Declares how an instance's matrix turns the normals of its mesh.
#pragma once

#include <glm/glm.hpp>

#include "core/base/export.h"

namespace limn::scene {

/// Returns whether the matrix turns left into right: its determinant, in double precision, is negative.
LIMN_API bool mirrors(const glm::mat4& matrix);

/// Returns a matrix that takes normals of a mesh to world space, where they point out of what they pointed
/// out of before: the matrix of the cofactors, in units of the longest axis squared. They have the direction
/// of the inverse transpose without its division, so that flat and tiny instances keep their normals.
/// Products have the length 0 where the matrix leaves no direction, and no particular length elsewhere.
LIMN_API glm::mat3 normalMatrix(const glm::mat4& matrix);

}  // namespace limn::scene
