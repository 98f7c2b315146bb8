// Convex polyhedra, cut by planes. No OpenGL.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::shadow {

/// Bit 0, 1, 2 of the index is high x, y, z.
LIMN_API std::array<glm::vec3, 8> boxCorners(const scene::Bounds& box);

/// A convex polyhedron as its faces; flat or empty ones included. Memory is kept when it is filled again.
class LIMN_API Convex {
 public:
  /// A box, however turned, from boxCorners() of it.
  void setBox(const std::array<glm::vec3, 8>& corners);
  /// What lies where dot(plane, (p, 1)) >= 0.
  void clip(const glm::vec4& plane);
  /// Every corner once for each face that has it.
  const std::vector<glm::vec3>& corners() const { return corners_; }
  bool empty() const { return corners_.empty(); }
  /// The same in other coordinates: `map` of every corner; it must keep planes plane.
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
