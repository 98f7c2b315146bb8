// Internal to the construction of links: finds which rays from a receiver meet a triangle between leaves.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "core/radiosity/forest.h"
#include "core/radiosity/private/face_discs.h"
#include "core/radiosity/private/float4.h"
#include "glsl/indirect/seen_triangle.glsl"

namespace limn::radiosity {

/// Holds four triangles as seen from a receiver, by offsets of their corners.
struct SeenTriangles {
  Float4 x[3], y[3], z[3];
  Int4 links[3];      ///< of the corners
  uint32_t seen = 0;  ///< a bit for each triangle of which anything may be seen

  /// `lanes` are the leaves of the group whose triangles are wanted, `backs` those of which backs are seen as
  /// well. A receiver sees up to `reach` and `spread` below its horizon (glsl::below_horizon).
  SeenTriangles(const TrianglePack& pack, const glm::vec3& position, const glm::vec3& up, float reach,
                float spread, uint32_t lanes, uint32_t backs) {
    constexpr float grazing = 1e-4f;
    const Int4 owners = loadInts(&pack.owners.x);
    Int4 above{};
    for (int k = 0; k < 3; ++k) {
      x[k] = load(&pack.x[k].x) - position.x;
      y[k] = load(&pack.y[k].x) - position.y;
      z[k] = load(&pack.z[k].x) - position.z;
      const Float4 size = magnitude(x[k]) + magnitude(y[k]) + magnitude(z[k]);
      above |= x[k] * up.x + y[k] * up.y + z[k] * up.z + reach + (spread - grazing) * size > 0.f;
      links[k] = loadInts(&pack.leaves[k].x);
    }
    seen = laneMask(above & ((owners & static_cast<int32_t>(lanes)) != 0));
    if (seen == 0) return;
    const Float4 abx = x[1] - x[0], aby = y[1] - y[0], abz = z[1] - z[0];
    const Float4 acx = x[2] - x[0], acy = y[2] - y[0], acz = z[2] - z[0];
    const Float4 nx = aby * acz - abz * acy, ny = abz * acx - abx * acz, nz = abx * acy - aby * acx;
    // As glsl::seen_triangle has it.
    const Float4 height = x[0] * nx + y[0] * ny + z[0] * nz, length2 = nx * nx + ny * ny + nz * nz;
    const Int4 back = height > 0.f;
    const Int4 across = height * height > 1e-8f * length2 * root(length2);
    seen &= laneMask(across & (~back | ((owners & static_cast<int32_t>(backs)) != 0)));
    for (Int4& link : links) link |= back & static_cast<int32_t>(glsl::link_back);
  }

  glm::vec3 corner(int k, int lane) const { return {x[k][lane], y[k][lane], z[k][lane]}; }
};

/// Holds four triangles in the axes of the faces that their middles lie in front of.
struct TrianglesOnFaces {
  Int4 face;
  Int4 bounded;  ///< true where all corners lie in front of the face, and the bounds hold
  Bounds u{splat(1e30f), splat(-1e30f)}, v{splat(1e30f), splat(-1e30f)};

  explicit TrianglesOnFaces(const SeenTriangles& t) {
    const Float4 x = t.x[0] + t.x[1] + t.x[2], y = t.y[0] + t.y[1] + t.y[2], z = t.z[0] + t.z[1] + t.z[2];
    const Float4 ax = magnitude(x), ay = magnitude(y), az = magnitude(z);
    const Int4 x_major = (ax >= ay) & (ax >= az), y_major = ~x_major & (ay >= az);
    const auto select = [&](Float4 a, Float4 b, Float4 c) { return x_major ? a : y_major ? b : c; };
    const Int4 negative = select(x, y, z) < 0.f;
    face = (x_major ? Int4{} : y_major ? Int4{} + 2 : Int4{} + 4) - negative;
    bounded = ~Int4{};
    for (int k = 0; k < 3; ++k) {
      const Float4 along = select(t.x[k], t.y[k], t.z[k]), major = negative ? -along : along;
      const Float4 across = select(t.y[k], t.z[k], t.x[k]), down = select(t.z[k], t.x[k], t.y[k]);
      bounded &= major > kNearest * (magnitude(across) + magnitude(down));
      const Float4 scale = 1.f / major, at_u = across * scale, at_v = down * scale;
      u = {lesser(u.low, at_u), greater(u.high, at_u)};
      v = {lesser(v.low, at_v), greater(v.high, at_v)};
    }
  }

  /// Corners that lie less in front of a face, as a part of what they lie beside its middle, count as beside
  /// it.
  static constexpr float kNearest = 1e-3f;
};

/// Holds a triangle's corners in the axes of a face: major, column, row.
struct TriangleCorners {
  std::array<glm::vec3, 3> corners;

  TriangleCorners(const SeenTriangles& triangles, int lane, uint32_t face)
      : corners{onFace(triangles.corner(0, lane), face), onFace(triangles.corner(1, lane), face),
                onFace(triangles.corner(2, lane), face)} {}

  /// Returns whether the triangle lies wholly behind the receiver or beyond one of the face's edges.
  bool beside() const {
    const auto all = [&](const auto& test) { return std::ranges::all_of(corners, test); };
    return all([](const glm::vec3& c) { return c.x <= 0; }) ||
           all([](const glm::vec3& c) { return c.y > c.x; }) ||
           all([](const glm::vec3& c) { return -c.y > c.x; }) ||
           all([](const glm::vec3& c) { return c.z > c.x; }) ||
           all([](const glm::vec3& c) { return -c.z > c.x; });
  }

  /// Returns bounds of what lies in front of the face: low column and row, high column and row. They are the
  /// whole face where corners lie beside or behind it.
  Float4 box() const {
    glm::vec2 low(1e30f), high(-1e30f);
    for (const glm::vec3& c : corners) {
      if (!(c.x > TrianglesOnFaces::kNearest * (std::abs(c.y) + std::abs(c.z)))) return Float4{-1, -1, 1, 1};
      const glm::vec2 place = glm::vec2(c.y, c.z) / c.x;
      low = glm::min(low, place);
      high = glm::max(high, place);
    }
    return Float4{low.x, low.y, high.x, high.y};
  }
};

/// Tests the rays (1, u, v) through four bins of a face at once against a triangle.
class TriangleRays {
 public:
  TriangleRays(const SeenTriangles& triangles, int lane, uint32_t face) {
    const auto [a, b, c] = TriangleCorners(triangles, lane, face).corners;
    const glsl::SeenTriangle seen = glsl::seen_triangle(a, b, c);
    weights_[0] = Vector(seen.weight_a);
    weights_[1] = Vector(seen.weight_b);
    weights_[2] = Vector(seen.weight_c);
    normal_ = Vector(seen.normal);
    height2_ = splat(seen.height * seen.height);
    for (int k = 0; k < 3; ++k) links_[k] = Int4{} + triangles.links[k][lane];
  }

  /// Holds what the bins' columns have in common, whatever their rows.
  struct Columns {
    Float4 weights[3], towards, length2;
  };
  Columns columns(Float4 u) const {
    return {
        {weights_[0].along(u), weights_[1].along(u), weights_[2].along(u)}, normal_.along(u), 1.f + u * u};
  }
  /// Fills two bins of a row that begin at `first`, and the two below them in the next row.
  void fillSquare(const Bins& bins, size_t first, size_t row, const Columns& c, Float4 v) const {
    const Float4 a = c.weights[0] + weights_[0].row * v, b = c.weights[1] + weights_[1].row * v,
                 w = c.weights[2] + weights_[2].row * v;
    const Float4 towards = c.towards + normal_.row * v;
    const Int4 outside = (lesser(lesser(a, b), w) < 0.f) | (towards <= 0.f);
    if (laneMask(outside) == 15) return;
    float* const distance2 = bins.distance2 + first;
    uint32_t* const link = bins.links + first;
    Float4 shortest = loadPairs(distance2, distance2 + row);
    const Float4 candidate = missing(outside, height2_ * (c.length2 + v * v) / (towards * towards));
    const Int4 shorter = candidate < shortest;
    if (laneMask(shorter) == 0) return;
    // The corner that is nearest to where the ray meets the triangle.
    const Int4 nearest = (a >= b) & (a >= w) ? links_[0] : b >= w ? links_[1] : links_[2];
    const Int4 links = shorter ? nearest : loadIntPairs(link, link + row);
    shortest = lesser(candidate, shortest);
    storePairs(distance2, distance2 + row, shortest);
    storeIntPairs(link, link + row, links);
  }

 private:
  /// Holds a vector's components, each in all lanes.
  struct Vector {
    Float4 major{}, column{}, row{};
    Vector() = default;
    explicit Vector(const glm::vec3& v) : major(splat(v.x)), column(splat(v.y)), row(splat(v.z)) {}
    Float4 along(Float4 u) const { return major + column * u; }
  };

  Vector weights_[3], normal_;
  Float4 height2_;
  Int4 links_[3];
};

}  // namespace limn::radiosity
