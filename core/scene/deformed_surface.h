// Declares the vertices of a primitive that a skin or morph targets move, as the CPU follows them.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::scene {

/// Holds the vertices of one primitive in one state of its skin and morph targets, before its matrix.
class LIMN_API DeformedSurface {
 public:
  /// Computes the vertices for a state, unless it is that of the last call. The primitive is the same in all
  /// calls.
  void move(const Primitive& primitive, const Deformation& state);

  const std::vector<glm::vec3>& positions() const { return positions_; }
  const std::vector<glm::vec3>& normals() const { return normals_; }
  /// Returns the area of all triangles.
  double area() const { return area_; }

 private:
  Deformation state_;
  std::vector<glm::vec3> positions_, normals_;
  std::vector<glm::vec4> tangents_;  ///< nobody looks at them; deform() makes them
  double area_ = 0;
};

}  // namespace limn::scene
