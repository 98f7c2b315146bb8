// Internal to directional trees: a cell with its corners' directions, which its children share.
#pragma once

#include <algorithm>

#include "glsl/numeric/octahedral_cells.glsl"

namespace limn::radiosity {

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
