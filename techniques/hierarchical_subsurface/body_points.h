// Declares the points of the translucent bodies of a scene: what moves them, lights them and walks over them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/radiosity/scene_elements.h"
#include "core/scene/scene.h"
#include "techniques/hierarchical_subsurface/scatter_tree.glsl"
#include "techniques/hierarchical_subsurface/walk_tree.h"

namespace limn::hierarchical_subsurface {

/// Holds the points of every draw whose material scatters light below its surface. Double-sided draws have
/// points on their fronts alone.
class BodyPoints {
 public:
  /// Makes about `count` points for each body, which are the vertices of its mesh after long edges have been
  /// halved: bodies with more vertices have more. Throws UsageError as soon as their nodes take more than
  /// `mostBytes`.
  BodyPoints(const scene::Scene& scene, const scene::Pose& pose, int count, int64_t mostBytes);

  /// Returns whether `pose` differs only in where vertices are, as SceneElements has it.
  bool fits(const scene::Pose& pose) const;
  /// Moves the points to `pose`, which must fit; areas stay.
  void update(const scene::Pose& pose);

  /// Returns an element for each draw instance; of those that are no bodies all is 0.
  std::span<const glsl::ScatterBody> bodies() const { return bodies_; }
  /// Returns where each leaf is lit.
  std::span<const glsl::ScatterPoint> points() const { return points_; }
  const WalkTree& tree() const { return tree_; }

 private:
  /// Holds one draw, which stands alone in a pose of its own.
  struct Body {
    uint32_t draw = 0;
    scene::Pose pose;
    std::unique_ptr<radiosity::SceneElements> elements;
    std::vector<float> areas;  ///< of each leaf slot
    float spacing = 0;         ///< side of the area of the point at a random place
    /// Takes the elements from where they are into the draw's own space, so that they move as the matrix
    /// says. Nothing where that cannot be: the elements themselves follow what is deformed.
    std::optional<glm::dmat4> toOwn;
    glm::dmat4 motion{1};  ///< takes the elements from where they are to where the draw is, world
  };
  /// Throws UsageError for more than `most` points.
  Body makeBody(uint32_t draw, const scene::Pose& pose, int count, size_t most) const;
  void place(size_t index);

  const scene::Scene& scene_;
  size_t drawCount_ = 0;
  std::vector<Body> parts_;
  WalkTree tree_;
  std::vector<glsl::ScatterBody> bodies_;
  std::vector<glsl::ScatterPoint> points_;
};

}  // namespace limn::hierarchical_subsurface
