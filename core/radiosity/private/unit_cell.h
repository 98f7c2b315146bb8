// Internal to directional trees: cones of directions, and a cell with its corners' directions, which its
// children share.
#pragma once

#include <algorithm>
#include <cmath>

#include "glsl/numeric/octahedral_cells.glsl"

namespace limn::radiosity {

/// A cone of directions around an axis, by its half angle.
struct Cone {
  float cosine, sine;

  explicit Cone(float cosineOfHalf)
      : cosine(cosineOfHalf), sine(std::sqrt(std::max(1 - cosineOfHalf * cosineOfHalf, 0.f))) {}
  /// Returns the least cosine between the axes of two cones that meet.
  static float meeting(const Cone& a, const Cone& b) {
    if (a.cosine < -b.cosine) return -2;  // together they are more than half a turn
    return a.cosine * b.cosine - a.sine * b.sine;
  }
};

struct UnitCell {
  glsl::OctahedralCell cell;
  glm::vec3 signs;
  glm::vec3 corners[3];

  static UnitCell face(uint32_t face) {
    UnitCell r{glsl::octahedral_root(), glsl::octahedral_signs(face), {}};
    for (uint32_t i = 0; i < 3; ++i) r.corners[i] = glsl::octahedral_corner(r.cell, r.signs, i);
    return r;
  }
  /// Returns the middles of the edges, each opposite to the corner of its number.
  void middles(glm::vec3 (&result)[3]) const {
    const glsl::OctahedralCell inner = glsl::octahedral_child(cell, 3);
    for (uint32_t i = 0; i < 3; ++i) result[i] = glsl::octahedral_corner(inner, signs, i);
  }
  /// Returns a child, given the middles.
  UnitCell child(uint32_t k, const glm::vec3 (&middles)[3]) const {
    UnitCell r{glsl::octahedral_child(cell, k), signs, {}};
    for (uint32_t i = 0; i < 3; ++i)
      r.corners[i] = k == 3 ? middles[i] : i == k ? corners[i] : middles[3 - i - k];
    return r;
  }
  glm::vec3 centre() const { return glsl::octahedral_centre(cell, signs); }
  /// Returns the cosine of the cone around the cell's centre that holds its corners.
  float cornerCosine(const glm::vec3& centre) const {
    float least = 1;
    for (const glm::vec3& corner : corners) least = std::min(least, glm::dot(centre, corner));
    return least;
  }
};

}  // namespace limn::radiosity
