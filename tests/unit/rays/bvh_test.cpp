// Hierarchies that rays walk: nothing is lost, every box contains what lies below it, and stacks suffice.
#include "core/rays/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace limn::rays {
namespace {

using glsl::RayBox;

/// Boxes of triangles of very different sizes, around `middle`.
std::vector<RayBox> randomBoxes(uint32_t count, uint32_t seed, const glm::vec3& middle = glm::vec3(0)) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-1, 1), exponent(-12, 0);
  std::vector<RayBox> boxes;
  for (uint32_t i = 0; i < count; ++i) {
    const float size = std::exp2(exponent(random));
    const glm::vec3 corner = middle + glm::vec3(place(random), place(random), place(random));
    boxes.push_back(glsl::ray_box_grown(
        {corner, corner + size * glm::vec3(1 + place(random), 1 + place(random), 1 + place(random))}));
  }
  return boxes;
}

bool contains(const RayBox& outer, const RayBox& inner) {
  // A box is given with a margin of 2^-19 of its coordinates, of which packing may round away a part.
  const glm::vec3 reach = glm::max(glm::abs(inner.low), glm::abs(inner.high));
  const float rounding = 0x1p-22f * std::max({reach.x, reach.y, reach.z});
  return glm::all(glm::lessThanEqual(outer.low, inner.low + rounding)) &&
         glm::all(glm::greaterThanEqual(outer.high, inner.high - rounding));
}

/// Checks a subtree whose items must lie in `outer`; returns the largest number of entries that a walk into
/// everything puts on its stack beyond `held`.
int check(const BvhBuilder& tree, std::span<const RayBox> boxes, uint32_t node, std::vector<int>& found,
          int depth = 0) {
  EXPECT_LT(depth, 64);
  const glsl::RayNode& n = tree.nodes()[node];
  int children = 0, need = 0;
  for (int i = 0; i < 4 && n.child[i] != glsl::ray_no_child; ++i) ++children;
  need = children;
  for (int i = 0; i < children; ++i) {
    const RayBox box = glsl::ray_node_box(n, i);
    if (glsl::ray_is_leaf(n.child[i])) {
      const uint32_t first = glsl::ray_leaf_first(n.child[i]);
      for (uint32_t k = first; k < first + glsl::ray_leaf_count(n.child[i]); ++k) {
        const uint32_t item = tree.order()[k];
        ++found[item];
        EXPECT_TRUE(contains(box, boxes[item])) << item;
      }
      continue;
    }
    EXPECT_GT(n.child[i], node);
    need = std::max(need, children - 1 - i + check(tree, boxes, n.child[i], found, depth + 1));
    // Refits join the decoded boxes of a node: they lie within the box that its parent has, but for a step.
    const RayBox below = glsl::ray_node_bounds(tree.nodes()[n.child[i]]);
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(below.low, box.low - n.scale)));
    EXPECT_TRUE(glm::all(glm::lessThanEqual(below.high, box.high + n.scale)));
  }
  return need;
}

void checkAll(std::span<const RayBox> boxes, uint32_t leafItems, Split split) {
  BvhBuilder tree;
  tree.build(boxes, leafItems, split);
  std::vector<int> found(boxes.size(), 0);
  const int need = check(tree, boxes, 0, found);
  EXPECT_TRUE(std::ranges::all_of(found, [](int times) { return times == 1; }));
  EXPECT_EQ(need, tree.stack());
  EXPECT_LE(tree.stack(), BvhBuilder::kLargestStack);
  if (split == Split::median) {
    EXPECT_LE(tree.stack(), medianStack(static_cast<uint32_t>(boxes.size())));
  }
  EXPECT_EQ(tree.levels().front(), 0u);
  EXPECT_EQ(tree.levels().back(), tree.nodes().size());
}

TEST(BvhTest, EveryItemIsInOneLeafWithinAllBoxesAbove) {
  for (const uint32_t count : {1u, 2u, 3u, 4u, 5u, 17u, 1000u, 20000u})
    for (const Split split : {Split::surfaceArea, Split::median})
      for (const uint32_t leafItems : {1u, 4u}) checkAll(randomBoxes(count, count), leafItems, split);
}

TEST(BvhTest, BoxesFarFromTheOriginKeepTheirItems) {
  for (const float far : {1e3f, 1e6f, 1e-6f})
    checkAll(randomBoxes(500, 7, glm::vec3(far, -far, 0.5f * far)), 4, Split::surfaceArea);
}

TEST(BvhTest, ItemsInOnePlaceAndItemsThatDoubleInDistanceKeepStacksShort) {
  checkAll(std::vector<RayBox>(5000, RayBox{glm::vec3(1), glm::vec3(2)}), 4, Split::surfaceArea);
  std::vector<RayBox> doubling;
  for (int i = 0; i < 120; ++i) {
    const glm::vec3 corner(std::exp2(static_cast<float>(i)), 0, 0);
    doubling.push_back(glsl::ray_box_grown({corner, corner * 1.5f}));
  }
  checkAll(doubling, 1, Split::surfaceArea);
  checkAll(std::vector<RayBox>(3, RayBox{glm::vec3(0), glm::vec3(0)}), 4, Split::surfaceArea);
}

TEST(BvhTest, LeavesSayWhatTheyHold) {
  for (uint32_t count = 1; count <= glsl::ray_leaf_items; ++count) {
    const uint32_t leaf = glsl::ray_leaf(glsl::ray_leaf_mask - 8, count);
    EXPECT_TRUE(glsl::ray_is_leaf(leaf));
    EXPECT_EQ(glsl::ray_leaf_first(leaf), glsl::ray_leaf_mask - 8);
    EXPECT_EQ(glsl::ray_leaf_count(leaf), count);
  }
  EXPECT_NE(glsl::ray_leaf(0x1ffffff8u, 4), glsl::ray_no_child);
}

}  // namespace
}  // namespace limn::rays
