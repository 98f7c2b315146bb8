// Declares a camera that a person moves: around a point, towards it, or freely.
#pragma once

#include <glm/vec3.hpp>

#include "core/scene/camera.h"

namespace limn::app {

/// Holds an upright camera on a sphere around the point that it looks at.
class Orbit {
 public:
  Orbit() = default;
  /// Makes the orbit look where `camera` does; the point lies at the depth of the middle of `bounds`, but no
  /// nearer than a tenth of their radius.
  Orbit(const scene::CameraPose& camera, const scene::Bounds& bounds);

  /// Turns the camera around the point, radians.
  void turn(float right, float up);
  /// Multiplies the distance by a factor, within bounds.
  void approach(float factor);
  /// Moves the point and the camera together, in fractions of the distance.
  void pan(float right, float up);
  void fly(float right, float up, float forward);
  /// Turns the view around the camera instead of the point, radians.
  void look(float right, float up);

  /// Counts the point from the origin `to` instead of `from`, both in the world of the file: eye and target
  /// stay where they are in it.
  void recount(const glm::dvec3& from, const glm::dvec3& to);

  glm::vec3 eye() const { return target_ + distance_ * back(); }
  glm::vec3 target() const { return target_; }

 private:
  glm::vec3 back() const;
  glm::vec3 right() const;

  glm::vec3 target_{0};
  float distance_ = 1, azimuth_ = 0, elevation_ = 0, near_ = 0.01f;
  float farthest_ = 1e9f;  ///< that the distance gets, of larger scenes ten times what it was at first
};

}  // namespace limn::app
