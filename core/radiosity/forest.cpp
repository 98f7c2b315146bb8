#include "core/radiosity/forest.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace limn::radiosity {
namespace {

/// Squared radius of the disc of an element above the leaves, over its area, at most. Elements side by side
/// in a square grid have cells of area A; a point between four of them lies half a diagonal, sqrt(A/2), from
/// each. Discs of this radius are the smallest that leave no gap; larger ones would fatten outlines.
constexpr float kDiscPerArea = 0.5f;

/// A rotation without any special relation to the axes: by 1 radian about (1, 2, 3).
const glm::mat3& turn() {
  static const glm::mat3 matrix = [] {
    const glm::dvec3 a = glm::normalize(glm::dvec3(1, 2, 3));
    const double c = std::cos(1.0), s = std::sin(1.0);
    glm::dmat3 m;
    for (int column = 0; column < 3; ++column) {
      glm::dvec3 e(0);
      e[column] = 1;
      m[column] = c * e + s * glm::cross(a, e) + (1 - c) * glm::dot(a, e) * a;
    }
    return glm::mat3(m);
  }();
  return matrix;
}

uint32_t quarter(uint32_t count) {
  return (count + 3) / 4;
}

/// Orders members [first, first + count) so that every run of four, sixteen, ... lies together: halves along
/// the longest axis, cut at multiples of the largest power of four that is smaller.
void sortTree(std::span<uint32_t> members, std::span<const glm::vec3> positions) {
  if (members.size() <= 4) return;
  size_t part = 4;
  while (4 * part < members.size()) part *= 4;
  const auto halve = [&](std::span<uint32_t> range, size_t cut) {
    if (cut >= range.size()) return;
    glm::vec3 low(positions[range[0]]), high(low);
    for (const uint32_t m : range) {
      low = glm::min(low, positions[m]);
      high = glm::max(high, positions[m]);
    }
    const glm::vec3 size = high - low;
    // Rounding must decide neither between the axes of a sphere,
    const float longest = 0.99f * std::max({size.x, size.y, size.z});
    const int axis = size.x >= longest ? 0 : size.y >= longest ? 1 : 2;
    // nor between points of a regular mesh that lie level with each other.
    const auto place = [&](uint32_t m) { return std::floor(positions[m][axis] * 0x1p16f + 0.5f); };
    std::nth_element(
        range.begin(), range.begin() + static_cast<std::ptrdiff_t>(cut), range.end(),
        [&](uint32_t a, uint32_t b) { return place(a) != place(b) ? place(a) < place(b) : a < b; });
  };
  const size_t half = members.size() > 2 * part ? 2 * part : part;
  halve(members, half);
  halve(members.first(std::min(half, members.size())), part);
  if (members.size() > half) halve(members.subspan(half), part);
  for (size_t first = 0; first < members.size(); first += part)
    sortTree(members.subspan(first, std::min(part, members.size() - first)), positions);
}

}  // namespace

ElementSpace::ElementSpace(const glm::vec3& centre, float radius)
    : centre_(centre), radius_(radius > 0 ? radius : 1) {}
glm::vec3 ElementSpace::point(const glm::vec3& world) const {
  return turn() * ((world - centre_) / radius_);
}
glm::vec3 ElementSpace::worldPoint(const glm::vec3& point) const {
  return centre_ + radius_ * worldDirection(point);
}
glm::vec3 ElementSpace::direction(const glm::vec3& world) const {
  return turn() * world;
}
glm::vec3 ElementSpace::worldDirection(const glm::vec3& direction) const {
  return glm::transpose(turn()) * direction;
}

Forest::Forest(const Surfels& surfels, LeafShape shape) : shape_(shape), leafOf_(surfels.size()) {
  std::vector<std::vector<uint32_t>> clusters(surfels.clusterCount);
  for (uint32_t i = 0; i < surfels.size(); ++i) clusters[surfels.clusters[i]].push_back(i);
  // A cluster's elements per level, down to one; a level's groups hold them four by four.
  levels_.assign(1, {});
  for (auto& members : clusters) {
    sortTree(members, surfels.positions);
    auto count = static_cast<uint32_t>(members.size());
    for (size_t level = 0;; ++level, count = quarter(count)) {
      if (level == levels_.size()) levels_.emplace_back();
      levels_[level].count += quarter(count);
      if (count == 1) break;
    }
  }
  for (size_t level = 1; level < levels_.size(); ++level)
    levels_[level].first = levels_[level - 1].first + levels_[level - 1].count;
  groups_.resize(levels_.back().first + levels_.back().count);
  parents_.assign(groups_.size(), glsl::no_link);
  std::vector<uint32_t> next(levels_.size());
  for (size_t level = 0; level < levels_.size(); ++level) next[level] = levels_[level].first;
  for (const auto& members : clusters) {
    if (members.empty()) continue;
    for (uint32_t i = 0; i < members.size(); ++i) leafOf_[members[i]] = 4 * next[0] + i;
    const uint32_t object = surfels.objects[members.front()];
    auto count = static_cast<uint32_t>(members.size());
    for (size_t level = 0;; ++level, count = quarter(count)) {
      for (uint32_t g = 0; g < quarter(count); ++g) {
        glsl::ElementGroup& group = groups_[next[level] + g];
        // The groups of the level below have been placed: they end where its next cluster begins.
        const uint32_t below = level > 0 ? next[level - 1] - count + 4 * g : glsl::no_link;
        group.children = below;
        group.lanes = std::min(count - 4 * g, 4u);
        group.backs = surfels.backless[object] ? 0u : 1u;
        group.object = object;
        for (uint32_t lane = 0; level > 0 && lane < group.lanes; ++lane)
          parents_[below + lane] = 4 * (next[level] + g) + lane;
      }
      next[level] += quarter(count);
      if (count > 1) continue;
      roots_.push_back(next[level] - 1);
      break;
    }
  }
  for (uint32_t i = 0; i < surfels.size(); ++i) {
    glsl::ElementGroup& group = groups_[leafOf_[i] / 4];
    group.area[static_cast<int>(leafOf_[i] % 4)] = surfels.areas[i];
    group.disc[static_cast<int>(leafOf_[i] % 4)] = surfels.discs[i];
  }
  placeTriangles(surfels);
  refit(surfels);
}

void Forest::placeTriangles(const Surfels& surfels) {
  vertices_.assign(leafSlots(), glm::vec3(0));
  firstTriangle_.assign(leafSlots() + 1, 0);
  const auto ownerOf = [&](size_t triangle) {
    const auto leaf = [&](size_t k) { return leafOf_[surfels.triangles[triangle + k]]; };
    return std::min({leaf(0), leaf(1), leaf(2)});
  };
  for (size_t t = 0; t < surfels.triangles.size(); t += 3) ++firstTriangle_[ownerOf(t) + 1];
  std::partial_sum(firstTriangle_.begin(), firstTriangle_.end(), firstTriangle_.begin());
  triangles_.resize(surfels.triangles.size());
  std::vector<uint32_t> next(firstTriangle_.begin(), firstTriangle_.end());
  for (size_t t = 0; t < surfels.triangles.size(); t += 3) {
    const size_t place = size_t{3} * next[ownerOf(t)]++;
    for (size_t k = 0; k < 3; ++k) triangles_[place + k] = leafOf_[surfels.triangles[t + k]];
  }
  if (shape_ == LeafShape::triangles) packTriangles();
}

void Forest::packTriangles() {
  firstPack_.assign(1, 0);
  for (uint32_t g = 0; g < levels_.front().count; ++g) {
    const uint32_t count = firstTriangle_[4 * g + 4] - firstTriangle_[4 * g];
    firstPack_.push_back(firstPack_.back() + quarter(count));
  }
  packs_.assign(firstPack_.back(), {});
  for (uint32_t leaf = 0; leaf < leafSlots(); ++leaf)
    for (uint32_t t = firstTriangle_[leaf]; t < firstTriangle_[leaf + 1]; ++t) {
      const uint32_t place = t - firstTriangle_[leaf / 4 * 4];
      TrianglePack& pack = packs_[firstPack_[leaf / 4] + place / 4];
      for (uint32_t k = 0; k < 3; ++k) pack.leaves[k][static_cast<int>(place % 4)] = triangles_[3 * t + k];
      pack.owners[static_cast<int>(place % 4)] = 1u << leaf % 4;
    }
}

void Forest::refit(const Surfels& surfels) {
  const auto &positions = surfels.positions, &normals = surfels.normals;
  tbb::parallel_for(size_t{0}, leafOf_.size(), [&](size_t i) {
    glsl::ElementGroup& group = groups_[leafOf_[i] / 4];
    const int lane = static_cast<int>(leafOf_[i] % 4);
    group.x[lane] = positions[i].x;
    group.y[lane] = positions[i].y;
    group.z[lane] = positions[i].z;
    group.nx[lane] = normals[i].x;
    group.ny[lane] = normals[i].y;
    group.nz[lane] = normals[i].z;
    vertices_[leafOf_[i]] = surfels.vertices[i];
  });
  if (shape_ == LeafShape::triangles)
    tbb::parallel_for(0u, levels_.front().count, [&](uint32_t g) {
      refitPacks(g);
      for (uint32_t leaf = 4 * g; leaf < 4 * g + 4; ++leaf) boundTriangles(leaf);
    });
  for (size_t level = 1; level < levels_.size(); ++level)
    tbb::parallel_for(levels_[level].first, levels_[level].first + levels_[level].count,
                      [&](uint32_t g) { refitGroup(groups_[g]); });
}

void Forest::refitPacks(uint32_t group) {
  for (uint32_t p = firstPack_[group]; p < firstPack_[group + 1]; ++p)
    for (int k = 0; k < 3; ++k)
      for (int lane = 0; lane < 4; ++lane) {
        const glm::vec3& corner = vertices_[packs_[p].leaves[k][lane]];
        packs_[p].x[k][lane] = corner.x;
        packs_[p].y[k][lane] = corner.y;
        packs_[p].z[k][lane] = corner.z;
      }
}

void Forest::boundTriangles(uint32_t leaf) {
  glsl::ElementGroup& group = groups_[leaf / 4];
  const int lane = static_cast<int>(leaf % 4);
  const glm::vec3 position(group.x[lane], group.y[lane], group.z[lane]),
      normal(group.nx[lane], group.ny[lane], group.nz[lane]);
  float radius = 0, spread = 0;
  for (uint32_t t = firstTriangle_[leaf]; t < firstTriangle_[leaf + 1]; ++t) {
    const auto corner = [&](uint32_t k) { return vertices_[triangles_[3 * t + k]]; };
    const glm::vec3 across = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    const float area = glm::length(across);
    if (area == 0) continue;
    radius = std::max(radius, std::abs(glm::dot(corner(0) - position, across / area)));
    spread = std::max(spread, glm::length(across / area - normal));
  }
  group.radius[lane] = radius;
  group.spread[lane] = std::min(spread, 2.f);
}

void Forest::refitGroup(glsl::ElementGroup& group) {
  for (uint32_t lane = 0; lane < group.lanes; ++lane) {
    const glsl::ElementGroup& from = groups_[group.children + lane];
    const auto count = static_cast<int>(from.lanes);
    float area = 0;
    glm::vec3 position(0), normal(0);
    for (int k = 0; k < count; ++k) {
      area += from.area[k];
      position += from.area[k] * glm::vec3(from.x[k], from.y[k], from.z[k]);
      normal += from.area[k] * glm::vec3(from.nx[k], from.ny[k], from.nz[k]);
    }
    position /= std::max(area, 1e-37f);
    const float length = glm::length(normal);
    normal = length > 1e-4f * area ? normal / length : glm::vec3(from.nx[0], from.ny[0], from.nz[0]);
    float radius = 0, disc = 0, spread = 0;
    for (int k = 0; k < count; ++k) {
      const float offset = glm::length(glm::vec3(from.x[k], from.y[k], from.z[k]) - position);
      radius = std::max(radius, offset + from.radius[k]);
      disc = std::max(disc, offset + from.disc[k]);
      spread = std::max(spread,
                        glm::length(glm::vec3(from.nx[k], from.ny[k], from.nz[k]) - normal) + from.spread[k]);
    }
    const int i = static_cast<int>(lane);
    group.x[i] = position.x, group.y[i] = position.y, group.z[i] = position.z;
    group.nx[i] = normal.x, group.ny[i] = normal.y, group.nz[i] = normal.z;
    group.area[i] = area;
    group.radius[i] = radius;
    group.spread[i] = std::min(spread, 2.f);
    group.disc[i] = std::min(disc, std::sqrt(kDiscPerArea * area));
  }
}

}  // namespace limn::radiosity
