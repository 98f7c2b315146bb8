#include "core/rays/private/body_space.h"

#include <cmath>

#include "core/scene/instance_areas.h"

namespace limn::rays {

Extent extentOf(const glm::mat4& objectToWorld) {
  // Shares of the length. Floats round by 6e-8 of it, which the inverse of a body as high as this turns into
  // 0.6 % of its other sides.
  constexpr double kLeastWidth = 1e-7, kLeastHeight = 1e-5;
  const glm::dmat3 m{glm::dmat4(objectToWorld)};
  const double length2 = glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]);
  const double area = glm::length(scene::areaFactors(objectToWorld));
  if (!(area > kLeastWidth * length2)) return Extent::thin;
  const double volume = std::abs(glm::determinant(m));
  return volume > kLeastHeight * area * std::sqrt(length2) ? Extent::solid : Extent::flat;
}

bool invert(const glm::mat4& objectToWorld, glsl::RayBody& body) {
  if (extentOf(objectToWorld) != Extent::solid) return false;
  const glm::dmat4 inverse = glm::inverse(glm::dmat4(objectToWorld));
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row)
      if (!std::isfinite(static_cast<float>(inverse[column][row]))) return false;
  const glm::dmat3 rows = glm::transpose(glm::dmat3(inverse));
  const glm::vec3 shift(inverse[3]);
  body.row_x = rows[0];
  body.row_y = rows[1];
  body.row_z = rows[2];
  body.shift_x = shift.x;
  body.shift_y = shift.y;
  body.shift_z = shift.z;
  return true;
}

}  // namespace limn::rays
