// Declares the camera of scenes that have none.
#pragma once

#include <glm/vec3.hpp>

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::scene {

/// Holds the direction from which scenes without a camera are seen: the front, slightly from above.
inline constexpr glm::vec3 kSeenFrom{0.3f, 0.35f, 1.f};

/// Collects points, and finds the nearest camera of one direction that sees all of them.
class LIMN_API Framing {
 public:
  /// Prepares a camera that looks along -`back` with world +Y up; `yfov` is in radians.
  explicit Framing(const glm::vec3& back = kSeenFrom, float yfov = 0.8f);

  void add(const glm::vec3& point);
  void add(const Bounds& bounds);
  /// Returns the camera from which the points fill the middle 80 % of a square picture, in its width, its
  /// height or both. Without points it looks at the origin.
  CameraPose camera() const;

 private:
  glm::dmat3 toView_;
  double tangent_ = 0;  ///< of half the angle that the points fill
  float yfov_ = 0;
  Bounds view_;              ///< of the points, in the camera's directions
  glm::dvec2 right_, left_;  ///< most of x and y, and of -x and -y, each plus tangent_ * z
};

/// Returns the camera that sees all vertices of the scene at several times of the animation.
LIMN_API CameraPose frameScene(const Scene& scene, int animation = kNone);

/// Returns the bounds of all vertices at `pose`, which Pose::bounds encloses.
LIMN_API Bounds vertexBounds(const Scene& scene, const Pose& pose);

}  // namespace limn::scene
