// Declares handles in the picture by which an object is moved and turned with the mouse. The code needs no
// window and no OpenGL.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "core/scene/camera.h"
#include "core/session/light_edits.h"

namespace limn::app {

/// Maps between the world and the pixels of the window, for a picture of `size` pixels whose upper left
/// corner is `corner`.
struct ScreenCamera {
  scene::CameraPose camera;
  glm::vec2 corner{0}, size{1};
  float handleScale = 1;  ///< of handles, which have more pixels where text has

  /// Returns the pixel of a point; nothing for points behind the camera.
  std::optional<glm::vec2> pixel(const glm::vec3& world) const;
  glm::vec3 eye() const;
  /// Returns the unit direction of what `pixel` shows.
  glm::vec3 direction(const glm::vec2& pixel) const;
  /// Returns the metres that `pixels` cover at a point.
  float metres(float pixels, const glm::vec3& world) const;
};

enum class GizmoMode { move, turn };

/// Declares what can be dragged: along the axis, in the plane across it, or around it. Axes are the world's.
struct GizmoHandle {
  enum class Kind { axis, plane, ring } kind = Kind::axis;
  int axis = 0;  ///< 0: x, 1: y, 2: z
  bool operator==(const GizmoHandle&) const = default;
};

struct GizmoPose {
  glm::vec3 position{0};
  glm::mat3 rotation{1};
};

/// Returns the handles of a mode.
std::vector<GizmoHandle> handlesOf(GizmoMode mode);
/// Returns the line (axis), the corners (plane) or the closed line (ring) of a handle, in world space.
std::vector<glm::vec3> outlineOf(const ScreenCamera& screen, const glm::vec3& centre,
                                 const GizmoHandle& handle);
/// Returns the handle under the mouse, if there is one.
std::optional<GizmoHandle> handleAt(const ScreenCamera& screen, const glm::vec3& centre, GizmoMode mode,
                                    const glm::vec2& mouse);

/// Holds the state of a handle that is being dragged.
struct GizmoDrag {
  GizmoHandle handle;
  GizmoPose start;
  glm::vec2 mouse{0};  ///< at the start, pixels
};
/// Returns the pose of the object when the mouse is at `mouse`; the pose at the start where that is undefined
/// (the plane or axis is seen edge-on).
GizmoPose dragged(const ScreenCamera& screen, const GizmoDrag& drag, const glm::vec2& mouse);

/// Returns the edit of a light that a handle has brought to `pose`, in a scene of that origin and radius.
/// What the handle changes gets the digits that a hand can aim at. The rest of its place is set as well, so
/// that animations leave the light there: as `edit` has it, else to the last digit as it is `now`. What `now`
/// lacks is left alone: lights without a place or a direction.
session::LightEdit placedBy(const GizmoHandle& handle, const GizmoPose& pose, const session::LightEdit& now,
                            session::LightEdit edit, const glm::dvec3& origin, float radius);

/// Returns the least side of a light, metres, that a hand may give it in a scene of that radius: a
/// ten-thousandth of the radius, but no more than a tenth of a millimetre and no less than --set-light
/// accepts.
float leastSide(float radius);

}  // namespace limn::app
