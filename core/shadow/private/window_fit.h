// Declares how the part of a light's map that the camera needs is found: where the receivers lie that it
// sees, and what lies between them and the light. No OpenGL.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/shadow/visible_scene.h"

namespace limn::shadow {

/// Holds the right, up and forward axes of a map; cross(x, y) = -z, as ShadowView requires.
struct MapAxes {
  glm::vec3 x, y, z;
};

/// Holds the point from which a light looks, and how far the light's points lie from it.
struct MapEye {
  glm::vec3 origin;
  MapAxes axes;
  bool perspective = true;
  /// Holds half of the light's extent along x, y and z: metres, or, orthographic, metres per metre of depth
  /// (z: 0).
  glm::vec3 spread{0};
};

/// Holds a rectangle of a map, in tangents from its axis (perspective) or metres (orthographic), and the
/// range of depths in it, metres.
struct MapWindow {
  glm::vec2 low{0}, high{0};
  float near = 0, far = 0;
};

/// Finds the rectangle and the depths that hold all receivers that the camera sees, and every blocker with a
/// part on a line from such a receiver to the light. The result is conservative: it relies on the boxes of
/// `scene` and never misses any. Only what lies in `whole` counts. `receivers` becomes points, relative to
/// the origin in the map's axes, in whose convex hulls all the receivers lie. `skip` is an instance that
/// neither blocks nor receives, or glsl::no_instance. Returns false when no receiver lies in `whole`.
LIMN_API bool fitWindow(const MapEye& eye, const VisibleScene& scene, uint32_t skip, const MapWindow& whole,
                        MapWindow& window, std::vector<glm::vec3>& receivers);

/// Returns the rectangle that holds the receivers in a perspective map from another point of the light, and
/// their depths. `offset` is that point's offset, metres along x and y.
LIMN_API MapWindow shiftedWindow(std::span<const glm::vec3> receivers, const glm::vec2& offset);

/// Holds, for each face of a cube or half cube, points in its axes, relative to the origin, in whose convex
/// hulls its receivers lie.
using FaceReceivers = std::array<std::vector<glm::vec3>, 6>;

/// Finds the receivers that the camera sees in each of the first `faces` faces of shadow_face() about any
/// point of the light at most `reach` from `origin` along each of the axes. Of half cubes (faces: 5) only
/// what lies before the light counts. Depths are up to that of `whole`.
LIMN_API void findFaceReceivers(const glm::vec3& origin, const MapAxes& axes, const VisibleScene& scene,
                                uint32_t skip, uint32_t faces, const glm::vec3& reach, const MapWindow& whole,
                                FaceReceivers& receivers);

/// Returns the rectangle that holds the receivers of one face seen from another point of the light, and their
/// depths; low > high where it holds none. `offset` is that point's, in the face's axes.
LIMN_API MapWindow shiftedFaceWindow(std::span<const glm::vec3> receivers, const glm::vec3& offset,
                                     const MapWindow& whole);

/// Returns the square around the window with a margin at its edges of two texels of a map of `size` texels
/// per side, and a little more, so that square and depths stay the same while the camera moves little.
/// Returns `whole`, which is a square, when the result would be no smaller.
LIMN_API MapWindow steadyWindow(const MapWindow& window, const MapWindow& whole, int size);

}  // namespace limn::shadow
