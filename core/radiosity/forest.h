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

/// Holds the corners of up to four triangles between leaves, for arithmetic with four at once.
struct TrianglePack {
  glm::vec4 x[3], y[3], z[3];  ///< of each corner
  glm::uvec4 leaves[3];        ///< of each corner: its slot
  glm::uvec4 owners{0};        ///< 1 << the lane of the leaf that it belongs to; 0: no triangle
};

/// Says what bounds of leaves hold.
enum class LeafShape {
  disc,       ///< their centres: leaves are discs to other elements
  triangles,  ///< the triangles that they own, which are seen in their place (Fill::triangles)
};

/// Holds the elements of all levels in groups of four siblings: leaves first, then level after level, the
/// clusters of a level one after the other. It needs no pointers: the children of lane k of a group are group
/// children + k. Unused lanes have no area.
class LIMN_API Forest {
 public:
  Forest() = default;
  /// Builds the hierarchy. Positions and areas of `surfels` are in the space of the elements.
  explicit Forest(const Surfels& surfels, LeafShape shape = LeafShape::disc);

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

  LeafShape shape() const { return shape_; }
  /// Returns the mesh between the surfels: 3 leaf slots per triangle, front faces counter-clockwise. Each
  /// belongs to its corner with the lowest slot, and those of a leaf follow each other.
  std::span<const uint32_t> triangles() const { return triangles_; }
  /// Returns the number of the first triangle of each leaf slot, and behind the last that of all triangles.
  std::span<const uint32_t> firstTriangle() const { return firstTriangle_; }
  /// Returns the same triangles, with those of a group's leaves together, and the number of each leaf
  /// group's first pack; behind the last that of all packs. None but for LeafShape::triangles.
  std::span<const TrianglePack> packs() const { return packs_; }
  std::span<const uint32_t> firstPack() const { return firstPack_; }

  /// Sets the positions, normals and vertices of `surfels`; areas stay. Uses all cores; allocates nothing.
  void refit(const Surfels& surfels);

 private:
  void placeTriangles(const Surfels& surfels);
  void packTriangles();
  void refitPacks(uint32_t group);
  void boundTriangles(uint32_t leaf);
  void refitGroup(glsl::ElementGroup& group);

  LeafShape shape_ = LeafShape::disc;
  std::vector<glsl::ElementGroup> groups_;
  std::vector<Level> levels_{1};
  std::vector<uint32_t> roots_, leafOf_, parents_, triangles_, firstTriangle_, firstPack_;
  std::vector<TrianglePack> packs_;
  std::vector<glm::vec3> vertices_;  ///< of each leaf slot
};

}  // namespace limn::radiosity
