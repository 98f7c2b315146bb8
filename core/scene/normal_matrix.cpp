#include "core/scene/normal_matrix.h"

#include <algorithm>

namespace limn::scene {

bool mirrors(const glm::mat4& matrix) {
  return glm::determinant(glm::dmat3(glm::dmat4(matrix))) < 0;
}

glm::mat3 normalMatrix(const glm::mat4& matrix) {
  // Products of 32-bit floats are exact here, so that what is parallel has cofactors of 0.
  const glm::dmat3 m{glm::dmat4(matrix)};
  constexpr double least = 1e-150;  // its square is no 0; axes are longer than that, or of length 0
  const double scale = std::max({glm::length(m[0]), glm::length(m[1]), glm::length(m[2]), least});
  const double side = (mirrors(matrix) ? -1 : 1) / (scale * scale);
  return glm::mat3(glm::dmat3(side * glm::cross(m[1], m[2]), side * glm::cross(m[2], m[0]),
                              side * glm::cross(m[0], m[1])));
}

}  // namespace limn::scene
