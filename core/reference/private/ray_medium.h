// Declares the medium of a posed scene as rays see it, without approximations.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>

#include "core/scene/density_grid.h"
#include "core/scene/medium.h"

namespace limn::reference {

class RayMedium {
 public:
  RayMedium(const scene::Scene& scene, const scene::Pose& pose) {
    glsl::FrameBlock frame{};
    scene::setMedium(frame, scene.medium, pose.bounds);
    medium_ = scene::mediumOf(frame);
    if (!scene.medium.inhomogeneous()) return;
    grid_ = scene.medium.grid
                ? scene.medium.grid
                : std::make_shared<const scene::DensityGrid>(scene::smokeAt(*scene.medium.smoke, pose.time));
  }

  /// Returns the medium: its ball, and its coefficients at density 1; without extinction if there is no
  /// medium.
  const glsl::Medium& medium() const { return medium_; }

  bool homogeneous() const { return !grid_; }

  /// Returns the density at a place in the ball.
  float density(const glm::vec3& place) const { return grid_ ? scene::densityAt(*grid_, place) : 1.f; }

  /// Returns where there may be medium on the ray: t in [x, y]; x > y where there is none. `direction` is a
  /// unit vector.
  glm::vec2 range(const glm::vec3& origin, const glm::vec3& direction) const {
    const glm::vec2 ball = glsl::ball_range(medium_.ball, origin, direction);
    if (!grid_) return ball;
    const glm::vec2 box = glsl::unit_box_range(glm::vec3(grid_->worldToBox * glm::vec4(origin, 1)),
                                               glm::mat3(grid_->worldToBox) * direction);
    return {std::max(ball.x, box.x), std::min(ball.y, box.y)};
  }

  /// Returns the length of the ray's piece with 0 < t < end, each metre times the density there; exact
  /// (densityLength).
  float length(const glm::vec3& origin, const glm::vec3& direction, float end) const {
    if (!grid_) return glsl::ball_length(medium_.ball, origin, direction, end);
    const glm::vec2 ball = glsl::ball_range(medium_.ball, origin, direction);
    return static_cast<float>(
        scene::densityLength(*grid_, origin, direction, std::max(ball.x, 0.f), std::min(ball.y, end)));
  }
  float lengthBetween(const glm::vec3& a, const glm::vec3& b) const {
    if (!grid_) return glsl::ball_length_between(medium_.ball, a, b);
    const float distance = glm::length(b - a);
    return distance > 0 ? length(a, (b - a) / distance, distance) : 0;
  }

  glm::vec3 transmittance(const glm::vec3& origin, const glm::vec3& direction, float end) const {
    if (clear()) return glm::vec3(1);
    return glsl::medium_transmittance(medium_, length(origin, direction, end));
  }
  glm::vec3 transmittanceToInfinity(const glm::vec3& origin, const glm::vec3& direction) const {
    return transmittance(origin, direction, std::numeric_limits<float>::max());
  }
  glm::vec3 transmittanceBetween(const glm::vec3& a, const glm::vec3& b) const {
    if (clear()) return glm::vec3(1);
    return glsl::medium_transmittance(medium_, lengthBetween(a, b));
  }

 private:
  /// Most scenes have no medium, and every sample of a light asks for what it leaves.
  bool clear() const { return medium_.extinction == glm::vec3(0); }

  glsl::Medium medium_{};
  std::shared_ptr<const scene::DensityGrid> grid_;
};

}  // namespace limn::reference
