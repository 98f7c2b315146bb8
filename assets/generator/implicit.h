// Solids as signed distances (negative inside, metres) and their closed triangle meshes.
#pragma once

#include "assets/generator/mesh.h"

namespace limn::assets {

using Distance = std::function<float(glm::vec3)>;

/// The place on the side z >= 0 that stands for `p` where both sides of a solid are alike.
glm::vec3 mirrored(glm::vec3 p);
/// Distance to the cone with spherical ends `a` (radius ra) and `b` (radius rb); exact where the radii are
/// equal.
float roundCone(glm::vec3 p, glm::vec3 a, glm::vec3 b, float ra, float rb);
/// Close to the distance to an ellipsoid (first-order).
float ellipsoid(glm::vec3 p, glm::vec3 centre, glm::vec3 radii);
/// Union that fills the crease over a width of `blend` (polynomial smooth minimum).
float smoothUnion(float a, float b, float blend);
/// `a` without `b`, the edge rounded over `blend`.
float smoothCut(float a, float b, float blend);
/// Distance to a polyline tube with interpolated radii.
float polylineTube(glm::vec3 p, std::span<const glm::vec3> path, std::span<const float> radii);

/// The surface of {distance < 0} inside the box, by marching tetrahedra on a grid of `cell` metres: closed
/// (every edge belongs to exactly two triangles, in opposite directions) as long as the solid stays inside
/// the box. Vertices are evened out and put back onto the surface; normals are the field's gradient. The
/// field must not change faster than twice the distance.
Mesh polygonise(const Distance& distance, glm::vec3 low, glm::vec3 high, float cell);

}  // namespace limn::assets
