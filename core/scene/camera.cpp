#include "core/scene/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "core/base/error.h"
#include "core/scene/framing.h"
#include "core/scene/private/finite.h"

namespace limn::scene {
namespace {

void check(const CameraPose& camera, int width, int height) {
  if (width < 1 || height < 1)
    throw UsageError(fmt::format("image size {}x{}: both sides must be positive", width, height));
  if (!(camera.yfov > 0.f && camera.yfov < glsl::pi))
    throw UsageError(fmt::format("camera '{}': vertical field of view {} rad is not in (0, pi)", camera.name,
                                 camera.yfov));
}

}  // namespace

DepthRange fitDepthRange(const CameraPose& camera, const Bounds& bounds) {
  const float least = std::max(camera.near, 1e-30f);
  if (bounds.empty()) return {least, 2 * least};
  double nearest = std::numeric_limits<double>::max(), farthest = 0;
  const glm::dmat4 view(camera.worldToView);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec4 p((corner & 1) ? bounds.high.x : bounds.low.x,
                       (corner & 2) ? bounds.high.y : bounds.low.y,
                       (corner & 4) ? bounds.high.z : bounds.low.z, 1);
    const double depth = -(view * p).z;
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  const float near = std::max(least, static_cast<float>(0.99 * nearest));
  return {near, std::max(1.001f * near, static_cast<float>(1.01 * farthest))};
}

void setCamera(glsl::FrameBlock& frame, const CameraPose& camera, const Bounds& bounds, int width,
               int height) {
  check(camera, width, height);
  const DepthRange range = fitDepthRange(camera, bounds);
  const double tangent = std::tan(0.5 * camera.yfov);
  const double aspect = static_cast<double>(width) / height;

  const glm::dmat4 worldToView(camera.worldToView);
  const glm::dmat4 viewToWorld = glm::inverse(worldToView);
  glm::dmat4 viewToClip(0);
  const double near = range.near, far = range.far;
  viewToClip[0][0] = 1 / (tangent * aspect);
  viewToClip[1][1] = 1 / tangent;
  viewToClip[2][2] = -(far + near) / (far - near);
  viewToClip[2][3] = -1;
  viewToClip[3][2] = -2 * far * near / (far - near);

  const glm::dmat4 worldToClip = viewToClip * worldToView;
  frame.world_to_clip = glm::mat4(worldToClip);
  frame.world_to_view = camera.worldToView;
  frame.camera_position = glm::vec4(glm::vec3(viewToWorld[3]), 1.f);

  const glm::dmat3 rotation(viewToWorld);
  const glm::dvec3 dx(2 * tangent * aspect / width, 0, 0), dy(0, 2 * tangent / height, 0);
  const glm::dvec3 origin(-tangent * aspect + 0.5 * dx.x, -tangent + 0.5 * dy.y, -1);
  frame.view_ray_origin = glm::vec4(glm::vec3(rotation * origin), 0.f);
  frame.view_ray_dx = glm::vec4(glm::vec3(rotation * dx), 0.f);
  frame.view_ray_dy = glm::vec4(glm::vec3(rotation * dy), 0.f);
  frame.scene_radius = bounds.radius();
  frame.frame_size = {width, height};
}

CameraPose lookAt(const glm::vec3& eye, const glm::vec3& target, float yfov) {
  if (!finite(eye) || !finite(target)) throw UsageError("camera: eye and target must be finite numbers");
  const glm::dvec3 from(eye), to(target);
  const double distance = glm::length(to - from);
  if (!(distance > 0))
    throw UsageError(fmt::format("camera: eye and target are the same point {},{},{}", eye.x, eye.y, eye.z));
  const glm::dvec3 forward = (to - from) / distance;
  const bool vertical = std::abs(forward.y) > 0.9999;  // +X stays on the right
  const glm::dvec3 up = vertical ? glm::dvec3(0, 0, std::copysign(1.0, forward.y)) : glm::dvec3(0, 1, 0);
  CameraPose camera;
  camera.worldToView = glm::mat4(glm::lookAt(from, to, up));
  camera.yfov = yfov;
  camera.near = static_cast<float>(1e-4 * distance);
  return camera;
}

CameraPose frameBounds(const Bounds& bounds, float yfov) {
  Framing framing(kSeenFrom, yfov);
  framing.add(bounds);
  return framing.camera();
}

}  // namespace limn::scene
