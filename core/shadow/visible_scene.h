// What a camera sees of a scene, as far as boxes around parts of its meshes tell: for fitting shadow maps to
// it. No OpenGL.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/scene/scene.h"
#include "core/shadow/convex.h"

namespace limn::shadow {

/// A box around some triangles of an instance.
struct ScenePart {
  scene::Bounds bounds;  ///< world
  uint32_t instance = 0;
};

/// A convex solid that holds all the camera sees of a part.
struct VisiblePart {
  Convex solid;  ///< world
  uint32_t instance = 0;
};

/// Boxes of all parts, and what of them the camera sees, at one pose.
class LIMN_API VisibleScene {
 public:
  /// Splits every primitive into boxes: once, O(triangles). `scene` must outlive it.
  explicit VisibleScene(const scene::Scene& scene);

  /// `instanceBounds`: world bounds of pose.instances; they stand for what is deformed or dynamic. `aspect`:
  /// width over height.
  void update(const scene::Pose& pose, std::span<const scene::Bounds> instanceBounds,
              const scene::CameraPose& camera, float aspect);

  std::span<const ScenePart> parts() const { return parts_; }
  std::span<const VisiblePart> visible() const { return {visible_.data(), visibleCount_}; }

 private:
  const scene::Scene& scene_;
  std::vector<std::vector<std::vector<scene::Bounds>>> boxes_;  ///< of meshes' primitives, object space
  std::vector<ScenePart> parts_;
  std::vector<VisiblePart> visible_;  ///< the first visibleCount_ of them; the rest is memory kept
  size_t visibleCount_ = 0;
};

}  // namespace limn::shadow
