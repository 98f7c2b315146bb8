// Internal to directional trees: the corners of all cells of a level, for the uniform basis.
#pragma once

#include <vector>

#include "core/radiosity/directional_tree.h"

namespace limn::radiosity {

struct CornerLevel {
  std::vector<glm::vec3> directions;  ///< unit
  std::vector<float> weights;         ///< about the integral of the corner's hat function by projected angle
  float edgeCosine = 1;               ///< of the longest edge
};

/// Returns the corners of a level, made when they are asked for first. Any thread may ask.
const CornerLevel& cornerLevel(int level);

}  // namespace limn::radiosity
