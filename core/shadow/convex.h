// Declares convex polyhedra and how planes cut them. No OpenGL.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::shadow {

/// Returns the corners of a box. Bits 0, 1 and 2 of the index select high x, y and z.
LIMN_API std::array<glm::vec3, 8> boxCorners(const scene::Bounds& box);

/// Holds a convex polyhedron as its faces, flat and empty ones included. Memory is reused when it is filled
/// again.
class LIMN_API Convex {
 public:
  /// Sets the polyhedron to a box in any orientation, given by its corners in the order of boxCorners().
  void setBox(const std::array<glm::vec3, 8>& corners);
  /// Keeps only the part where dot(plane, (p, 1)) >= 0.
  void clip(const glm::vec4& plane);
  /// Returns every corner once for each face that has it.
  const std::vector<glm::vec3>& corners() const { return corners_; }
  bool empty() const { return corners_.empty(); }
  /// Sets the polyhedron to `from` in other coordinates: `map` is applied to every corner and must keep
  /// planes planar.
  template <class Map>
  void assign(const Convex& from, const Map& map) {
    ends_ = from.ends_;
    corners_.resize(from.corners_.size());
    for (size_t i = 0; i < corners_.size(); ++i) corners_[i] = map(from.corners_[i]);
  }

 private:
  void closeCut(const glm::vec3& normal);

  std::vector<glm::vec3> corners_;  ///< face after face
  std::vector<size_t> ends_;        ///< where the corners of each face end
  std::vector<glm::vec3> cutCorners_, nextCorners_;
  std::vector<size_t> nextEnds_;
};

}  // namespace limn::shadow
