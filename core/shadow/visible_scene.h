// Declares what a camera sees of a scene, estimated with boxes around parts of its meshes, for fitting shadow
// maps to it. No OpenGL.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/scene/scene.h"
#include "core/shadow/convex.h"

namespace limn::shadow {

/// Holds a box around some triangles of an instance.
struct ScenePart {
  scene::Bounds bounds;  ///< world
  uint32_t instance = 0;
};

/// Holds a convex solid that encloses all that the camera sees of a part.
struct VisiblePart {
  Convex solid;                    ///< world
  std::vector<glm::vec3> corners;  ///< of the solid, about once each
  uint32_t instance = 0;
};

/// Holds the boxes of all parts, and what the camera sees of them, at one pose.
class LIMN_API VisibleScene {
 public:
  /// Splits every primitive into boxes, once, in O(triangles). `scene` must outlive the object.
  explicit VisibleScene(const scene::Scene& scene);

  /// Updates the parts to `pose` and the camera. `instanceBounds` are the world bounds of pose.instances;
  /// they replace the boxes of what is deformed or dynamic. `aspect` is width over height. Returns false, and
  /// does nothing, where all of these are those of the last call.
  bool update(const scene::Pose& pose, std::span<const scene::Bounds> instanceBounds,
              const scene::CameraPose& camera, float aspect);

  std::span<const ScenePart> parts() const { return parts_; }
  std::span<const VisiblePart> visible() const { return {visible_.data(), visibleCount_}; }

 private:
  std::vector<std::vector<std::vector<scene::Bounds>>> boxes_;  ///< of meshes' primitives, object space
  std::vector<scene::DrawInstance> instances_;  ///< of the last update, as are those that follow
  std::vector<scene::Bounds> instanceBounds_;
  std::array<glm::vec4, 4> planes_{};
  std::vector<ScenePart> parts_;
  std::vector<VisiblePart> visible_;  ///< the first visibleCount_ are valid; the rest is kept memory
  size_t visibleCount_ = 0;
};

}  // namespace limn::shadow
