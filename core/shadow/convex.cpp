#include "core/shadow/convex.h"

#include <algorithm>
#include <cmath>

namespace limn::shadow {

using glm::vec3;

std::array<vec3, 8> boxCorners(const scene::Bounds& box) {
  std::array<vec3, 8> corners;
  for (size_t i = 0; i < 8; ++i)
    corners[i] = {(i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
                  (i & 4) != 0 ? box.high.z : box.low.z};
  return corners;
}

void Convex::setBox(const std::array<vec3, 8>& box) {
  constexpr std::array<std::array<size_t, 4>, 6> sides{
      {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
  corners_.clear();
  ends_.clear();
  for (const auto& side : sides) {
    for (const size_t corner : side) corners_.push_back(box[corner]);
    ends_.push_back(corners_.size());
  }
}

void Convex::clip(const glm::vec4& plane) {
  const auto height = [&](const vec3& p) { return glm::dot(vec3(plane), p) + plane.w; };
  const auto kept =
      static_cast<size_t>(std::ranges::count_if(corners_, [&](const vec3& p) { return height(p) >= 0; }));
  if (kept == corners_.size()) return;
  if (kept == 0) {
    corners_.clear();
    ends_.clear();
    return;
  }
  nextCorners_.clear();
  nextEnds_.clear();
  cutCorners_.clear();
  size_t first = 0;
  for (const size_t end : ends_) {
    for (size_t i = first; i < end; ++i) {
      const vec3 a = corners_[i], b = corners_[i + 1 < end ? i + 1 : first];
      const float ha = height(a), hb = height(b);
      if (ha >= 0) nextCorners_.push_back(a);
      if ((ha >= 0) == (hb >= 0)) continue;
      nextCorners_.push_back(a + (ha / (ha - hb)) * (b - a));
      cutCorners_.push_back(nextCorners_.back());
    }
    if (nextEnds_.empty() ? !nextCorners_.empty() : nextCorners_.size() > nextEnds_.back())
      nextEnds_.push_back(nextCorners_.size());
    first = end;
  }
  closeCut(vec3(plane));
  corners_.swap(nextCorners_);
  ends_.swap(nextEnds_);
}

/// Adds the face that a cut leaves: its corners around their middle.
void Convex::closeCut(const vec3& normal) {
  if (cutCorners_.size() < 3) return;
  vec3 middle(0);
  for (const vec3& p : cutCorners_) middle += p / static_cast<float>(cutCorners_.size());
  const vec3 n = glm::abs(normal);
  const vec3 along = n.x <= n.y && n.x <= n.z ? vec3(1, 0, 0) : n.y <= n.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
  const vec3 x = glm::cross(normal, along), y = glm::cross(normal, x) / glm::length(normal);
  const auto angle = [&](const vec3& p) {
    return std::atan2(glm::dot(y, p - middle), glm::dot(x, p - middle));
  };
  std::ranges::sort(cutCorners_, {}, angle);
  nextCorners_.insert(nextCorners_.end(), cutCorners_.begin(), cutCorners_.end());
  nextEnds_.push_back(nextCorners_.size());
}

}  // namespace limn::shadow
