// Declares the one camera that the GPU and the reference share: pixel grid, view rays and clip planes.
//
// Pixel (0, 0) is the lower left one, as in gl_FragCoord and in texture rows; row r of an Image (from the
// top) is pixel y = height - 1 - r. Pixel centres lie at half-integers of the view plane.
#pragma once

#include "core/base/export.h"
#include "core/scene/scene.h"
#include "glsl/scene/blocks.glsl"

namespace limn::scene {

/// Writes the camera's members of `frame`: matrices, camera_position, view_ray_*, scene_radius (radius of
/// `bounds`, metres) and frame_size. The near plane is at camera.near or, where that is farther, just before
/// the nearest corner of `bounds`; the far plane lies just behind the farthest corner. Throws UsageError when
/// the size is not positive or yfov is not in (0, pi).
LIMN_API void setCamera(glsl::FrameBlock& frame, const CameraPose& camera, const Bounds& bounds, int width,
                        int height);

/// Holds the distances of the near and far planes along the view axis, metres, as setCamera fits them.
struct DepthRange {
  float near = 0, far = 0;
};
LIMN_API DepthRange fitDepthRange(const CameraPose& camera, const Bounds& bounds);

/// Returns a camera at `eye` that looks at `target` with world +Y up (when it looks along Y: +X to the
/// right). near is 1e-4 of the distance between the two; yfov is in radians. Throws UsageError when eye and
/// target coincide or a value is not finite.
LIMN_API CameraPose lookAt(const glm::vec3& eye, const glm::vec3& target, float yfov);

/// Returns a camera that sees all of `bounds` from the front, slightly above, for scenes that have no camera.
LIMN_API CameraPose frameBounds(const Bounds& bounds, float yfov = 0.8f);

}  // namespace limn::scene
