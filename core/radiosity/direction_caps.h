// Declares coarse bounds of light by directions, for surfaces whose normals differ too much for one tree.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "core/base/export.h"
#include "core/radiosity/directional_tree.h"
#include "glsl/numeric/geometry.glsl"

namespace limn::radiosity {

/// Bounds light by the most that is sent into each of 32 caps that together cover all directions. Directions
/// are in a space that all trees share.
class LIMN_API DirectionCaps {
 public:
  static constexpr size_t kCount = 32;

  void clear() { most_.fill(0); }
  /// Raises the bounds to what a tree in a frame has, of the largest channel.
  void include(const DirectionalTree& tree, const glsl::Frame& frame);
  /// Raises the bounds to others.
  void include(const DirectionCaps& other);
  /// Returns the most that is sent into directions less than an angle from `axis` (unit), by that angle's
  /// cosine, and into no more than the caps that these lie in.
  float most(const glm::vec3& axis, float cosine) const;

 private:
  std::array<float, kCount> most_{};
};

}  // namespace limn::radiosity
