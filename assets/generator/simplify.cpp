#include "assets/generator/simplify.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <set>
#include <tuple>

namespace limn::assets {
namespace {

/// Adds a vertex of `from` to `to`.
void copyVertex(const Mesh& from, std::uint32_t v, Mesh& to) {
  const auto copy = [v](const auto& values, auto& copied) {
    if (!values.empty()) copied.push_back(values[v]);
  };
  copy(from.positions, to.positions);
  copy(from.normals, to.normals);
  copy(from.uvs, to.uvs);
  copy(from.tangents, to.tangents);
  copy(from.joints, to.joints);
  copy(from.weights, to.weights);
}

/// Sum of squared distances to planes, weighted by area: v^T a v + 2 b v + c.
struct Quadric {
  glm::dmat3 a{0.0};
  glm::dvec3 b{0};
  double c = 0;

  void addPlane(glm::dvec3 n, double distance, double weight) {
    a += weight * glm::outerProduct(n, n);
    b += weight * distance * n;
    c += weight * distance * distance;
  }
  void add(const Quadric& other) {
    a += other.a;
    b += other.b;
    c += other.c;
  }
  double at(glm::dvec3 v) const { return glm::dot(v, a * v) + 2 * glm::dot(b, v) + c; }
};

/// `from` moves onto `to`; out of date once either has changed.
struct Collapse {
  double cost;
  std::uint32_t from, to, fromVersion, toVersion;
  bool operator<(const Collapse& other) const {  // the cheapest first; ties in a fixed order
    return std::tie(cost, from, to) > std::tie(other.cost, other.from, other.to);
  }
};

class Simplifier {
 public:
  explicit Simplifier(const Mesh& mesh) : mesh_(mesh), indices_(mesh.indices), left_(mesh.triangleCount()) {
    const std::size_t count = mesh.positions.size();
    quadrics_.resize(count);
    versions_.resize(count);
    triangles_.resize(count);
    for (std::size_t t = 0; t < left_; ++t) addTriangle(t);
    lockBorders();
    for (std::uint32_t v = 0; v < count; ++v) offer(v);
  }

  Mesh run(std::size_t triangles) {
    while (left_ > triangles && !queue_.empty()) {
      const Collapse next = queue_.top();
      queue_.pop();
      if (versions_[next.from] == next.fromVersion && versions_[next.to] == next.toVersion &&
          allowed(next.from, next.to))
        apply(next.from, next.to);
    }
    return compacted();
  }

 private:
  glm::dvec3 position(std::uint32_t v) const { return glm::dvec3(mesh_.positions[v]); }
  std::uint32_t& corner(std::size_t triangle, std::size_t k) { return indices_[3 * triangle + k]; }
  std::uint32_t corner(std::size_t triangle, std::size_t k) const { return indices_[3 * triangle + k]; }
  bool has(std::size_t triangle, std::uint32_t v) const {
    return corner(triangle, 0) == v || corner(triangle, 1) == v || corner(triangle, 2) == v;
  }

  void addTriangle(std::size_t t) {
    const glm::dvec3 p = position(corner(t, 0));
    const glm::dvec3 across = glm::cross(position(corner(t, 1)) - p, position(corner(t, 2)) - p);
    const double size = glm::length(across);
    for (std::size_t k = 0; k < 3; ++k) {
      triangles_[corner(t, k)].push_back(t);
      if (size > 0) {
        const glm::dvec3 n = across / size;
        quadrics_[corner(t, k)].addPlane(n, -glm::dot(n, p), size);
      }
    }
  }

  /// Vertices at edges that have no triangle on one side, seams of normals or texture coordinates included.
  void lockBorders() {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t t = 0; t < left_; ++t)
      for (std::size_t k = 0; k < 3; ++k) edges.emplace(corner(t, k), corner(t, (k + 1) % 3));
    locked_.resize(mesh_.positions.size());
    for (const auto& [a, b] : edges)
      if (!edges.count({b, a})) locked_[a] = locked_[b] = true;
  }

  std::set<std::uint32_t> neighbours(std::uint32_t v) const {
    std::set<std::uint32_t> around;
    for (const std::size_t t : triangles_[v])
      for (std::size_t k = 0; k < 3; ++k)
        if (corner(t, k) != v) around.insert(corner(t, k));
    return around;
  }

  /// Queues all collapses of `v`.
  void offer(std::uint32_t v) {
    if (locked_[v]) return;
    for (const std::uint32_t to : neighbours(v)) queue_.push(collapse(v, to));
  }

  Collapse collapse(std::uint32_t from, std::uint32_t to) const {
    Quadric sum = quadrics_[from];
    sum.add(quadrics_[to]);
    return {std::max(sum.at(position(to)), 0.0), from, to, versions_[from], versions_[to]};
  }

  /// Whether the surface stays a surface (the two share exactly the corners opposite their edge) and no
  /// triangle turns over or away from its normals.
  bool allowed(std::uint32_t from, std::uint32_t to) const {
    const std::set<std::uint32_t> a = neighbours(from), b = neighbours(to);
    std::size_t common = 0, sides = 0;
    for (const std::uint32_t v : a) common += b.count(v);
    for (const std::size_t t : triangles_[from]) sides += has(t, to);
    if (common != sides) return false;
    return std::none_of(triangles_[from].begin(), triangles_[from].end(),
                        [&](std::size_t t) { return !has(t, to) && turnsOver(t, from, to); });
  }

  bool turnsOver(std::size_t t, std::uint32_t from, std::uint32_t to) const {
    glm::dvec3 before[3], after[3], normal(0);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = corner(t, k);
      before[k] = position(v);
      after[k] = position(v == from ? to : v);
      normal += glm::dvec3(mesh_.normals[v == from ? to : v]);
    }
    const glm::dvec3 n = glm::cross(before[1] - before[0], before[2] - before[0]);
    const glm::dvec3 m = glm::cross(after[1] - after[0], after[2] - after[0]);
    const double size = glm::length(m);
    return glm::dot(n, m) < 0.2 * glm::length(n) * size || glm::dot(m, normal) <= 0.3 * size;
  }

  void apply(std::uint32_t from, std::uint32_t to) {
    for (const std::size_t t : triangles_[from]) {
      if (has(t, to)) {
        for (std::size_t k = 0; k < 3; ++k)
          if (corner(t, k) != from) std::erase(triangles_[corner(t, k)], t);
        for (std::size_t k = 0; k < 3; ++k) corner(t, k) = to;  // no triangle any more
        --left_;
      } else {
        for (std::size_t k = 0; k < 3; ++k)
          if (corner(t, k) == from) corner(t, k) = to;
        triangles_[to].push_back(t);
      }
    }
    triangles_[from].clear();
    quadrics_[to].add(quadrics_[from]);
    ++versions_[from];
    ++versions_[to];
    offer(to);
    for (const std::uint32_t v : neighbours(to))
      if (!locked_[v]) queue_.push(collapse(v, to));
  }

  /// Without the triangles that lost their area and the vertices that nobody uses.
  Mesh compacted() const {
    Mesh result;
    std::map<std::uint32_t, std::uint32_t> renamed;
    for (std::size_t t = 0; t < indices_.size() / 3; ++t) {
      if (corner(t, 0) == corner(t, 1)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = corner(t, k);
        const auto [it, fresh] = renamed.try_emplace(v, static_cast<std::uint32_t>(result.positions.size()));
        if (fresh) copyVertex(mesh_, v, result);
        result.indices.push_back(it->second);
      }
    }
    return result;
  }

  const Mesh& mesh_;
  std::vector<std::uint32_t> indices_;
  std::size_t left_;
  std::vector<Quadric> quadrics_;
  std::vector<std::uint32_t> versions_;
  std::vector<std::vector<std::size_t>> triangles_;  ///< around each vertex
  std::vector<bool> locked_;
  std::priority_queue<Collapse> queue_;
};

}  // namespace

Mesh welded(const Mesh& mesh) {
  // The two sides of a seam are computed apart and may differ in their last bits.
  const auto key = [&](std::size_t v) {
    const glm::ivec3 p(glm::round(mesh.positions[v] * 1e5f));
    std::vector<int> values{p.x, p.y, p.z};
    for (int i = 0; i < 4; ++i) {
      if (!mesh.joints.empty()) values.push_back(mesh.joints[v][i]);
      if (!mesh.weights.empty()) values.push_back(static_cast<int>(std::lround(mesh.weights[v][i] * 1e3f)));
    }
    return values;
  };
  Mesh result = mesh;
  std::map<std::vector<int>, std::uint32_t> first;
  std::vector<std::uint32_t> renamed;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    renamed.push_back(first.try_emplace(key(v), static_cast<std::uint32_t>(v)).first->second);
  result.indices.clear();
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = renamed[mesh.indices[i]], b = renamed[mesh.indices[i + 1]],
                        c = renamed[mesh.indices[i + 2]];
    if (a != b && b != c && c != a) result.indices.insert(result.indices.end(), {a, b, c});
  }
  computeNormals(result);
  return result;
}

Mesh creased(const Mesh& mesh, float degrees) {
  std::vector<glm::vec3> across;  // of each triangle; length: twice its area
  std::vector<std::vector<std::size_t>> around(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::vec3& p = mesh.positions[mesh.indices[i]];
    across.push_back(
        glm::cross(mesh.positions[mesh.indices[i + 1]] - p, mesh.positions[mesh.indices[i + 2]] - p));
    for (std::size_t k = 0; k < 3; ++k) around[mesh.indices[i + k]].push_back(i / 3);
  }
  const float limit = std::cos(glm::radians(degrees));
  Mesh result;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::uint32_t v = mesh.indices[i];
    const glm::vec3 own = across[i / 3];
    glm::vec3 sum(0);
    for (const std::size_t t : around[v])
      if (glm::dot(across[t], own) >= limit * glm::length(across[t]) * glm::length(own)) sum += across[t];
    copyVertex(mesh, v, result);
    if (glm::length(sum) > 0) result.normals.back() = glm::normalize(sum);
    result.indices.push_back(static_cast<std::uint32_t>(i));
  }
  return result;
}

Mesh simplified(const Mesh& mesh, std::size_t triangles) {
  return Simplifier(mesh).run(triangles);
}

}  // namespace limn::assets
