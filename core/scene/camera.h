// The one camera that the GPU and the reference share: pixel grid, view rays and clip planes.
//
// Pixel (0, 0) is the lower left one, as gl_FragCoord and texture rows count; row r of an Image (from the
// top) is pixel y = height - 1 - r. Pixel centres lie at half-integers of the view plane.
#pragma once

#include "core/base/export.h"
#include "core/scene/scene.h"
#include "glsl/blocks.glsl"

namespace limn::scene {

/// Writes the camera's members of `frame`: matrices, camera_position, view_ray_*, environment.w (radius of
/// `bounds`, metres) and frame_size.xy. near is camera.near or, where that is farther, just before the
/// nearest corner of `bounds`; far lies just behind the farthest. Throws UsageError if the size is not
/// positive or yfov not in (0, pi).
LIMN_API void setCamera(glsl::FrameBlock& frame, const CameraPose& camera, const Bounds& bounds, int width,
                        int height);

/// near and far along the view axis, metres, as setCamera fits them.
struct DepthRange {
  float near = 0, far = 0;
};
LIMN_API DepthRange fitDepthRange(const CameraPose& camera, const Bounds& bounds);

/// A camera at `eye` looking at `target`, world +Y up (where it looks along Y: +X to the right); near is 1e-4
/// of the distance between the two. yfov in radians. Throws UsageError if eye and target coincide or a value
/// is not finite.
LIMN_API CameraPose lookAt(const glm::vec3& eye, const glm::vec3& target, float yfov);

/// A camera that sees all of `bounds` from the front, slightly above: for scenes that bring none.
LIMN_API CameraPose frameBounds(const Bounds& bounds, float yfov = 0.8f);

}  // namespace limn::scene
