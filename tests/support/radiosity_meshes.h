// Meshes for tests and benchmarks of radiosity.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "core/radiosity/forest.h"
#include "core/radiosity/surfels.h"

namespace limn::radiosity {

/// A grid of (n + 1) x (m + 1) points from `point`, a function of (u, v) in [0, 1]^2; `normal` likewise.
/// Front faces where dP/du x dP/dv points.
template <class Point, class Normal>
TriangleMesh gridMesh(int n, int m, const Point& point, const Normal& normal) {
  TriangleMesh mesh;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(n),
                  v = static_cast<float>(j) / static_cast<float>(m);
      mesh.positions.push_back(point(u, v));
      mesh.normals.push_back(normal(u, v));
    }
  const auto at = [&](int i, int j) { return static_cast<uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i)
      mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j),
                                               at(i + 1, j + 1), at(i, j + 1)});
  return mesh;
}

/// A rectangle with the corners origin, origin + u, origin + u + v, origin + v; its front is where u x v
/// points.
inline TriangleMesh rectangleMesh(glm::vec3 origin, glm::vec3 u, glm::vec3 v, int n) {
  const glm::vec3 normal = glm::normalize(glm::cross(u, v));
  return gridMesh(
      n, n, [=](float a, float b) { return origin + a * u + b * v; }, [=](float, float) { return normal; });
}

/// A disc about `centre` in a plane of constant y, facing up (side 1) or down (-1): triangles of about equal
/// size.
inline TriangleMesh discMesh(glm::vec3 centre, float radius, float side, int n) {
  return gridMesh(
      n, n,
      [=](float a, float b) {
        // Concentric squares onto circles (Shirley and Chiu 1997).
        const float x = 2 * a - 1, z = (2 * b - 1) * -side, r = std::max(std::abs(x), std::abs(z));
        if (r == 0) return centre;
        const float angle =
            std::abs(x) >= std::abs(z) ? glsl::pi / 4 * z / x : glsl::pi / 2 - glsl::pi / 4 * x / z;
        const float s = (std::abs(x) >= std::abs(z) ? x : z) * radius;
        return centre + glm::vec3(s * std::cos(angle), 0, s * std::sin(angle));
      },
      [=](float, float) { return glm::vec3(0, side, 0); });
}

/// A sphere of latitudes and longitudes; side -1: seen from within.
inline TriangleMesh sphereMesh(glm::vec3 centre, float radius, int n, float side = 1) {
  const auto direction = [=](float u, float v) {
    const float azimuth = 2 * glsl::pi * u * side, polar = glsl::pi * v;
    return glm::vec3(std::sin(polar) * std::cos(azimuth), -std::cos(polar),
                     -std::sin(polar) * std::sin(azimuth));
  };
  TriangleMesh mesh = gridMesh(
      2 * n, n, [&](float u, float v) { return centre + radius * direction(u == 1 ? 0 : u, v); },
      [&](float u, float v) { return side * direction(u == 1 ? 0 : u, v); });
  // The poles are one point each, whatever the sine of pi rounds to.
  for (size_t i = 0; i <= static_cast<size_t>(2 * n); ++i) {
    mesh.positions[i] = centre + glm::vec3(0, -radius, 0);
    mesh.positions[mesh.positions.size() - 1 - i] = centre + glm::vec3(0, radius, 0);
  }
  return mesh;
}

/// The six faces of the cube [-1, 1]^3, seen from within.
inline TriangleMesh roomMesh(int n) {
  TriangleMesh room;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.f, 1.f}) {
      glm::vec3 origin(-1), u(0), v(0);
      origin[axis] = side;
      u[(axis + 1) % 3] = v[(axis + 2) % 3] = 2;
      const TriangleMesh face = side < 0 ? rectangleMesh(origin, u, v, n) : rectangleMesh(origin, v, u, n);
      const auto first = static_cast<uint32_t>(room.positions.size());
      room.positions.insert(room.positions.end(), face.positions.begin(), face.positions.end());
      room.normals.insert(room.normals.end(), face.normals.begin(), face.normals.end());
      for (const uint32_t i : face.indices) room.indices.push_back(first + i);
    }
  return room;
}

/// The space in which the meshes' bounds have radius 1.
inline ElementSpace spaceOf(const std::vector<TriangleMesh>& meshes) {
  glm::vec3 low(1e30f), high(-1e30f);
  for (const TriangleMesh& mesh : meshes)
    for (const glm::vec3& p : mesh.positions) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  return {0.5f * (low + high), 0.5f * glm::length(high - low)};
}

/// The meshes' surfels in the space of the elements.
inline Surfels surfelsOf(std::vector<TriangleMesh> meshes, float longestEdge = 1e9f) {
  const ElementSpace space = spaceOf(meshes);
  for (TriangleMesh& mesh : meshes) {
    for (glm::vec3& p : mesh.positions) p = space.point(p);
    for (glm::vec3& n : mesh.normals) n = space.direction(n);
  }
  return createSurfels(meshes, longestEdge);
}

}  // namespace limn::radiosity
