// Handles in the picture by which a thing is moved and turned with the mouse. No window, no OpenGL.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "core/scene/camera.h"

namespace limn::app {

/// Between the world and the pixels of the window, for a picture of `size` pixels whose upper left corner is
/// `corner`.
struct ScreenCamera {
  scene::CameraPose camera;
  glm::vec2 corner{0}, size{1};

  /// Nothing for points behind the camera.
  std::optional<glm::vec2> pixel(const glm::vec3& world) const;
  glm::vec3 eye() const;
  /// Unit direction of what `pixel` shows.
  glm::vec3 direction(const glm::vec2& pixel) const;
  /// Metres that `pixels` cover at a point.
  float metres(float pixels, const glm::vec3& world) const;
};

enum class GizmoMode { move, turn };

/// What can be taken hold of: along the axis, in the plane across it, or around it. Axes are the world's.
struct GizmoHandle {
  enum class Kind { axis, plane, ring } kind = Kind::axis;
  int axis = 0;  ///< 0: x, 1: y, 2: z
  bool operator==(const GizmoHandle&) const = default;
};

struct GizmoPose {
  glm::vec3 position{0};
  glm::mat3 rotation{1};
};

/// The handles of a mode.
std::vector<GizmoHandle> handlesOf(GizmoMode mode);
/// The line (axis), the corners (plane) or the closed line (ring) of a handle, in the world.
std::vector<glm::vec3> outlineOf(const ScreenCamera& screen, const glm::vec3& centre,
                                 const GizmoHandle& handle);
/// The handle under the mouse.
std::optional<GizmoHandle> handleAt(const ScreenCamera& screen, const glm::vec3& centre, GizmoMode mode,
                                    const glm::vec2& mouse);

/// A handle taken hold of.
struct GizmoDrag {
  GizmoHandle handle;
  GizmoPose start;
  glm::vec2 mouse{0};  ///< where
};
/// Where the thing is when the mouse is at `mouse`; where it started, as long as that cannot be said (the
/// plane or axis is seen edge on).
GizmoPose dragged(const ScreenCamera& screen, const GizmoDrag& drag, const glm::vec2& mouse);

}  // namespace limn::app
