// Declares the builder of the hierarchies that rays walk (glsl/rays/ray_node.glsl).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "glsl/rays/ray_node.glsl"

namespace limn::rays {

/// Says how a node's items are split among its children.
enum class Split : uint8_t {
  surfaceArea,  ///< where the surface-area heuristic over bins expects the fewest tests (Wald 2007)
  median        ///< into halves of equal count: as shallow as can be
};

/// Returns the entries that a walk's stack needs at most for a hierarchy of `items` items split at medians.
LIMN_API int medianStack(uint32_t items);

/// Builds hierarchies; its memory is kept from one to the next.
class LIMN_API BvhBuilder {
 public:
  /// Builds the hierarchy of `boxes`, of which there is at least one and at most 2^29. Splits by surface area
  /// that would need a stack beyond kLargestStack are replaced by medians.
  void build(std::span<const glsl::RayBox> boxes, uint32_t leafItems, Split split);

  /// Returns the nodes level by level, the root first. Children and items count from 0.
  std::span<const glsl::RayNode> nodes() const { return nodes_; }
  /// Returns the numbers of the boxes in the order of the leaves.
  std::span<const uint32_t> order() const { return order_; }
  /// Returns the first node of each level, then the number of nodes.
  std::span<const uint32_t> levels() const { return levels_; }
  /// Returns the entries that a walk's stack needs at most.
  int stack() const { return stack_; }

  static constexpr int kLargestStack = 64;

 private:
  /// The items order_[first] .. order_[end - 1].
  struct Range {
    uint32_t first, end;
    glsl::RayBox box;  ///< around them
    uint32_t count() const { return end - first; }
  };
  void buildOnce(Split split);
  Range range(uint32_t first, uint32_t end) const;
  uint32_t splitPoint(const Range& range, Split split);
  uint32_t areaSplit(const Range& range, int axis, float low, float high);
  int deepestStack();

  std::span<const glsl::RayBox> boxes_;
  uint32_t leafItems_ = 1;
  std::vector<glsl::RayNode> nodes_;
  std::vector<uint32_t> order_, levels_;
  std::vector<Range> pending_;  ///< what each node is made of
  std::vector<int> needs_;      ///< entries that a walk below each node needs
  int stack_ = 0;
};

}  // namespace limn::rays
