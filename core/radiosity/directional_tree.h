// Declares light that leaves an element as an adaptive tree over the directions around its normal, +z: a Haar
// basis on the upper half of the octahedron (Stamminger et al. 1999, Efficient Glossy Global Illumination
// with Interactive Viewing), or in a uniform basis.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/base/export.h"

namespace limn::radiosity {

/// Returns how much a triangle of unit directions weighs: its projected solid angle, sr.
LIMN_API float cellWeight(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// Holds the least and the greatest value over some directions, per channel.
struct DirectionBounds {
  glm::vec3 low{0}, high{0};
};

/// A function over the hemisphere, constant in each cell of a tree of triangles
/// (glsl/numeric/octahedral_cells.glsl). Without nodes it is 0 everywhere.
class LIMN_API DirectionalTree {
 public:
  /// Holds a cell: the mean over its directions by projected angle.
  struct Node {
    glm::vec3 value{0};
    uint32_t child = 0;  ///< the first of its four children; 0: none
  };

  static constexpr uint32_t kFaces = 4;  ///< of the octahedron

  /// Takes a tree's nodes: the faces first, children in runs of four behind their parents. Memory is kept
  /// where it suffices.
  void assign(std::span<const Node> nodes);
  /// Takes values at the corners of a level, 0 to kMaxUniformLevel (glsl/numeric/octahedral_grid.glsl).
  void assignUniform(int level, std::span<const glm::vec3> corners);
  static constexpr int kMaxUniformLevel = 8;
  void clear() {
    nodes_.clear();
    corners_.clear();
  }

  bool empty() const { return nodes_.empty() && corners_.empty(); }
  bool uniform() const { return !corners_.empty(); }
  /// Returns the level of a uniform basis.
  int level() const { return level_; }
  std::span<const Node> nodes() const { return nodes_; }
  /// Returns the values of a uniform basis.
  std::span<const glm::vec3> corners() const { return corners_; }
  /// Returns the number of cells without children.
  size_t cellCount() const;
  /// Returns the memory that the values take, bytes.
  size_t memory() const { return nodes_.size() * sizeof(Node) + corners_.size() * sizeof(glm::vec3); }

  /// Returns the value in direction w (any length but 0); 0 below the horizon.
  glm::vec3 value(const glm::vec3& w) const;
  /// Returns the mean of six values around w, over the footprint of its cell; uniform: the value.
  glm::vec3 smoothValue(const glm::vec3& w) const;
  /// Returns the bounds over the directions (above the horizon) less than an angle from `axis` (unit), by
  /// that angle's cosine, and over no more than the cells that these lie in.
  DirectionBounds bounds(const glm::vec3& axis, float cosine) const;
  /// Returns the integral over the hemisphere by projected angle: radiosity of radiance.
  glm::vec3 flux() const;

  /// Appends the nodes as the GPU has them (glsl/indirect/packed_tree.glsl); returns the scale of their
  /// values. Negative values become 0.
  float pack(std::vector<glm::uvec2>& nodes) const;

  void scale(const glm::vec3& factor);
  /// Adds `weight` times a tree in the same frame and of the same basis and level. The result has the cells
  /// of both.
  void add(const DirectionalTree& other, float weight = 1);

 private:
  DirectionBounds uniformBounds(const glm::vec3& axis, float cosine) const;
  void addBelow(uint32_t node, const DirectionalTree& other, uint32_t otherNode, float weight);

  std::vector<Node> nodes_;
  int level_ = 0;
  std::vector<glm::vec3> corners_;
};

}  // namespace limn::radiosity
