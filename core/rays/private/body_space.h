// Declares how an instance lies in the world: what its matrix leaves of it, and the way into its space.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "glsl/rays/ray_node.glsl"

namespace limn::rays {

/// Says what a matrix leaves of a body.
enum class Extent : uint8_t {
  thin,  ///< a line or a point
  flat,
  solid
};

Extent extentOf(const glm::mat4& objectToWorld);

/// Sets the rows of the matrix into the instance's space. Returns false where floats hold none.
bool invert(const glm::mat4& objectToWorld, glsl::RayBody& body);

}  // namespace limn::rays
