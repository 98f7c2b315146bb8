// A camera that a person moves: around a point, towards it, or freely.
#pragma once

#include <glm/vec3.hpp>

#include "core/scene/camera.h"

namespace limn::app {

/// The camera on a sphere around the point it looks at, upright.
class Orbit {
 public:
  Orbit() = default;
  /// Looks where `camera` does; the point lies in the depth of the middle of `bounds`.
  Orbit(const scene::CameraPose& camera, const scene::Bounds& bounds);

  /// Radians around the point.
  void turn(float right, float up);
  /// Factor on the distance.
  void approach(float factor);
  /// The point and the camera together, in parts of the distance.
  void pan(float right, float up);
  void fly(float right, float up, float forward);
  /// The same, radians around the camera instead of the point.
  void look(float right, float up);

  glm::vec3 eye() const { return target_ + distance_ * back(); }
  glm::vec3 target() const { return target_; }

 private:
  glm::vec3 back() const;
  glm::vec3 right() const;

  glm::vec3 target_{0};
  float distance_ = 1, azimuth_ = 0, elevation_ = 0, near_ = 0.01f;
};

}  // namespace limn::app
