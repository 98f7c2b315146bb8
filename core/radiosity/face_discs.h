// Internal to the construction of links: discs in front of the faces of a receiver's cube map of bins.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "core/radiosity/float4.h"

namespace limn::radiosity {

/// The bins of one receiver: the shortest link of each and its squared length. What is seen below the horizon
/// by more than `margin` (a sine) does not matter.
struct Bins {
  float* distance2 = nullptr;
  uint32_t* links = nullptr;
  glm::vec3 up{0};
  float margin = 1;
};

/// Up to four siblings at the other ends of links: offsets from the receiver, unit normals, heights along
/// these.
struct Candidates {
  Float4 x, y, z, nx, ny, nz;
  Float4 distance2, height, disc;
  Int4 links;
};

/// A disc in the axes of a face.
struct Disc {
  glm::vec3 offset, normal;
  float height, radius;
  uint32_t link;
};

/// Where discs begin and end along an axis of a face.
struct Bounds {
  Float4 low, high;
  uint32_t over(float edge) const { return laneMask((low < -edge) | (high > edge)); }
  /// Not over the edge that the offset does not point to.
  uint32_t overNear(Float4 offset) const { return laneMask(offset < 0.f ? high <= 1.f : low >= -1.f); }
};

/// The same along both axes.
struct Extent {
  Float4 front;  ///< positive where discs lie wholly in front of the faces; only there u and v hold
  Bounds u, v;
};

/// Offsets and normals in the axes of the faces that the offsets point to: major (not negative), column,
/// row.
struct OnFaces {
  Float4 major, u, v, n_major, n_u, n_v;
  Int4 axis, negative;

  explicit OnFaces(const Candidates& c) {
    const Float4 ax = magnitude(c.x), ay = magnitude(c.y), az = magnitude(c.z);
    const Int4 x_major = (ax >= ay) & (ax >= az), y_major = ~x_major & (ay >= az);
    const auto select = [&](Float4 x, Float4 y, Float4 z) { return x_major ? x : y_major ? y : z; };
    const Float4 along = select(c.x, c.y, c.z), n_along = select(c.nx, c.ny, c.nz);
    axis = x_major ? Int4{} : y_major ? Int4{} + 1 : Int4{} + 2;
    negative = along < 0.f;
    major = magnitude(along);
    n_major = negative ? -n_along : n_along;
    u = select(c.y, c.z, c.x);
    v = select(c.z, c.x, c.y);
    n_u = select(c.ny, c.nz, c.nx);
    n_v = select(c.nz, c.nx, c.ny);
  }
  /// In the axes of the faces next to them on the offsets' side of the columns, or of the rows.
  OnFaces alongU() const { return {u, v, signedMajor(), n_u, n_v, signedNormal(), axis + 1}; }
  OnFaces alongV() const { return {v, signedMajor(), u, n_v, signedNormal(), n_u, axis + 2}; }

  uint32_t face(int k) const { return static_cast<uint32_t>(2 * axis[k] + (negative[k] != 0 ? 1 : 0)); }
  glm::vec3 offset(int k) const { return {major[k], u[k], v[k]}; }
  glm::vec3 normal(int k) const { return {n_major[k], n_u[k], n_v[k]}; }

  Extent extent(Float4 disc) const {
    const Float4 disc2 = disc * disc;
    const Float4 front = major * major - disc2 * (1.f - n_major * n_major);
    const Float4 scale = 1.f / front;
    // The planes x = place major that touch a disc: (x - place major)^2 = disc^2 (1 + place^2 - (n_x - place
    // n_major)^2).
    const auto bounds = [&](Float4 offset, Float4 normal, Float4 across) -> Bounds {
      const Float4 turned = major * normal - offset * n_major;
      const Float4 inside = major * major + offset * offset - turned * turned - disc2 * across * across;
      const Float4 half = disc * root(greater(inside, splat(0)));
      const Float4 middle = major * offset + disc2 * normal * n_major;
      return {(middle - half) * scale, (middle + half) * scale};
    };
    return {front, bounds(u, n_u, n_v), bounds(v, n_v, n_u)};
  }

 private:
  OnFaces(Float4 along, Float4 column, Float4 row, Float4 n_along, Float4 n_column, Float4 n_row, Int4 turn)
      : major(magnitude(along)),
        u(column),
        v(row),
        n_major(along < 0.f ? -n_along : n_along),
        n_u(n_column),
        n_v(n_row),
        axis(turn >= 3 ? turn - 3 : turn),
        negative(along < 0.f) {}
  Float4 signedMajor() const { return negative ? -major : major; }
  Float4 signedNormal() const { return negative ? -n_major : n_major; }
};

/// Where the rays (m, u, v) of a row meet the disc, h ray / (n.ray) within its radius of the centre d: a
/// quadratic inequality in u, (h ray - d n.ray)^2 <= radius^2 (n.ray)^2.
class RowCut {
 public:
  explicit RowCut(const Disc& c)
      : d_(c.offset),
        n_(c.normal),
        height_(c.height),
        disc2_(c.radius * c.radius),
        slope_(glm::vec3(0, c.height, 0) - c.normal.y * c.offset),
        square_(glm::dot(slope_, slope_) - disc2_ * n_.y * n_.y) {}
  /// Whether the disc's outline is closed towards the rows' ends.
  bool closed() const { return square_ > 0; }
  /// Of four rows.
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

/// Rays (1, u, v) of four neighbouring columns against a disc.
class Columns {
  /// The rim of a disc counts as farther than its centre by this part of the squared distance.
  static constexpr float rim = 1e-3f;

 public:
  Columns(const Disc& c, Float4 places)
      : u_(places),
        towards_(c.normal.x + c.normal.y * places),
        n_v_(splat(c.normal.z)),
        length2_(1.f + places * places),
        height_(splat(c.height)),
        disc2_(splat(c.radius * c.radius)),
        fattening_(splat(rim / (c.radius * c.radius))),
        major_(splat(c.offset.x)),
        offset_u_(splat(c.offset.y)),
        offset_v_(splat(c.offset.z)),
        link_(Int4{} + static_cast<int32_t>(c.link)) {}

  /// The row at place v, whose first bin is given.
  void fill(const Bins& bins, size_t first, float v) const {
    // Where a ray meets the disc's plane, and how far from its centre.
    const Float4 t = height_ / (towards_ + n_v_ * v);
    const Float4 miss_m = t - major_, miss_u = t * u_ - offset_u_, miss_v = t * v - offset_v_;
    const Float4 miss2 = miss_m * miss_m + miss_u * miss_u + miss_v * miss_v;
    // Discs of a plane overlap at the same distance: the one whose centre is nearer wins, and not rounding.
    const Float4 distance2 = t * t * (length2_ + v * v) * (1.f + fattening_ * miss2);
    const Float4 shortest = load(bins.distance2 + first);
    const Int4 links = loadInts(bins.links + first);
    const Int4 hit = (t > 0.f) & (miss2 <= disc2_) & (distance2 < shortest);
    store(bins.distance2 + first, hit ? distance2 : shortest);
    storeInts(bins.links + first, hit ? link_ : links);
  }

 private:
  Float4 u_, towards_, n_v_, length2_, height_, disc2_, fattening_, major_, offset_u_, offset_v_;
  Int4 link_;
};

}  // namespace limn::radiosity
