// Computes the ground truth at points of surfaces instead of pixels: the reference for methods that light
// vertices.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/reference/reference.h"

namespace limn::reference {

/// Holds a point of a surface in world space; it reflects as if it were there alone, white and Lambertian.
struct SurfacePoint {
  glm::vec3 position{0};
  glm::vec3 normal{0};  ///< unit
};

/// Returns the irradiance of each point, W/m^2, of the request's term (direct, indirect or final without what
/// a camera sees of emission), bounces, light, samples and seed; the request's camera and picture are
/// ignored. Points lie `clearance` metres in front of their surfaces. Progress is reported after each pass
/// over the points; the value false ends the work with Error. Throws UsageError for another term, and for
/// what render() refuses of the light of a request.
LIMN_API std::vector<glm::vec3> irradianceAt(const Request& request, std::span<const SurfacePoint> points,
                                             float clearance);

/// Returns the points of surfaces at which methods that light vertices see them: the surface elements of
/// radiosity::SceneElements with edges no longer than `longestEdge` scene radii. Throws UsageError where they
/// are more than vertexImage() has rows for.
LIMN_API std::vector<SurfacePoint> vertexPoints(const scene::Scene& scene, const scene::Pose& pose,
                                                float longestEdge);

/// Returns an image with rows of 1024 points: R, G, B (irradiance), P.X, P.Y, P.Z, N.X, N.Y, N.Z, and
/// coverage (0 behind the last point). The points are relative to `origin` (Scene::origin), the rows are
/// relative to the file's origin: where the two differ, P.rest.X, P.rest.Y and P.rest.Z hold what 32 bits of
/// P leave of positions in double precision.
LIMN_API Image vertexImage(std::span<const SurfacePoint> points, std::span<const glm::vec3> irradiance,
                           const glm::dvec3& origin);

}  // namespace limn::reference
