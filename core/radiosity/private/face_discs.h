// Internal to the construction of links: places discs in front of the faces of a receiver's cube map of bins.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

#include "core/radiosity/private/float4.h"
#include "glsl/indirect/direction_bins.glsl"

namespace limn::radiosity {

/// Holds the bins of one receiver: the shortest link of each and its squared length. Whatever is seen below
/// the horizon by more than `margin` (a sine) does not matter.
struct Bins {
  float* distance2 = nullptr;
  uint32_t* links = nullptr;
  glm::vec3 up{0};
  float margin = 1;

  void clear(size_t count) const {
    std::fill_n(distance2, count, std::numeric_limits<float>::infinity());
    std::fill_n(links, count, glsl::no_link);
  }
};

/// Returns a vector in the axes of a face: major, column, row.
inline glm::vec3 onFace(const glm::vec3& v, uint32_t face) {
  const float sign = face % 2 != 0 ? -1.f : 1.f;
  if (face < 2) return {sign * v.x, v.y, v.z};
  if (face < 4) return {sign * v.y, v.z, v.x};
  return {sign * v.z, v.x, v.y};
}

/// Holds up to four siblings at the other ends of links: offsets from the receiver, unit normals, heights
/// along these.
struct Candidates {
  Float4 x, y, z, nx, ny, nz;
  Float4 distance2, height, disc;
  Int4 links;
  Float4 disc2 = disc * disc;
  Float4 fattening = rim / disc2;

  /// The rim of a disc counts as farther than its centre by this fraction of the squared distance.
  static constexpr float rim = 1e-3f;
};

/// Holds where discs begin and end along an axis of a face.
struct Bounds {
  Float4 low, high;
  uint32_t over(float edge) const { return laneMask((low < -edge) | (high > edge)); }
  /// Returns the lanes whose discs do not cross the edge that the offset does not point to.
  uint32_t overNear(Float4 offset) const { return laneMask(offset < 0.f ? high <= 1.f : low >= -1.f); }
};

/// Holds the bounds along both axes.
struct Extent {
  Float4 front;  ///< positive where discs lie wholly in front of the faces; u and v are valid only there
  Bounds u, v;
};

/// Holds discs in the axes of one face each: major, column, row.
struct OnFaces {
  Float4 major, u, v, n_major, n_u, n_v;
  Int4 face;

  /// Uses the axes of the faces that the offsets point to.
  explicit OnFaces(const Candidates& c) {
    const Float4 ax = magnitude(c.x), ay = magnitude(c.y), az = magnitude(c.z);
    const Int4 x_major = (ax >= ay) & (ax >= az), y_major = ~x_major & (ay >= az);
    const auto select = [&](Float4 x, Float4 y, Float4 z) { return x_major ? x : y_major ? y : z; };
    const Float4 along = select(c.x, c.y, c.z), n_along = select(c.nx, c.ny, c.nz);
    const Int4 negative = along < 0.f;
    face = (x_major ? Int4{} : y_major ? Int4{} + 2 : Int4{} + 4) - negative;
    major = magnitude(along);
    n_major = negative ? -n_along : n_along;
    u = select(c.y, c.z, c.x);
    v = select(c.z, c.x, c.y);
    n_u = select(c.ny, c.nz, c.nx);
    n_v = select(c.nz, c.nx, c.ny);
  }
  /// Uses the axes of one face.
  OnFaces(const Candidates& c, int axis, bool negative) : face(Int4{} + (2 * axis + (negative ? 1 : 0))) {
    const Float4 offsets[] = {c.x, c.y, c.z}, normals[] = {c.nx, c.ny, c.nz};
    const int column = (axis + 1) % 3, row = (axis + 2) % 3;
    major = negative ? -offsets[axis] : offsets[axis];
    n_major = negative ? -normals[axis] : normals[axis];
    u = offsets[column], v = offsets[row];
    n_u = normals[column], n_v = normals[row];
  }
  /// Returns the discs in the axes of the neighbouring faces, on the offsets' side of the columns, or of the
  /// rows.
  OnFaces alongU() const { return {u, v, signedMajor(), n_u, n_v, signedNormal(), (face & 6) + 2}; }
  OnFaces alongV() const { return {v, signedMajor(), u, n_v, signedNormal(), n_u, (face & 6) + 4}; }

  Extent extent(const Candidates& c) const {
    const Float4 disc2 = c.disc2;
    const Float4 front = major * major - disc2 * (1.f - n_major * n_major);
    const Float4 scale = 1.f / front;
    // The planes x = place major that touch a disc: (x - place major)^2 = disc^2 (1 + place^2 - (n_x - place
    // n_major)^2).
    const auto bounds = [&](Float4 offset, Float4 normal, Float4 across) -> Bounds {
      const Float4 turned = major * normal - offset * n_major;
      const Float4 inside = major * major + offset * offset - turned * turned - disc2 * across * across;
      const Float4 half = c.disc * root(greater(inside, splat(0)));
      const Float4 middle = major * offset + disc2 * normal * n_major;
      return {(middle - half) * scale, (middle + half) * scale};
    };
    return {front, bounds(u, n_u, n_v), bounds(v, n_v, n_u)};
  }

 private:
  OnFaces(Float4 along, Float4 column, Float4 row, Float4 n_along, Float4 n_column, Float4 n_row, Int4 turned)
      : major(magnitude(along)),
        u(column),
        v(row),
        n_major(along < 0.f ? -n_along : n_along),
        n_u(n_column),
        n_v(n_row),
        face((turned >= 6 ? turned - 6 : turned) - (along < 0.f)) {}
  Int4 negative() const { return (face & 1) != 0; }
  Float4 signedMajor() const { return negative() ? -major : major; }
  Float4 signedNormal() const { return negative() ? -n_major : n_major; }
};

/// Finds where the rays (m, u, v) of a row meet the disc, h ray / (n.ray) within its radius of the centre d:
/// a quadratic inequality in u, (h ray - d n.ray)^2 <= radius^2 (n.ray)^2.
class RowCut {
 public:
  RowCut(const Candidates& c, const OnFaces& on, int k)
      : d_(on.major[k], on.u[k], on.v[k]),
        n_(on.n_major[k], on.n_u[k], on.n_v[k]),
        height_(c.height[k]),
        disc2_(c.disc2[k]),
        slope_(glm::vec3(0, height_, 0) - n_.y * d_),
        square_(glm::dot(slope_, slope_) - disc2_ * n_.y * n_.y) {}
  /// Returns whether the disc's outline is closed towards the rows' ends.
  bool closed() const { return square_ > 0; }
  /// Returns the bounds of four rows.
  Bounds operator()(Float4 v) const {
    const Float4 towards = n_.x + n_.z * v;
    const Float4 x = height_ - towards * d_.x, y = -towards * d_.y, z = height_ * v - towards * d_.z;
    const Float4 half = x * slope_.x + y * slope_.y + z * slope_.z - disc2_ * n_.y * towards;
    const Float4 rest = x * x + y * y + z * z - disc2_ * towards * towards;
    const Float4 inside = half * half - square_ * rest, width = root(greater(inside, splat(0)));
    constexpr float rounding = 1e-4f;
    const Float4 none = splat(-2);
    return {(-half - width) / square_ - rounding, inside < 0.f ? none : (width - half) / square_ + rounding};
  }

 private:
  glm::vec3 d_, n_;
  float height_, disc2_;
  glm::vec3 slope_;
  float square_;
};

/// Tests the rays (1, u, v) through four bins at once against a disc.
class DiscRays {
 public:
  DiscRays(const Candidates& c, const OnFaces& on, int k)
      : n_m_(splat(on.n_major[k])),
        n_u_(splat(on.n_u[k])),
        n_v_(splat(on.n_v[k])),
        height_(splat(c.height[k])),
        disc2_(splat(c.disc2[k])),
        fattening_(splat(c.fattening[k])),
        major_(splat(on.major[k])),
        offset_u_(splat(on.u[k])),
        offset_v_(splat(on.v[k])),
        link_(Int4{} + c.links[k]) {}

  /// Holds what the bins' columns have in common, whatever their rows.
  struct Columns {
    Float4 u, towards, length2;
  };
  Columns columns(Float4 u) const { return {u, n_m_ + n_u_ * u, 1.f + u * u}; }

  /// Fills the four bins of a row that begin at `first`.
  void fill(const Bins& bins, size_t first, const Columns& columns, Float4 v) const {
    Float4 shortest = load(bins.distance2 + first);
    Int4 links = loadInts(bins.links + first);
    meet(columns, v, shortest, links);
    store(bins.distance2 + first, shortest);
    storeInts(bins.links + first, links);
  }
  /// Fills two bins of a row that begin at `first`, and the two below them in the next row.
  void fillSquare(const Bins& bins, size_t first, size_t row, const Columns& columns, Float4 v) const {
    float* const distance2 = bins.distance2 + first;
    uint32_t* const link = bins.links + first;
    Float4 shortest = loadPairs(distance2, distance2 + row);
    Int4 links = loadIntPairs(link, link + row);
    meet(columns, v, shortest, links);
    storePairs(distance2, distance2 + row, shortest);
    storeIntPairs(link, link + row, links);
  }

 private:
  void meet(const Columns& c, Float4 v, Float4& shortest, Int4& links) const {
    // Where a ray meets the disc's plane, and how far from its centre.
    const Float4 t = height_ / (c.towards + n_v_ * v);
    const Float4 miss_m = t - major_, miss_u = t * c.u - offset_u_, miss_v = t * v - offset_v_;
    const Float4 miss2 = miss_m * miss_m + miss_u * miss_u + miss_v * miss_v;
    // Discs of a plane overlap at the same distance: the one whose centre is nearer wins, and not rounding.
    const Float4 distance2 = t * t * (c.length2 + v * v) * (1.f + fattening_ * miss2);
    // Where there is no hit, not a number: which is not less than anything, nor the lesser of two.
    const Float4 candidate = missing((t <= 0.f) | (miss2 > disc2_), distance2);
    links = candidate < shortest ? link_ : links;
    shortest = lesser(candidate, shortest);
  }

  Float4 n_m_, n_u_, n_v_, height_, disc2_, fattening_, major_, offset_u_, offset_v_;
  Int4 link_;
};

}  // namespace limn::radiosity
