// Declares the hierarchy of surface elements: a quad-tree over every cluster (thesis, section 4.3.1,
// "Geometric Hierarchy Preprocessing"). It is built once; each frame refits positions and normals.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/radiosity/surfels.h"
#include "glsl/indirect/direction_bins.glsl"

namespace limn::radiosity {

/// Maps from world space to the space of the elements. The scene's radius becomes 1, so that scale does not
/// matter, and the axes are rotated against those of the world: scenes are often aligned with the world's
/// axes, and their surfaces would run along the edges of bins.
class LIMN_API ElementSpace {
 public:
  ElementSpace() = default;
  ElementSpace(const glm::vec3& centre, float radius);
  glm::vec3 point(const glm::vec3& world) const;
  glm::vec3 worldPoint(const glm::vec3& point) const;
  /// Returns the direction in the space of the elements; lengths are kept.
  glm::vec3 direction(const glm::vec3& world) const;
  glm::vec3 worldDirection(const glm::vec3& direction) const;
  /// Returns one unit of the space of the elements in metres.
  float radius() const { return radius_; }
  const glm::vec3& centre() const { return centre_; }

 private:
  glm::vec3 centre_{0};
  float radius_ = 1;
};

/// Holds the elements of all levels in groups of four siblings: leaves first, then level after level, the
/// clusters of a level one after the other. It needs no pointers: the children of lane k of a group are group
/// children + k. Unused lanes have no area.
class LIMN_API Forest {
 public:
  Forest() = default;
  /// Builds the hierarchy. Positions and areas of `surfels` are in the space of the elements.
  explicit Forest(const Surfels& surfels);

  /// Returns the number of leaf slots: 4 per group, including unused ones. Every level's elements follow
  /// those of the level below.
  uint32_t leafSlots() const { return 4 * levels_.front().count; }
  uint32_t slots() const { return 4 * static_cast<uint32_t>(groups_.size()); }
  /// Returns the leaf of each surfel.
  std::span<const uint32_t> leafOf() const { return leafOf_; }

  std::span<const glsl::ElementGroup> groups() const { return groups_; }
  /// Holds the groups of a level: first and count. Level [0] holds the leaves.
  struct Level {
    uint32_t first = 0, count = 0;
  };
  std::span<const Level> levels() const { return levels_; }
  /// Returns the groups that hold the roots of the clusters (lane 0 alone).
  std::span<const uint32_t> roots() const { return roots_; }

  /// Returns, for each group, the element whose children it holds, or no_link.
  std::span<const uint32_t> parents() const { return parents_; }

  /// Sets new positions and normals, one per surfel; areas stay. Uses all cores; allocates nothing.
  void refit(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals);

 private:
  void refitGroup(glsl::ElementGroup& group);

  std::vector<glsl::ElementGroup> groups_;
  std::vector<Level> levels_{1};
  std::vector<uint32_t> roots_, leafOf_, parents_;
};

}  // namespace limn::radiosity
