// Declares the forests of several bodies as one array of nodes, through which walks need no stack.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/radiosity/forest.h"
#include "techniques/hierarchical_subsurface/scatter_tree.glsl"

namespace limn::hierarchical_subsurface {

/// Says how a body has moved since its forest was placed: what was at `p` is at turn * p + shift. Lengths are
/// in radii of the body.
struct BodyMotion {
  glm::mat3 turn{1};
  glm::vec3 shift{0};
};

/// Holds nodes level by level, the leaves of all bodies first, so that one dispatch sums a level of all
/// bodies.
class WalkTree {
 public:
  using Level = radiosity::Forest::Level;  ///< here of nodes

  WalkTree() = default;
  /// Makes the nodes of the forests; their places and areas are set by place().
  explicit WalkTree(std::span<const radiosity::Forest* const> forests) {
    size_t levelCount = 0;
    for (const radiosity::Forest* forest : forests)
      levelCount = std::max(levelCount, forest->levels().size());
    shifts_.resize(forests.size());
    uint32_t next = 0;
    for (size_t level = 0; level < levelCount; ++level) {
      levels_.push_back({next, 0});
      for (size_t body = 0; body < forests.size(); ++body) {
        if (level >= forests[body]->levels().size()) continue;
        const Level groups = forests[body]->levels()[level];
        shifts_[body].push_back(next - 4 * groups.first);
        next += 4 * groups.count;
      }
      levels_.back().count = next - levels_.back().first;
    }
    nodes_.resize(next);
    for (size_t body = 0; body < forests.size(); ++body) link(body, *forests[body]);
  }

  std::span<const glsl::ScatterNode> nodes() const { return nodes_; }
  std::span<const Level> levels() const { return levels_; }
  uint32_t leafCount() const { return levels_.empty() ? 0 : levels_.front().count; }
  /// Returns the node of a slot of a body's forest, all of whose levels below `level` end before it.
  uint32_t node(size_t body, size_t level, uint32_t slot) const { return slot + shifts_[body][level]; }
  /// Returns where walks through a body begin, or glsl::scatter_none.
  uint32_t first(size_t body) const { return firsts_[body]; }

  /// Sets where a body's nodes are, by its forest and how the body has moved since then: centroids move with
  /// what they are of. `areas`: of each leaf slot.
  void place(size_t body, const radiosity::Forest& forest, const radiosity::ElementSpace& space,
             std::span<const float> areas, const BodyMotion& motion = {}) {
    const auto levels = forest.levels();
    for (size_t level = 0; level < levels.size(); ++level)
      for (uint32_t g = levels[level].first; g < levels[level].first + levels[level].count; ++g)
        for (uint32_t lane = 0; lane < forest.groups()[g].lanes; ++lane) {
          const glsl::ElementGroup& group = forest.groups()[g];
          const auto k = static_cast<int>(lane);
          glsl::ScatterNode& n = nodes_[node(body, level, 4 * g + lane)];
          n.centre = motion.turn * space.worldDirection({group.x[k], group.y[k], group.z[k]}) + motion.shift;
          n.area = level == 0 ? areas[4 * g + lane] : 0;
          for (uint32_t child = 0; child < n.child_count; ++child) n.area += nodes_[n.children + child].area;
          n.extent = extentOf(n.area, group.radius[k]);
        }
  }

 private:
  /// Returns the area by which a cluster is opened. Clusters that are long and narrow, or of parts that lie
  /// apart, look small from places in their midst: each counts as a square with corners as far from its
  /// centroid as its farthest point. `radius`: of a ball around it that holds all points.
  static float extentOf(float area, float radius) {
    const bool wide = area > 0 && radius * radius > area;
    return wide ? 2 * radius * radius : area;
  }

  /// Clusters are chained one behind the other, and so are the four children of an element.
  void link(size_t body, const radiosity::Forest& forest) {
    const auto levels = forest.levels();
    const auto levelOf = [&](uint32_t group) {
      size_t level = 0;
      while (group >= levels[level].first + levels[level].count) ++level;
      return level;
    };
    uint32_t behind = glsl::scatter_none;
    for (size_t i = forest.roots().size(); i-- > 0;) {
      const uint32_t group = forest.roots()[i], root = node(body, levelOf(group), 4 * group);
      nodes_[root].next = behind;
      behind = root;
    }
    firsts_.push_back(behind);
    for (size_t level = levels.size(); level-- > 0;)
      for (uint32_t g = levels[level].first; g < levels[level].first + levels[level].count; ++g)
        for (uint32_t lane = 0; lane < forest.groups()[g].lanes; ++lane) {
          glsl::ScatterNode& n = nodes_[node(body, level, 4 * g + lane)];
          n.children = glsl::scatter_none;
          if (level == 0) continue;
          const uint32_t below = forest.groups()[g].children + lane;
          n.children = node(body, level - 1, 4 * below);
          n.child_count = forest.groups()[below].lanes;
          for (uint32_t k = 0; k < n.child_count; ++k)
            nodes_[n.children + k].next = k + 1 < n.child_count ? n.children + k + 1 : n.next;
        }
  }

  std::vector<glsl::ScatterNode> nodes_;
  std::vector<Level> levels_;
  std::vector<std::vector<uint32_t>> shifts_;  ///< of each body: from slots to nodes, by level
  std::vector<uint32_t> firsts_;
};

}  // namespace limn::hierarchical_subsurface
