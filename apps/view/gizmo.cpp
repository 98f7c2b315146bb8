#include "apps/view/gizmo.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace limn::app {
namespace {

constexpr float kArmPixels = 90;  // of an axis; before ScreenCamera::handleScale, as all pixels
constexpr float kPlaneFrom = 0.3f, kPlaneTo = 0.55f;  // parts of it
constexpr float kGrabPixels = 7;
constexpr int kRingCorners = 48;
constexpr float kEdgeOn = 0.05f;  // sine of the angle below which a plane has no depth

glm::vec3 unit(int axis) {
  glm::vec3 v(0);
  v[axis] = 1;
  return v;
}

float distanceToSegment(glm::vec2 p, glm::vec2 a, glm::vec2 b) {
  const glm::vec2 along = b - a;
  const float length = glm::dot(along, along);
  const float t = length > 0 ? std::clamp(glm::dot(p - a, along) / length, 0.f, 1.f) : 0.f;
  return glm::distance(p, a + t * along);
}

bool inside(const std::vector<glm::vec2>& corners, glm::vec2 p) {
  bool in = false;
  for (size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const glm::vec2 a = corners[i], b = corners[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) in = !in;
  }
  return in;
}

/// Where the mouse's ray meets the plane through `point` across `normal`.
std::optional<glm::vec3> onPlane(const ScreenCamera& screen, glm::vec2 mouse, const glm::vec3& point,
                                 const glm::vec3& normal) {
  const glm::vec3 eye = screen.eye(), direction = screen.direction(mouse);
  const float cosine = glm::dot(direction, normal);
  if (std::abs(cosine) < kEdgeOn) return std::nullopt;
  const float t = glm::dot(point - eye, normal) / cosine;
  if (!(t > 0)) return std::nullopt;
  return eye + t * direction;
}

/// To four digits of the scene's size.
glm::vec3 rounded(const glm::vec3& position, float radius) {
  const float perMetre = std::pow(10.f, 3 - std::floor(std::log10(std::max(radius, 1e-6f))));
  return glm::round(position * perMetre) / perMetre;
}

/// Parameter of the point on the axis through `point` that is nearest to the mouse's ray.
std::optional<float> onAxis(const ScreenCamera& screen, glm::vec2 mouse, const glm::vec3& point,
                            const glm::vec3& axis) {
  const glm::vec3 direction = screen.direction(mouse), away = point - screen.eye();
  const float b = glm::dot(axis, direction), span = 1 - b * b;
  if (span < kEdgeOn * kEdgeOn) return std::nullopt;
  return (b * glm::dot(direction, away) - glm::dot(axis, away)) / span;
}

}  // namespace

std::optional<glm::vec2> ScreenCamera::pixel(const glm::vec3& world) const {
  const glm::vec3 v(camera.worldToView * glm::vec4(world, 1));
  if (!(-v.z > camera.near)) return std::nullopt;
  const float scale = 0.5f * size.y / std::tan(0.5f * camera.yfov) / -v.z;
  return corner + 0.5f * size + scale * glm::vec2(v.x, -v.y);
}

glm::vec3 ScreenCamera::eye() const {
  return glm::vec3(glm::inverse(camera.worldToView)[3]);
}

glm::vec3 ScreenCamera::direction(const glm::vec2& pixel) const {
  const glm::vec2 part = (pixel - corner - 0.5f * size) / (0.5f * size.y) * std::tan(0.5f * camera.yfov);
  return glm::normalize(glm::transpose(glm::mat3(camera.worldToView)) * glm::vec3(part.x, -part.y, -1));
}

float ScreenCamera::metres(float pixels, const glm::vec3& world) const {
  const float depth = -(camera.worldToView * glm::vec4(world, 1)).z;
  return std::max(depth, camera.near) * pixels * std::tan(0.5f * camera.yfov) / (0.5f * size.y);
}

std::vector<GizmoHandle> handlesOf(GizmoMode mode) {
  using Kind = GizmoHandle::Kind;
  std::vector<GizmoHandle> handles;
  for (int axis = 0; axis < 3; ++axis) {
    if (mode == GizmoMode::turn) {
      handles.push_back({Kind::ring, axis});
      continue;
    }
    handles.push_back({Kind::plane, axis});
    handles.push_back({Kind::axis, axis});
  }
  return handles;
}

std::vector<glm::vec3> outlineOf(const ScreenCamera& screen, const glm::vec3& centre,
                                 const GizmoHandle& handle) {
  const float arm = screen.metres(kArmPixels * screen.handleScale, centre);
  const glm::vec3 u = arm * unit((handle.axis + 1) % 3), v = arm * unit((handle.axis + 2) % 3);
  switch (handle.kind) {
    case GizmoHandle::Kind::axis:
      return {centre, centre + arm * unit(handle.axis)};
    case GizmoHandle::Kind::plane:
      return {centre + kPlaneFrom * (u + v), centre + kPlaneTo * u + kPlaneFrom * v,
              centre + kPlaneTo * (u + v), centre + kPlaneFrom * u + kPlaneTo * v};
    case GizmoHandle::Kind::ring:
      break;
  }
  std::vector<glm::vec3> ring;
  for (int i = 0; i < kRingCorners; ++i) {
    const float angle = 2 * glsl::pi * static_cast<float>(i) / kRingCorners;
    ring.push_back(centre + 0.8f * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return ring;
}

std::optional<GizmoHandle> handleAt(const ScreenCamera& screen, const glm::vec3& centre, GizmoMode mode,
                                    const glm::vec2& mouse) {
  std::optional<GizmoHandle> found;
  float nearest = kGrabPixels * screen.handleScale;
  for (const GizmoHandle& handle : handlesOf(mode)) {
    std::vector<glm::vec2> pixels;
    for (const glm::vec3& corner : outlineOf(screen, centre, handle))
      if (const auto pixel = screen.pixel(corner)) pixels.push_back(*pixel);
    if (pixels.size() < 2) continue;
    float distance = std::numeric_limits<float>::max();
    if (handle.kind == GizmoHandle::Kind::plane) {
      if (inside(pixels, mouse)) distance = 0;
    } else {
      const size_t closing = handle.kind == GizmoHandle::Kind::ring ? 1 : 0;
      for (size_t i = 0; i + 1 < pixels.size() + closing; ++i)
        distance = std::min(distance, distanceToSegment(mouse, pixels[i], pixels[(i + 1) % pixels.size()]));
    }
    if (distance >= nearest) continue;
    nearest = distance;
    found = handle;
  }
  return found;
}

GizmoPose dragged(const ScreenCamera& screen, const GizmoDrag& drag, const glm::vec2& mouse) {
  GizmoPose pose = drag.start;
  const glm::vec3 centre = drag.start.position, axis = unit(drag.handle.axis);
  if (drag.handle.kind == GizmoHandle::Kind::axis) {
    const auto from = onAxis(screen, drag.mouse, centre, axis), to = onAxis(screen, mouse, centre, axis);
    if (from && to) pose.position += (*to - *from) * axis;
    return pose;
  }
  const auto from = onPlane(screen, drag.mouse, centre, axis), to = onPlane(screen, mouse, centre, axis);
  if (!from || !to) return pose;
  if (drag.handle.kind == GizmoHandle::Kind::plane) {
    pose.position += *to - *from;
    return pose;
  }
  const auto angle = [&](const glm::vec3& p) {
    return std::atan2(p[(drag.handle.axis + 2) % 3] - centre[(drag.handle.axis + 2) % 3],
                      p[(drag.handle.axis + 1) % 3] - centre[(drag.handle.axis + 1) % 3]);
  };
  pose.rotation = glm::mat3(glm::rotate(glm::mat4(1), angle(*to) - angle(*from), axis)) * drag.start.rotation;
  return pose;
}

session::LightEdit placedBy(const GizmoHandle& handle, const GizmoPose& pose, const session::LightEdit& now,
                            session::LightEdit edit, const glm::dvec3& origin, float radius) {
  const bool turned = handle.kind == GizmoHandle::Kind::ring;
  if (now.position && !turned) edit.position = origin + glm::dvec3(rounded(pose.position, radius));
  if (now.rotation && turned) edit.rotation = glm::round(session::anglesOf(pose.rotation) * 10.f) / 10.f;
  if (!edit.position) edit.position = now.position;
  if (!edit.rotation) edit.rotation = now.rotation;
  return edit;
}

float leastSide(float radius) {
  return std::clamp(1e-4f * radius, 1e-9f, 1e-4f);
}

}  // namespace limn::app
