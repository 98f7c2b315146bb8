// Declares what of boxes lies in the square pyramids through which a light looks at them. No OpenGL.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "core/shadow/private/window_fit.h"

namespace limn::shadow {

/// Holds depths, metres; none at first.
struct DepthRange {
  float near = std::numeric_limits<float>::max(), far = 0;
};

/// Returns the axes of a face of shadow_face() (glsl/shadow/shadow_view.glsl) about those of face 0.
MapAxes faceAxes(const MapAxes& axes, uint32_t face);

/// Returns what of the boxes lies in the cube whose sides are `reach` metres from `centre`; `kept` holds it.
std::span<const scene::Bounds> boxesAround(const glm::vec3& centre, float reach,
                                           std::span<const scene::Bounds> boxes,
                                           std::vector<scene::Bounds>& kept);

/// Returns the corners of a box relative to `origin`, in the axes, in the order of boxCorners().
std::array<glm::vec3, 8> corners(const scene::Bounds& box, const glm::vec3& origin, const MapAxes& axes);

/// Returns the tangent of half the angle of the square pyramid around the boxes: infinite where one reaches
/// beside or behind the origin, 0 where all lie behind it.
float fittedTangent(const glm::vec3& origin, const MapAxes& axes, std::span<const scene::Bounds> boxes);

/// Returns the depths of all that lies in the pyramids of `faceCount` faces, every `step`-th of
/// shadow_face(); from 0 on where the origin lies in a box.
DepthRange pyramidRange(const glm::vec3& origin, const MapAxes& axes, uint32_t faceCount, uint32_t step,
                        float tangent, std::span<const scene::Bounds> boxes);

/// Returns the range with a little room at both ends, so that rounding does not cut what touches them. It is
/// never empty.
DepthRange widened(DepthRange range);

}  // namespace limn::shadow
