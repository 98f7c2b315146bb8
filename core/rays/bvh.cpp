#include "core/rays/bvh.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace limn::rays {
namespace {

using glsl::RayBox;

constexpr int kBins = 16;

/// Returns half the surface of a box, m^2; 0 for an empty one.
float halfArea(const RayBox& box) {
  const glm::vec3 e = glm::max(box.high - box.low, 0.f);
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

/// Returns twice the centre of a box along an axis.
float centre(const RayBox& box, int axis) {
  return box.low[axis] + box.high[axis];
}

struct Bin {
  RayBox box = glsl::ray_box_empty();
  uint32_t count = 0;
  void add(const Bin& other) {
    box = glsl::ray_box_join(box, other.box);
    count += other.count;
  }
  float cost() const { return count == 0 ? 0.f : halfArea(box) * static_cast<float>(count); }
};

}  // namespace

int medianStack(uint32_t items) {
  int levels = 1;
  for (uint64_t held = 4; held < items; held *= 4) ++levels;
  return 3 * levels + 1;
}

void BvhBuilder::build(std::span<const RayBox> boxes, uint32_t leafItems, Split split) {
  boxes_ = boxes;
  leafItems_ = std::clamp(leafItems, 1u, glsl::ray_leaf_items);
  order_.resize(boxes.size());
  std::iota(order_.begin(), order_.end(), 0u);
  buildOnce(split);
  if (stack_ > kLargestStack && split != Split::median) buildOnce(Split::median);
}

void BvhBuilder::buildOnce(Split split) {
  nodes_.clear();
  pending_.assign(1, range(0, static_cast<uint32_t>(order_.size())));
  levels_.assign(1, 0);
  uint32_t levelEnd = 1;
  for (uint32_t made = 0; made < pending_.size(); ++made) {
    if (made == levelEnd) {
      levels_.push_back(made);
      levelEnd = static_cast<uint32_t>(pending_.size());
    }
    const Range whole = pending_[made];
    std::array<Range, 4> parts{whole};
    uint32_t count = 1;
    while (count < 4) {
      // What a ray most likely enters gains most by being split; medians keep the counts alike.
      uint32_t widest = 4;
      float most = -1;
      for (uint32_t i = 0; i < count; ++i) {
        if (parts[i].count() < 2) continue;
        const float size =
            split == Split::median ? static_cast<float>(parts[i].count()) : halfArea(parts[i].box);
        if (!(size > most)) continue;
        most = size;
        widest = i;
      }
      if (widest == 4) break;
      const uint32_t at = splitPoint(parts[widest], split);
      parts[count++] = range(at, parts[widest].end);
      parts[widest] = range(parts[widest].first, at);
    }
    // Walks for any hit visit first what hides most.
    std::stable_sort(parts.begin(), parts.begin() + count,
                     [](const Range& a, const Range& b) { return halfArea(a.box) > halfArea(b.box); });
    glsl::RayNode node = glsl::ray_node_around(whole.box);
    for (uint32_t i = 0; i < count; ++i) {
      const bool leaf = parts[i].count() <= leafItems_;
      const uint32_t child =
          leaf ? glsl::ray_leaf(parts[i].first, parts[i].count()) : static_cast<uint32_t>(pending_.size());
      if (!leaf) pending_.push_back(parts[i]);
      glsl::ray_node_add(node, static_cast<int>(i), parts[i].box, child);
    }
    nodes_.push_back(node);
  }
  levels_.push_back(static_cast<uint32_t>(nodes_.size()));
  stack_ = deepestStack();
}

BvhBuilder::Range BvhBuilder::range(uint32_t first, uint32_t end) const {
  Range result{first, end, glsl::ray_box_empty()};
  for (uint32_t i = first; i < end; ++i) result.box = glsl::ray_box_join(result.box, boxes_[order_[i]]);
  return result;
}

/// Reorders the items of a range of at least two and returns where its second part begins.
uint32_t BvhBuilder::splitPoint(const Range& range, Split split) {
  glm::vec3 low(3e38f), high(-3e38f);
  for (uint32_t i = range.first; i < range.end; ++i) {
    const RayBox& box = boxes_[order_[i]];
    low = glm::min(low, box.low + box.high);
    high = glm::max(high, box.low + box.high);
  }
  const glm::vec3 extent = high - low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const uint32_t middle = range.first + (range.count() + 1) / 2;
  if (!(extent[axis] > 0)) return middle;
  if (split == Split::surfaceArea && range.count() > 2) {
    const uint32_t at = areaSplit(range, axis, low[axis], high[axis]);
    if (at > range.first && at < range.end) return at;
  }
  std::nth_element(order_.begin() + range.first, order_.begin() + middle, order_.begin() + range.end,
                   [&](uint32_t a, uint32_t b) { return centre(boxes_[a], axis) < centre(boxes_[b], axis); });
  return middle;
}

uint32_t BvhBuilder::areaSplit(const Range& range, int axis, float low, float high) {
  const float scale = static_cast<float>(kBins) / (high - low);
  const auto binOf = [&](uint32_t item) {
    const float place = (centre(boxes_[item], axis) - low) * scale;
    // Of centres so close that `scale` is infinite, place may be no number.
    return place > 0 ? static_cast<int>(std::min(place, static_cast<float>(kBins - 1))) : 0;
  };
  std::array<Bin, kBins> bins;
  for (uint32_t i = range.first; i < range.end; ++i)
    bins[static_cast<size_t>(binOf(order_[i]))].add({boxes_[order_[i]], 1});
  std::array<float, kBins> above{};  // cost of the bins from this one on
  Bin sum;
  for (int i = kBins - 1; i > 0; --i) {
    sum.add(bins[static_cast<size_t>(i)]);
    above[static_cast<size_t>(i)] = sum.cost();
  }
  sum = {};
  int best = 1;
  float least = 3e38f;
  for (int i = 1; i < kBins; ++i) {
    sum.add(bins[static_cast<size_t>(i - 1)]);
    const float cost = sum.cost() + above[static_cast<size_t>(i)];
    if (!(cost < least)) continue;
    least = cost;
    best = i;
  }
  const auto second = std::partition(order_.begin() + range.first, order_.begin() + range.end,
                                     [&](uint32_t item) { return binOf(item) < best; });
  return static_cast<uint32_t>(second - order_.begin());
}

/// Children lie behind their parents, so that going backwards meets them first.
int BvhBuilder::deepestStack() {
  needs_.assign(nodes_.size(), 0);
  for (size_t n = nodes_.size(); n-- > 0;) {
    int children = 0;
    while (children < 4 && nodes_[n].child[children] != glsl::ray_no_child) ++children;
    int need = children;
    for (int i = 0; i < children; ++i) {
      const uint32_t child = nodes_[n].child[i];
      if (!glsl::ray_is_leaf(child)) need = std::max(need, children - 1 - i + needs_[child]);
    }
    needs_[n] = need;
  }
  return needs_.front();
}

}  // namespace limn::rays
