#include "core/scene/primitive_tools.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/scene/tangents.h"

namespace limn::scene {
namespace {

template <class T>
void expand(std::vector<T>& values, const std::vector<uint32_t>& indices) {
  if (values.empty()) return;
  std::vector<T> out(indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) out[i] = values[indices[i]];
  values = std::move(out);
}

void flattenTarget(const Primitive& p, MorphTarget& target) {
  target.tangents.clear();
  target.normals.assign(p.positions.size(), glm::vec3(0));
  if (target.positions.empty()) return;
  for (std::size_t i = 0; i + 2 < p.positions.size(); i += 3) {
    const auto moved = [&](std::size_t v) { return p.positions[v] + target.positions[v]; };
    const glm::vec3 delta = triangleNormal(moved(i), moved(i + 1), moved(i + 2)) - p.normals[i];
    for (std::size_t corner = 0; corner < 3; ++corner) target.normals[i + corner] = delta;
  }
}

template <class T>
void appendCopies(std::vector<T>& values, const std::vector<uint32_t>& of) {
  if (values.empty()) return;
  values.reserve(values.size() + of.size());
  for (const uint32_t vertex : of) values.push_back(values[vertex]);
}

/// Of a triangle in the texture: 1 or -1 by its winding, 0 where it has no area.
int windingOf(const std::vector<glm::vec2>& uvs, const uint32_t* corner) {
  const glm::dvec2 s = glm::dvec2(uvs[corner[1]]) - glm::dvec2(uvs[corner[0]]);
  const glm::dvec2 r = glm::dvec2(uvs[corner[2]]) - glm::dvec2(uvs[corner[0]]);
  const double area = s.x * r.y - r.x * s.y;
  return area > 0 ? 1 : area < 0 ? -1 : 0;
}

constexpr double kTolerance = 1e-3;

}  // namespace

void splitFlat(Primitive& p) {
  expand(p.positions, p.indices);
  expand(p.uvs, p.indices);
  expand(p.colours, p.indices);
  expand(p.joints, p.indices);
  expand(p.weights, p.indices);
  for (MorphTarget& target : p.morphTargets) expand(target.positions, p.indices);
  p.tangents.clear();
  p.normals.resize(p.positions.size());
  for (std::size_t i = 0; i + 2 < p.positions.size(); i += 3) {
    const glm::vec3 n = triangleNormal(p.positions[i], p.positions[i + 1], p.positions[i + 2]);
    std::fill_n(p.normals.begin() + static_cast<std::ptrdiff_t>(i), 3, n);
  }
  for (MorphTarget& target : p.morphTargets) flattenTarget(p, target);
  for (std::size_t i = 0; i < p.indices.size(); ++i) p.indices[i] = static_cast<uint32_t>(i);
}

void splitMirrored(Primitive& p) {
  if (p.uvs.empty()) return;
  const std::size_t vertices = p.positions.size();
  std::vector<std::int8_t> winding(vertices, 0);  // of the first triangle that has one
  std::vector<uint32_t> twin(vertices, 0);        // 0: none, which vertex 0 cannot be
  std::vector<uint32_t> copied;
  for (std::size_t i = 0; i + 2 < p.indices.size(); i += 3) {
    const int here = windingOf(p.uvs, &p.indices[i]);
    for (std::size_t corner = i; here != 0 && corner < i + 3; ++corner) {
      const uint32_t vertex = p.indices[corner];
      if (winding[vertex] == 0) winding[vertex] = static_cast<std::int8_t>(here);
      if (winding[vertex] == here) continue;
      if (twin[vertex] == 0) {
        twin[vertex] = static_cast<uint32_t>(vertices + copied.size());
        copied.push_back(vertex);
      }
      p.indices[corner] = twin[vertex];
    }
  }
  appendCopies(p.positions, copied);
  appendCopies(p.normals, copied);
  appendCopies(p.uvs, copied);
  appendCopies(p.colours, copied);
  appendCopies(p.joints, copied);
  appendCopies(p.weights, copied);
  for (MorphTarget& target : p.morphTargets) {
    appendCopies(target.positions, copied);
    appendCopies(target.normals, copied);
  }
}

void computeBounds(Primitive& p) {
  p.bounds = {};
  for (const glm::vec3& v : p.positions) p.bounds.add(v);
  for (MorphTarget& target : p.morphTargets) {
    target.deltaBounds = {};
    target.deltaBounds.add(glm::vec3(0));
    for (const glm::vec3& v : target.positions) target.deltaBounds.add(v);
  }
  std::map<std::uint16_t, Bounds> jointBounds;
  for (std::size_t i = 0; i < p.joints.size(); ++i) {
    for (int k = 0; k < 4; ++k)
      if (p.weights[i][k] > 0) jointBounds[p.joints[i][k]].add(p.positions[i]);
  }
  p.jointBounds.assign(jointBounds.begin(), jointBounds.end());
}

std::optional<Quad> findRectangle(const Primitive& p) {
  if (p.indices.size() != 6 || !p.joints.empty() || !p.morphTargets.empty()) return std::nullopt;
  std::array<glm::dvec3, 6> v;
  for (std::size_t i = 0; i < 6; ++i) v[i] = p.positions[p.indices[i]];
  const auto inOther = [&](std::size_t corner) {
    const std::size_t other = corner < 3 ? 3 : 0;
    return v[corner] == v[other] || v[corner] == v[other + 1] || v[corner] == v[other + 2];
  };
  // The corner of each triangle that is not on the shared diagonal.
  std::array<std::size_t, 2> apex{6, 6};
  for (std::size_t corner = 0; corner < 6; ++corner) {
    if (inOther(corner)) continue;
    if (apex[corner / 3] != 6) return std::nullopt;
    apex[corner / 3] = corner;
  }
  if (apex[0] == 6 || apex[1] == 6) return std::nullopt;
  const glm::dvec3 origin = v[apex[0]], opposite = v[apex[1]];
  const glm::dvec3 u = v[(apex[0] + 1) % 3] - origin, w = v[(apex[0] + 2) % 3] - origin;
  const double lengthU = glm::length(u), lengthW = glm::length(w);
  if (!(lengthU > 0 && lengthW > 0)) return std::nullopt;
  const bool right = std::abs(glm::dot(u, w)) <= kTolerance * lengthU * lengthW;
  const bool closed = glm::length(origin + u + w - opposite) <= kTolerance * std::min(lengthU, lengthW);
  const glm::dvec3 second = glm::cross(v[4] - v[3], v[5] - v[3]);
  if (!right || !closed || glm::dot(second, glm::cross(u, w)) <= 0) return std::nullopt;
  return Quad{glm::vec3(origin + 0.5 * (u + w)), glm::vec3(u), glm::vec3(w)};
}

}  // namespace limn::scene
