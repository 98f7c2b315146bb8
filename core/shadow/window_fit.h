// The part of a light's map that what a camera sees needs: where its receivers lie, and what stands between
// them and the light. No OpenGL.
#pragma once

#include <glm/glm.hpp>

#include "core/base/export.h"
#include "core/shadow/visible_scene.h"

namespace limn::shadow {

/// Right, up, forward of a map; cross(x, y) = -z, as ShadowView wants it.
struct MapAxes {
  glm::vec3 x, y, z;
};

/// From where a light looks, and how far its points lie from there.
struct MapEye {
  glm::vec3 origin;
  MapAxes axes;
  bool perspective = true;
  /// Half of the light along x, y and z: metres, or, orthographic, metres per metre of depth (z: 0).
  glm::vec3 spread{0};
};

/// A rectangle of a map, in tangents from its axis (perspective) or metres (orthographic), and the depths of
/// what lies in it, metres.
struct MapWindow {
  glm::vec2 low{0}, high{0};
  float near = 0, far = 0;
};

/// The depths and the rectangle that hold all receivers which the camera sees, and every blocker that has a
/// part on a line from such a receiver to the light: as far as the boxes of `scene` tell, never less. What
/// lies in `whole` alone counts. false: no receiver lies in it. `receivers`: the same of the receivers alone.
/// skip: an instance that neither blocks nor receives, or glsl::no_instance.
LIMN_API bool fitWindow(const MapEye& eye, const VisibleScene& scene, uint32_t skip, const MapWindow& whole,
                        MapWindow& window, MapWindow& receivers);

/// The rectangle of a perspective map from another point of the light that holds the same receivers:
/// `offset`, metres along x and y.
LIMN_API MapWindow shiftedWindow(const MapWindow& receivers, const glm::vec2& offset);

/// The square around the window, with room for two texels of `size` at its edges, and a little more so that
/// it and the depths stay what they are while the camera moves little. Where that is no smaller than `whole`,
/// which is a square, it is `whole`.
LIMN_API MapWindow steadyWindow(const MapWindow& window, const MapWindow& whole, int size);

}  // namespace limn::shadow
