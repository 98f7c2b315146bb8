#include "apps/view/orbit.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace limn::app {
namespace {

constexpr float kSteepest = 1.5f;  // radians: straight up has no upright picture
/// Of the scene's radius. A hand moves the camera by parts of the distance: one that looks away from the
/// middle of the room that it stands in would hardly move.
constexpr float kNearest = 0.1f;

}  // namespace

Orbit::Orbit(const scene::CameraPose& camera, const scene::Bounds& bounds) : near_(camera.near) {
  const glm::mat4 toWorld = glm::inverse(camera.worldToView);
  const glm::vec3 from(toWorld[3]), forward = -glm::vec3(toWorld[2]);
  distance_ = std::max({glm::dot(bounds.centre() - from, forward), kNearest * bounds.radius(), 2 * near_});
  farthest_ = std::max(farthest_, 10 * distance_);
  target_ = from + distance_ * forward;
  azimuth_ = std::atan2(-forward.x, -forward.z);
  elevation_ = std::clamp(std::asin(std::clamp(-forward.y, -1.f, 1.f)), -kSteepest, kSteepest);
}

glm::vec3 Orbit::back() const {
  return {std::cos(elevation_) * std::sin(azimuth_), std::sin(elevation_),
          std::cos(elevation_) * std::cos(azimuth_)};
}

glm::vec3 Orbit::right() const {
  return {std::cos(azimuth_), 0, -std::sin(azimuth_)};
}

void Orbit::turn(float right, float up) {
  azimuth_ -= right;
  elevation_ = std::clamp(elevation_ + up, -kSteepest, kSteepest);
}

void Orbit::approach(float factor) {
  distance_ = std::clamp(distance_ * factor, 2 * near_, farthest_);
}

void Orbit::pan(float rightwards, float up) {
  target_ += distance_ * (rightwards * right() + up * glm::cross(back(), right()));
}

void Orbit::fly(float rightwards, float up, float forward) {
  target_ += distance_ * (rightwards * right() + glm::vec3(0, up, 0) - forward * back());
}

void Orbit::recount(const glm::dvec3& from, const glm::dvec3& to) {
  target_ = glm::vec3(glm::dvec3(target_) + (from - to));
}

void Orbit::look(float rightwards, float up) {
  const glm::vec3 from = eye();
  turn(rightwards, -up);
  target_ = from - distance_ * back();
}

}  // namespace limn::app
