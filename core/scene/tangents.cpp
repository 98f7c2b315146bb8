#include "core/scene/tangents.h"

#include <algorithm>
#include <cmath>

namespace limn::scene {
namespace {

glm::dvec3 unitOrZero(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : glm::dvec3(0);
}

glm::dvec3 anyPerpendicular(const glm::dvec3& n) {
  const glm::dvec3 axis = std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(axis - glm::dot(axis, n) * n);
}

struct Sum {
  glm::dvec3 direction{0};
  double winding = 0;  ///< > 0: u, v and the normal are right-handed
};

/// Adds what one triangle says about the tangents of its three vertices.
void accumulate(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                std::span<const glm::vec2> uvs, const uint32_t* corner, std::vector<Sum>& sums) {
  const glm::dvec3 p[3] = {positions[corner[0]], positions[corner[1]], positions[corner[2]]};
  const glm::dvec2 t[3] = {uvs[corner[0]], uvs[corner[1]], uvs[corner[2]]};
  const glm::dvec2 s = t[1] - t[0], r = t[2] - t[0];
  const double area = s.x * r.y - r.x * s.y;
  if (area == 0) return;
  const double sign = area > 0 ? 1 : -1;
  const glm::dvec3 direction = unitOrZero(sign * (r.y * (p[1] - p[0]) - s.y * (p[2] - p[0])));
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 a = unitOrZero(p[(i + 1) % 3] - p[i]), b = unitOrZero(p[(i + 2) % 3] - p[i]);
    const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    const glm::dvec3 n(normals[corner[i]]);
    Sum& sum = sums[corner[i]];
    sum.direction += angle * unitOrZero(direction - glm::dot(direction, n) * n);
    sum.winding += sign * angle;
  }
}

}  // namespace

std::vector<glm::vec4> generateTangents(std::span<const glm::vec3> positions,
                                        std::span<const glm::vec3> normals, std::span<const glm::vec2> uvs,
                                        std::span<const uint32_t> indices) {
  std::vector<Sum> sums(positions.size());
  for (std::size_t i = 0; !uvs.empty() && i + 2 < indices.size(); i += 3)
    accumulate(positions, normals, uvs, &indices[i], sums);
  std::vector<glm::vec4> tangents(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const glm::dvec3 n(normals[i]);
    glm::dvec3 t = unitOrZero(sums[i].direction);
    t = unitOrZero(t - glm::dot(t, n) * n);
    const bool usable = glm::length(t) > 0.5;
    // v grows down the picture and the normal map's green points up it (glTF 2.0, 3.8.3 and 3.9.3).
    tangents[i] = glm::vec4(usable ? t : anyPerpendicular(n), usable && sums[i].winding > 0 ? -1.f : 1.f);
  }
  return tangents;
}

std::vector<glm::vec3> smoothNormals(std::span<const glm::vec3> positions,
                                     std::span<const uint32_t> indices) {
  std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0));
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const glm::dvec3 a(positions[indices[i]]), b(positions[indices[i + 1]]), c(positions[indices[i + 2]]);
    const glm::dvec3 n = glm::cross(b - a, c - a);
    for (std::size_t corner = 0; corner < 3; ++corner) sums[indices[i + corner]] += n;
  }
  std::vector<glm::vec3> normals(positions.size());
  std::transform(sums.begin(), sums.end(), normals.begin(),
                 [](const glm::dvec3& n) { return glm::vec3(unitOrZero(n)); });
  return normals;
}

glm::vec3 triangleNormal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::dvec3 n = unitOrZero(glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a)));
  return n == glm::dvec3(0) ? glm::vec3(0, 1, 0) : glm::vec3(n);
}

}  // namespace limn::scene
