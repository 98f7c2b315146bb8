// Declares what height maps are bumps of: the scene with its surfaces moved by them.
#pragma once

#include <cstddef>

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::scene {

/// Limits the triangles that displaced() makes, by default.
inline constexpr std::size_t kMostDisplacedTriangles = std::size_t{8} << 20;

/// Returns the scene with meshes in place of its height maps. Surfaces with a map are cut along the lines
/// through the centres of its texels, tile by tile, and every vertex moves along its interpolated normal by
/// the height there, in metres of the object's space; shading normals stay those of the bumps. What bump
/// mapping leaves out is the difference: parallax, silhouettes, curvature, and shadows on what lies beside.
/// Between four texels the surface is two triangles where the field is bilinear. Surfaces without texture
/// coordinates, on which a map has no effect, stay. Throws UsageError where a surface with a map deforms, and
/// where more than `mostTriangles` would be made.
LIMN_API Scene displaced(Scene scene, std::size_t mostTriangles = kMostDisplacedTriangles);

}  // namespace limn::scene
