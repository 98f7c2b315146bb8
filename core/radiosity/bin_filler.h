// Internal to the construction of links: which bins an element fills, as seen from a receiver.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "core/radiosity/float4.h"
#include "core/radiosity/links.h"
#include "glsl/direction_bins.glsl"

namespace limn::radiosity {

/// The bins of one receiver: the shortest link of each and its squared length.
struct Bins {
  float* distance2 = nullptr;
  uint32_t* links = nullptr;
};

/// Up to four siblings at the other ends of links: offsets from the receiver, unit normals, heights along
/// these.
struct Candidates {
  Float4 x, y, z, nx, ny, nz;
  Float4 distance2, height, disc;
  uint32_t links[4];
};

class BinFiller {
  /// A disc whose plane passes the receiver at less than this part of its radius is seen edge-on.
  static constexpr float coplanar = 1e-3f;
  /// The rim of a disc counts as farther than its centre by this part of the squared distance.
  static constexpr float overlap = 1e-3f;
  static constexpr int most = 32;  // bins in a row

 public:
  explicit BinFiller(const LinkSettings& settings)
      : n_(settings.resolution),
        half_(0.5f * static_cast<float>(n_)),
        footprint_(settings.fill == Fill::footprint) {}

  int count() const { return 6 * n_ * n_; }

  void clear(Bins bins) const {
    std::fill_n(bins.distance2, count(), std::numeric_limits<float>::infinity());
    std::fill_n(bins.links, count(), glsl::no_link);
  }

  /// Links that receivers share are in the bins as the receivers' parent sees them; between those and the
  /// receivers' own single bins may stay empty. An empty bin with at least three neighbours on its face that
  /// are not (at its edges: all but one) takes the longest of their links, and so on along a row. Two sweeps.
  void close(Bins bins) const {
    if (!footprint_) return;
    uint32_t empty[most + 2] = {};  // a bit per bin; nothing beyond the face's first and last row
    for (int face = 0; face < 6; ++face) {
      const size_t first = index(static_cast<uint32_t>(face), 0, 0);
      uint32_t any = 0, all = ~0u;
      for (int y = 0; y < n_; ++y) {
        const uint32_t row = emptyBins(bins.links + first + static_cast<size_t>(y * n_));
        empty[y + 1] = row;
        any |= row;
        all &= row;
      }
      if (any == 0 || all == ~0u >> (32 - n_)) continue;
      for (int sweep = 0; sweep < 2; ++sweep)
        for (int y = 0; y < n_; ++y) closeRow(bins, first, y, &empty[y + 1]);
    }
  }

  /// Fills what those among `lanes` cover.
  void fill(Bins bins, const Candidates& c, uint32_t lanes) const {
    const OnFaces on(c);
    if (!footprint_) {
      for (; lanes != 0; lanes &= lanes - 1) {
        const int k = std::countr_zero(lanes);
        keep(bins, index(on.face(k), column(on.place_u[k]), column(on.place_v[k])), c.distance2[k],
             c.links[k]);
      }
      return;
    }
    Float4 reach_u, reach_v;
    on.reach(c.disc, reach_u, reach_v);
    const Float4 low_u = on.place_u - reach_u, high_u = on.place_u + reach_u, low_v = on.place_v - reach_v,
                 high_v = on.place_v + reach_v;
    const Float4 one = splat(1);
    const uint32_t single =
        lanes & laneMask((c.disc < 0.5f * on.major) & (magnitude(on.place_u) + reach_u <= one) &
                         (magnitude(on.place_v) + reach_v <= one));
    const Int4 x0 = firstBin(low_u), x1 = lastBin(high_u), y0 = firstBin(low_v), y1 = lastBin(high_v);
    // Discs smaller than bins cover no bin's centre, mostly.
    for (uint32_t some = single & laneMask((x0 <= x1) & (y0 <= y1)); some != 0; some &= some - 1) {
      const int k = std::countr_zero(some);
      const Disc disc{on.offset(k), on.normal(k), c.height[k], c.disc[k], c.links[k]};
      raster(bins, disc, on.face(k), {x0[k], x1[k], y0[k], y1[k], low_u[k], high_u[k]});
    }
    for (uint32_t several = lanes & ~single; several != 0; several &= several - 1)
      fillFaces(bins, c, std::countr_zero(several));
  }

 private:
  /// Offsets and normals in the axes of the faces that the offsets point to: major (not negative), column,
  /// row; and where the offsets meet the faces.
  struct OnFaces {
    Float4 major, u, v, n_major, n_u, n_v, place_u, place_v;
    Int4 x_major, y_major, negative;

    explicit OnFaces(const Candidates& c) {
      const Float4 ax = magnitude(c.x), ay = magnitude(c.y), az = magnitude(c.z);
      x_major = (ax >= ay) & (ax >= az);
      y_major = ~x_major & (ay >= az);
      const Float4 along = select(c.x, c.y, c.z), n_along = select(c.nx, c.ny, c.nz);
      negative = along < 0.f;
      major = magnitude(along);
      n_major = negative ? -n_along : n_along;
      u = select(c.y, c.z, c.x);
      v = select(c.z, c.x, c.y);
      n_u = select(c.ny, c.nz, c.nx);
      n_v = select(c.nz, c.nx, c.ny);
      place_u = u / major;
      place_v = v / major;
    }
    Float4 select(Float4 x, Float4 y, Float4 z) const { return x_major ? x : y_major ? y : z; }
    uint32_t face(int k) const {
      return (x_major[k] != 0 ? 0u : y_major[k] != 0 ? 2u : 4u) + (negative[k] != 0 ? 1u : 0u);
    }
    glm::vec3 offset(int k) const { return {major[k], u[k], v[k]}; }
    glm::vec3 normal(int k) const { return {n_major[k], n_u[k], n_v[k]}; }

    /// How far from the centre's place on the face points of the disc can be; where major > disc.
    void reach(Float4 disc, Float4& of_u, Float4& of_v) const {
      // The offset o of a point moves its place by (o_u - u o_m) / (major + o_m), and is perpendicular to the
      // normal.
      const Float4 along_u = n_u - place_u * n_major, along_v = n_v - place_v * n_major;
      const Float4 none = splat(0);
      const Float4 closer = disc * root(greater(1.f - n_major * n_major, none));
      const Float4 scale = disc / (major - closer);
      of_u = scale * root(greater(1.f + place_u * place_u - along_u * along_u, none));
      of_v = scale * root(greater(1.f + place_v * place_v - along_v * along_v, none));
    }
  };

  /// A disc in the axes of a face.
  struct Disc {
    glm::vec3 offset, normal;
    float height, radius;
    uint32_t link;
  };
  /// Bins of a face, and where on it columns of the disc begin and end.
  struct Box {
    int x0, x1, y0, y1;
    float low, high;
  };

  int column(float u) const { return std::clamp(static_cast<int>((u + 1) * half_), 0, n_ - 1); }
  size_t index(uint32_t face, int column, int row) const {
    return static_cast<size_t>((static_cast<int>(face) * n_ + row) * n_ + column);
  }
  // Truncation of positive numbers: floor and ceil are calls where the target has no instruction for them.
  int below(float u) const { return static_cast<int>(std::max((u + 1) * half_ + 0.5f, 0.f)); }
  Int4 firstBin(Float4 u) const {
    return __builtin_convertvector(greater((u + 1.f) * half_ + 0.5f, splat(0)), Int4);
  }
  Int4 lastBin(Float4 u) const {
    const Int4 behind = firstBin(u);
    return (behind < n_ ? behind : Int4{n_, n_, n_, n_}) - 1;
  }

  static void keep(Bins bins, size_t bin, float distance2, uint32_t link) {
    if (!(distance2 < bins.distance2[bin])) return;
    bins.distance2[bin] = distance2;
    bins.links[bin] = link;
  }

  uint32_t emptyBins(const uint32_t* row) const {
    uint32_t bits = 0;
    int x = 0;
    for (; x + 4 <= n_; x += 4) bits |= laneMask(loadInts(row + x) == -1) << x;
    for (; x < n_; ++x) bits |= (row[x] == glsl::no_link ? 1u : 0u) << x;
    return bits;
  }

  /// `empty`: of this row; the rows above and below lie around it.
  void closeRow(Bins bins, size_t first, int y, uint32_t* empty) const {
    const uint32_t up = empty[-1], down = empty[1];
    for (uint32_t closed = ~0u; closed != 0; empty[0] &= ~closed) {
      const uint32_t left = empty[0] << 1, right = empty[0] >> 1;
      const uint32_t several = (left & right) | (up & down) | ((left | right) & (up | down));
      closed = empty[0] & ~several;
      for (uint32_t some = closed; some != 0; some &= some - 1)
        closeOne(bins, first + static_cast<size_t>(y * n_), std::countr_zero(some), y);
    }
  }

  void closeOne(Bins bins, size_t row, int x, int y) const {
    const size_t bin = row + static_cast<size_t>(x), width = static_cast<size_t>(n_);
    size_t longest = bin;
    const auto see = [&](bool inside, size_t neighbour) {
      if (!inside || bins.links[neighbour] == glsl::no_link) return;
      if (longest == bin || bins.distance2[neighbour] > bins.distance2[longest]) longest = neighbour;
    };
    see(x > 0, bin - 1);
    see(x + 1 < n_, bin + 1);
    see(y > 0, bin - width);
    see(y + 1 < n_, bin + width);
    bins.links[bin] = bins.links[longest];
    bins.distance2[bin] = bins.distance2[longest];
  }

  /// Where the rays (m, u, v) of a row meet the disc, h ray / (n.ray) within its radius of the centre d: a
  /// quadratic inequality in u, (h ray - d n.ray)^2 <= radius^2 (n.ray)^2.
  class RowCut {
   public:
    RowCut(const glm::vec3& d, const glm::vec3& n, float height, float disc2)
        : d_(d), n_(n), height_(height), disc2_(disc2), slope_(glm::vec3(0, height, 0) - n.y * d) {
      square_ = glm::dot(slope_, slope_) - disc2 * n.y * n.y;
    }
    /// Narrows [low, high]; leaves it as it is where the disc's outline is open towards the row's ends.
    void cut(float v, float& low, float& high) const {
      const float towards = n_.x + n_.z * v;
      const glm::vec3 start = height_ * glm::vec3(1, 0, v) - towards * d_;
      const float half = glm::dot(start, slope_) - disc2_ * towards * n_.y;
      const float rest = glm::dot(start, start) - disc2_ * towards * towards;
      if (!(square_ > 0)) return;
      const float inside = half * half - square_ * rest;
      if (inside < 0) {
        high = low - 1;
        return;
      }
      const float width = std::sqrt(inside);
      low = std::max(low, (-half - width) / square_);
      high = std::min(high, (-half + width) / square_);
    }

   private:
    glm::vec3 d_, n_;
    float height_, disc2_;
    glm::vec3 slope_;
    float square_;
  };

  /// Lane k's disc, in front of several faces.
  void fillFaces(Bins bins, const Candidates& c, int k) const {
    const glm::vec3 offset(c.x[k], c.y[k], c.z[k]), normal(c.nx[k], c.ny[k], c.nz[k]);
    // How far its points are from its centre along each axis.
    const glm::vec3 extent = c.disc[k] * glm::sqrt(glm::max(1.f - normal * normal, glm::vec3(0)));
    const glm::vec3 least = glm::abs(offset) - extent;
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const float between = std::max({least[u], least[v], 0.f});
      for (const float sign : {1.f, -1.f}) {
        if (sign * offset[axis] + extent[axis] <= between) continue;
        const Disc disc{{sign * offset[axis], offset[u], offset[v]},
                        {sign * normal[axis], normal[u], normal[v]},
                        c.height[k],
                        c.disc[k],
                        c.links[k]};
        rasterFace(bins, disc, static_cast<uint32_t>(2 * axis + (sign < 0 ? 1 : 0)), extent[axis]);
      }
    }
  }

  /// The part of a disc in front of a face; `closer`: its extent along the face's major axis.
  void rasterFace(Bins bins, const Disc& disc, uint32_t face, float closer) const {
    const float major = disc.offset.x;
    glm::vec2 low(-1), high(1);
    if (major > closer) {
      const glm::vec2 place = glm::vec2(disc.offset.y, disc.offset.z) / major;
      const glm::vec2 along = glm::vec2(disc.normal.y, disc.normal.z) - place * disc.normal.x;
      const glm::vec2 size2 = glm::max(glm::vec2(1) + place * place - along * along, glm::vec2(0));
      const glm::vec2 reach = disc.radius / (major - closer) * glm::sqrt(size2);
      low = glm::max(place - reach, low);
      high = glm::min(place + reach, high);
      if (low.x > high.x || low.y > high.y) return;
    }
    const Box box{below(low.x), std::min(n_, below(high.x)) - 1,
                  below(low.y), std::min(n_, below(high.y)) - 1,
                  low.x,        high.x};
    if (box.x0 <= box.x1 && box.y0 <= box.y1) raster(bins, disc, face, box);
  }

  /// Bins of the box whose centres lie on the disc.
  void raster(Bins bins, const Disc& c, uint32_t face, const Box& box) const {
    if (std::abs(c.height) < coplanar * c.radius) return;
    const size_t first = index(face, box.x0, box.y0);
    const auto wide = static_cast<size_t>(n_);
    if (box.x1 <= box.x0 + 1 && box.y1 <= box.y0 + 1) {
      const uint32_t columns = box.x1 > box.x0 ? 0xfu : 0x5u, rows = box.y1 > box.y0 ? 0xfu : 0x3u;
      rasterFour(bins, c, centre(box.x0) + Float4{0, 1, 0, 1} / half_,
                 centre(box.y0) + Float4{0, 0, 1, 1} / half_, columns & rows,
                 {first, first + 1, first + wide, first + wide + 1});
      return;
    }
    const RowCut row(c.offset, c.normal, c.height, c.radius * c.radius);
    const bool cut = box.x1 - box.x0 >= 4;
    for (int y = box.y0; y <= box.y1; ++y) {
      int begin = box.x0, end = box.x1;
      if (cut) {
        float from = box.low, to = box.high;
        row.cut(centre(y), from, to);
        begin = std::max(begin, below(from - 1e-4f));
        end = std::min(end, below(to + 1e-4f) - 1);
      }
      const Float4 v = splat(centre(y));
      Float4 u = centre(begin) + Float4{0, 1, 2, 3} / half_;
      size_t bin = index(face, begin, y);
      for (int x = begin; x <= end; x += 4, bin += 4, u += 4 / half_)
        rasterFour(bins, c, u, v, (2u << std::min(end - x, 3)) - 1, {bin, bin + 1, bin + 2, bin + 3});
    }
  }

  /// The place of a column's or row's centre.
  float centre(int bin) const { return (static_cast<float>(bin) + 0.5f) / half_ - 1; }

  /// Four rays (1, u, v), those among `lanes`.
  static void rasterFour(Bins bins, const Disc& c, Float4 u, Float4 v, uint32_t lanes,
                         const std::array<size_t, 4>& at) {
    // Where a ray meets the disc's plane, and how far from its centre.
    const Float4 t = c.height / (c.normal.x + c.normal.y * u + c.normal.z * v);
    const Float4 miss_m = t - c.offset.x, miss_u = t * u - c.offset.y, miss_v = t * v - c.offset.z;
    const Float4 miss2 = miss_m * miss_m + miss_u * miss_u + miss_v * miss_v;
    const float disc2 = c.radius * c.radius;
    uint32_t hits = laneMask((t > 0.f) & (miss2 <= splat(disc2))) & lanes;
    if (hits == 0) return;
    // Discs of a plane overlap at the same distance: the one whose centre is nearer wins, and not rounding.
    const Float4 distance2 = t * t * (1.f + u * u + v * v) * (1.f + overlap / disc2 * miss2);
    for (; hits != 0; hits &= hits - 1) {
      const int k = std::countr_zero(hits);
      keep(bins, at[static_cast<size_t>(k)], distance2[k], c.link);
    }
  }

  int n_;
  float half_;
  bool footprint_;
};

}  // namespace limn::radiosity
