// Ground truth at points of surfaces instead of pixels: what methods that light vertices are compared with.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/reference/reference.h"

namespace limn::reference {

/// A point of a surface, world space; reflects as if it were there alone, white and Lambertian.
struct SurfacePoint {
  glm::vec3 position{0};
  glm::vec3 normal{0};  ///< unit
};

/// Irradiance of each point, W/m^2, of the request's term (direct, indirect or final without what a camera
/// sees of emission), bounces, light, samples and seed; what the request says of camera and picture is not
/// looked at. Points lie `clearance` metres in front of their surfaces. Throws UsageError for the term
/// visibility.
LIMN_API std::vector<glm::vec3> irradianceAt(const Request& request, std::span<const SurfacePoint> points,
                                             float clearance);

/// The points of surfaces at which methods that light vertices see them: the surface elements of
/// radiosity::SceneElements with edges no longer than `longestEdge` scene radii.
LIMN_API std::vector<SurfacePoint> vertexPoints(const scene::Scene& scene, const scene::Pose& pose,
                                                float longestEdge);

/// Rows of 1024 points: R, G, B (irradiance), P.X, P.Y, P.Z, N.X, N.Y, N.Z, and coverage (0 behind the last
/// point).
LIMN_API Image vertexImage(std::span<const SurfacePoint> points, std::span<const glm::vec3> irradiance);

}  // namespace limn::reference
