#include "assets/generator/shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace limn::assets {
namespace {

constexpr float kPi = glm::pi<float>();

void addGridIndices(Mesh& mesh, std::uint32_t base, int nu, int nv) {
  const auto at = [&](int i, int j) { return base + static_cast<std::uint32_t>(j * (nu + 1) + i); };
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const glm::vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    const glm::vec3 area = glm::cross(q - p, r - p);
    const float longest = std::max({glm::dot(q - p, q - p), glm::dot(r - p, r - p), glm::dot(r - q, r - q)});
    if (glm::dot(area, area) > 1e-10f * longest * longest) mesh.indices.insert(mesh.indices.end(), {a, b, c});
  };
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) {
      add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
}

glm::vec3 surfaceNormal(const SurfaceFunction& position, glm::vec2 uv) {
  constexpr float h = 1e-3f;
  // At a pole one derivative vanishes: the normal a little further in stands for it.
  for (const float inset : {0.0f, 0.002f, 0.01f}) {
    const glm::vec2 c = glm::mix(uv, glm::vec2(0.5f), inset);
    const glm::vec2 lo = glm::max(c - h, glm::vec2(0)), hi = glm::min(c + h, glm::vec2(1));
    const glm::vec3 du = position({hi.x, c.y}) - position({lo.x, c.y});
    const glm::vec3 dv = position({c.x, hi.y}) - position({c.x, lo.y});
    const glm::vec3 n = glm::cross(du, dv);
    const float scale = std::max(glm::dot(du, du), glm::dot(dv, dv));
    if (glm::dot(n, n) > 1e-6f * scale * scale) return glm::normalize(n);
  }
  return {0, 1, 0};
}

template <class V>
std::vector<V> catmullRom(std::span<const V> points, int perSegment) {
  std::vector<V> result;
  const int n = static_cast<int>(points.size());
  for (int i = 0; i + 1 < n; ++i) {
    const V a = i > 0 ? points[i - 1] : points[0] * 2.0f - points[1], b = points[i], c = points[i + 1];
    const V d = i + 2 < n ? points[i + 2] : c * 2.0f - b;
    for (int k = 0; k < perSegment; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(perSegment);
      result.push_back(0.5f * (2.0f * b + (c - a) * t + (2.0f * a - 5.0f * b + 4.0f * c - d) * (t * t) +
                               (3.0f * b - a - 3.0f * c + d) * (t * t * t)));
    }
  }
  result.push_back(points.back());
  return result;
}

struct ProfilePoint {
  glm::vec2 position, normal;
  float along;         ///< length so far
  bool joinsPrevious;  ///< false at the second copy of a crease
};

/// Splits a polyline at its creases; normals are the direction of travel turned clockwise.
std::vector<ProfilePoint> creased(std::span<const glm::vec2> line, float creaseDegrees, bool closed) {
  const int n = static_cast<int>(line.size()), edges = closed ? n : n - 1;
  std::vector<glm::vec2> normal(static_cast<std::size_t>(edges));
  for (int i = 0; i < edges; ++i) {
    const glm::vec2 d = line[(i + 1) % n] - line[i];
    normal[i] = glm::normalize(glm::vec2(d.y, -d.x));
  }
  const float limit = std::cos(glm::radians(creaseDegrees));
  std::vector<ProfilePoint> result;
  float along = 0;
  for (int i = 0; i < (closed ? n + 1 : n); ++i) {
    if (i > 0) along += glm::distance(line[i % n], line[i - 1]);
    const bool first = !closed && i == 0, last = !closed && i == n - 1;
    const glm::vec2 before = normal[first ? 0 : (i + edges - 1) % edges];
    const glm::vec2 after = normal[last ? edges - 1 : i % edges];
    if (glm::dot(before, after) >= limit) {
      result.push_back({line[i % n], glm::normalize(before + after), along, true});
    } else {
      result.push_back({line[i % n], before, along, true});
      result.push_back({line[i % n], after, along, false});
    }
  }
  return result;
}

}  // namespace

Mesh surface(int nu, int nv, const SurfaceFunction& position) {
  Mesh mesh;
  for (int j = 0; j <= nv; ++j) {
    for (int i = 0; i <= nu; ++i) {
      const glm::vec2 uv(static_cast<float>(i) / static_cast<float>(nu),
                         static_cast<float>(j) / static_cast<float>(nv));
      mesh.positions.push_back(position(uv));
      mesh.normals.push_back(surfaceNormal(position, uv));
      mesh.uvs.push_back(uv);
    }
  }
  addGridIndices(mesh, 0, nu, nv);
  return mesh;
}

Mesh quad(glm::vec3 centre, glm::vec3 right, glm::vec3 up) {
  Mesh mesh;
  mesh.positions = {centre - right - up, centre + right - up, centre + right + up, centre - right + up};
  mesh.normals.assign(4, glm::normalize(glm::cross(right, up)));
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

Mesh ground(float halfWidth, float halfDepth, float tile) {
  Mesh mesh = quad({0, 0, 0}, {halfWidth, 0, 0}, {0, 0, -halfDepth});
  scaleUv(mesh, glm::vec2(2 * halfWidth, 2 * halfDepth) / tile);
  return mesh;
}

Mesh backdrop(float halfWidth, float front, float back, float height, float tile) {
  const float radius = height / 2, flat = front + back - radius, bend = radius * kPi / 2;
  const float length = flat + bend + height - radius;
  // The bend gets its own rows; the flat parts need one quad each.
  std::vector<float> rows = {0, flat};
  for (int i = 1; i <= 24; ++i) rows.push_back(flat + bend * static_cast<float>(i) / 24);
  rows.push_back(length);
  Mesh mesh;
  for (const float s : rows) {
    const float angle = glm::clamp((s - flat) / radius, 0.0f, kPi / 2);
    const float straight = std::max(0.0f, s - flat - bend);
    const glm::vec3 at(0, radius * (1 - std::cos(angle)) + straight,
                       front - std::min(s, flat) - radius * std::sin(angle));
    for (const float x : {-halfWidth, halfWidth}) {
      mesh.positions.push_back(at + glm::vec3(x, 0, 0));
      mesh.normals.emplace_back(0, std::cos(angle), std::sin(angle));
      mesh.uvs.push_back(glm::vec2(x, -s) / tile);
    }
  }
  addGridIndices(mesh, 0, 1, static_cast<int>(rows.size()) - 1);
  return mesh;
}

Mesh box(glm::vec3 centre, glm::vec3 halfSize) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 normal(0), right(0), up(0);
      normal[axis] = side * halfSize[axis];
      right[(axis + 1) % 3] = side * halfSize[(axis + 1) % 3];
      up[(axis + 2) % 3] = halfSize[(axis + 2) % 3];
      Mesh face = quad(centre + normal, right, up);
      scaleUv(face, 2.0f * glm::vec2(halfSize[(axis + 1) % 3], halfSize[(axis + 2) % 3]));
      append(mesh, face);
    }
  }
  return mesh;
}

Mesh roundedBox(glm::vec3 halfSize, float radius, int segments) {
  const glm::vec3 core = halfSize - radius;
  const int n = 2 * segments + 1;
  // Along each side: a quarter turn in two halves of 45 degrees, the flat part between them.
  const auto direction = [&](int i) {
    const int k = i <= segments ? i : i - 1;
    return std::tan((static_cast<float>(k) / static_cast<float>(segments) - 1.0f) * kPi / 4);
  };
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      const auto base = static_cast<std::uint32_t>(mesh.positions.size());
      for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
          glm::vec3 d(0), corner(0);
          d[axis] = side;
          d[(axis + 1) % 3] = side * direction(i);
          d[(axis + 2) % 3] = direction(j);
          corner[axis] = side * core[axis];
          corner[(axis + 1) % 3] = (i <= segments ? -side : side) * core[(axis + 1) % 3];
          corner[(axis + 2) % 3] = (j <= segments ? -1.0f : 1.0f) * core[(axis + 2) % 3];
          mesh.normals.push_back(glm::normalize(d));
          mesh.positions.push_back(corner + radius * mesh.normals.back());
          mesh.uvs.emplace_back(static_cast<float>(i) / static_cast<float>(n),
                                static_cast<float>(j) / static_cast<float>(n));
        }
      }
      addGridIndices(mesh, base, n, n);
    }
  }
  return mesh;
}

Mesh sphere(float radius, int rings) {
  Mesh mesh;
  for (int j = 0; j <= rings; ++j) {
    const float theta = kPi * static_cast<float>(j) / static_cast<float>(rings);
    for (int i = 0; i <= 2 * rings; ++i) {
      const float phi = kPi * static_cast<float>(i) / static_cast<float>(rings);
      const glm::vec3 n(std::sin(theta) * std::cos(phi), -std::cos(theta), -std::sin(theta) * std::sin(phi));
      mesh.positions.push_back(radius * n);
      mesh.normals.push_back(n);
      mesh.uvs.emplace_back(static_cast<float>(i) / static_cast<float>(2 * rings),
                            1 - static_cast<float>(j) / static_cast<float>(rings));
    }
  }
  addGridIndices(mesh, 0, 2 * rings, rings);
  return mesh;
}

Mesh capsule(float bottomRadius, float topRadius, float length, int segments) {
  // The profile of two spheres and their common tangent cone.
  const float tilt = std::asin(glm::clamp((bottomRadius - topRadius) / length, -1.0f, 1.0f));
  std::vector<glm::vec2> profile;
  for (int i = 0; i <= segments; ++i) {
    const float a = glm::mix(-kPi / 2, tilt, static_cast<float>(i) / static_cast<float>(segments));
    profile.emplace_back(bottomRadius * std::cos(a), bottomRadius * std::sin(a));
  }
  for (int i = 0; i <= segments; ++i) {
    const float a = glm::mix(tilt, kPi / 2, static_cast<float>(i) / static_cast<float>(segments));
    profile.emplace_back(topRadius * std::cos(a), length + topRadius * std::sin(a));
  }
  profile.front().x = profile.back().x = 0;
  return lathe(profile, 2 * segments, 60);
}

Mesh torus(float majorRadius, float minorRadius, int majorSegments, int minorSegments) {
  return surface(majorSegments, minorSegments, [&](glm::vec2 uv) {
    const float a = 2 * kPi * uv.x, b = 2 * kPi * uv.y, r = majorRadius + minorRadius * std::cos(b);
    return glm::vec3(r * std::cos(a), minorRadius * std::sin(b), -r * std::sin(a));
  });
}

Mesh lathe(std::span<const glm::vec2> profile, int segments, float creaseDegrees) {
  const std::vector<ProfilePoint> points = creased(profile, creaseDegrees, false);
  Mesh mesh;
  for (std::size_t j = 0; j < points.size(); ++j) {
    const ProfilePoint& point = points[j];
    for (int i = 0; i <= segments; ++i) {
      const float s = static_cast<float>(i % segments) / static_cast<float>(segments);
      const glm::vec3 out(std::cos(2 * kPi * s), 0, -std::sin(2 * kPi * s));
      mesh.positions.push_back(out * point.position.x + glm::vec3(0, point.position.y, 0));
      mesh.normals.push_back(glm::normalize(out * point.normal.x + glm::vec3(0, point.normal.y, 0)));
      mesh.uvs.emplace_back(static_cast<float>(i) / static_cast<float>(segments),
                            1 - point.along / points.back().along);
    }
    if (j > 0 && point.joinsPrevious)
      addGridIndices(mesh, static_cast<std::uint32_t>((j - 1) * (segments + 1)), segments, 1);
  }
  return mesh;
}

Mesh tube(std::span<const glm::vec3> path, std::span<const float> radii, int segments, bool caps) {
  const int n = static_cast<int>(path.size());
  Mesh mesh;
  glm::vec3 tangent = glm::normalize(path[1] - path[0]);
  glm::vec3 side = glm::normalize(
      glm::cross(tangent, std::abs(tangent.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
  float along = 0;
  for (int j = 0; j < n; ++j) {
    tangent = glm::normalize(path[std::min(j + 1, n - 1)] - path[std::max(j - 1, 0)]);
    side = glm::normalize(side - tangent * glm::dot(side, tangent));  // parallel transport
    const glm::vec3 other = glm::cross(tangent, side);
    if (j > 0) along += glm::distance(path[j], path[j - 1]);
    const float run = glm::distance(path[std::min(j + 1, n - 1)], path[std::max(j - 1, 0)]);
    const float slope = (radii[std::min(j + 1, n - 1)] - radii[std::max(j - 1, 0)]) / run;
    for (int i = 0; i <= segments; ++i) {
      const float a = 2 * kPi * static_cast<float>(i % segments) / static_cast<float>(segments);
      const glm::vec3 out = std::cos(a) * side + std::sin(a) * other;
      mesh.positions.push_back(path[j] + radii[j] * out);
      mesh.normals.push_back(glm::normalize(out - slope * tangent));
      mesh.uvs.emplace_back(static_cast<float>(i) / static_cast<float>(segments), along);
    }
  }
  addGridIndices(mesh, 0, segments, n - 1);
  for (const int end : {0, n - 1}) {
    if (!caps || radii[end] <= 0) continue;
    const glm::vec3 outward = glm::normalize(end == 0 ? path[0] - path[1] : path[end] - path[end - 1]);
    const auto centre = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(path[end]);
    for (int i = 0; i <= segments; ++i)
      mesh.positions.push_back(mesh.positions[static_cast<std::size_t>(end * (segments + 1) + i)]);
    mesh.normals.resize(mesh.positions.size(), outward);
    mesh.uvs.resize(mesh.positions.size(), glm::vec2(0.5f));
    for (int i = 0; i < segments; ++i) {
      const auto a = centre + 1 + static_cast<std::uint32_t>(end == 0 ? i + 1 : i);
      const auto b = centre + 1 + static_cast<std::uint32_t>(end == 0 ? i : i + 1);
      mesh.indices.insert(mesh.indices.end(), {centre, a, b});
    }
  }
  return mesh;
}

Mesh extrude(std::span<const glm::vec2> outline, glm::vec2 hub, float depth, float creaseDegrees) {
  Mesh mesh;
  const std::vector<ProfilePoint> points = creased(outline, creaseDegrees, true);
  for (std::size_t j = 0; j < points.size(); ++j) {
    const auto at = static_cast<std::uint32_t>(mesh.positions.size());
    for (const float z : {0.0f, depth}) {
      mesh.positions.emplace_back(points[j].position, z);
      mesh.normals.emplace_back(points[j].normal, 0);
      mesh.uvs.emplace_back(points[j].along, z);
    }
    if (j > 0 && points[j].joinsPrevious)
      mesh.indices.insert(mesh.indices.end(), {at - 2, at, at + 1, at - 2, at + 1, at - 1});
  }
  for (const float z : {0.0f, depth}) {
    const auto centre = static_cast<std::uint32_t>(mesh.positions.size());
    const auto n = static_cast<std::uint32_t>(outline.size());
    mesh.positions.emplace_back(hub, z);
    for (const glm::vec2& p : outline) mesh.positions.emplace_back(p, z);
    for (std::uint32_t i = centre; i < centre + n + 1; ++i) {
      mesh.normals.emplace_back(0, 0, z > 0 ? 1 : -1);
      mesh.uvs.emplace_back(mesh.positions[i].x, mesh.positions[i].y);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = centre + 1 + i, b = centre + 1 + (i + 1) % n;
      mesh.indices.insert(mesh.indices.end(), {centre, z > 0 ? a : b, z > 0 ? b : a});
    }
  }
  return mesh;
}

std::vector<glm::vec2> spline(std::span<const glm::vec2> points, int perSegment) {
  return catmullRom(points, perSegment);
}
std::vector<glm::vec3> spline(std::span<const glm::vec3> points, int perSegment) {
  return catmullRom(points, perSegment);
}

}  // namespace limn::assets
