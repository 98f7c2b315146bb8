// Internal to the construction of links: which bins an element fills, as seen from a receiver.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "core/radiosity/face_discs.h"
#include "core/radiosity/links.h"
#include "glsl/direction_bins.glsl"

namespace limn::radiosity {

class BinFiller {
  static constexpr float cornerLength = 1.7321f;  // of the longest rays, those to a face's corners

 public:
  explicit BinFiller(const LinkSettings& settings)
      : n_(settings.resolution),
        half_(0.5f * static_cast<float>(n_)),
        width_(1 / half_),
        footprint_(settings.fill == Fill::footprint) {}

  int count() const { return 6 * n_ * n_; }

  void clear(Bins bins) const {
    std::fill_n(bins.distance2, count(), std::numeric_limits<float>::infinity());
    std::fill_n(bins.links, count(), glsl::no_link);
  }

  /// Links that receivers share are in the bins as the receivers' parent sees them; between those and the
  /// receivers' own single bins may stay as they were, empty or with what lies behind. A bin of which all
  /// neighbours but one are nearer than half as far takes the longest of their links, and so on
  /// along a row. Two sweeps.
  void close(Bins bins) const {
    if (!footprint_) return;
    for (uint32_t face = 0; face < 6; ++face) {
      const glm::vec3 up = onFace(bins.up, face);
      const float highest = up.x + std::abs(up.y) + cornerLength * bins.margin;
      uint32_t rows =
          0;  // a bit for each to look at: those above the horizon, then those beside what was closed
      for (int y = 0; y < n_; ++y) rows |= (highest + up.z * centre(y) >= 0 ? 1u : 0u) << y;
      for (int sweep = 0; sweep < 2; ++sweep) {
        uint32_t closed = 0;
        for (; rows != 0; rows &= rows - 1) {
          const int y = std::countr_zero(rows);
          if (closeRow(bins, index(face, 0, y), y)) closed |= 1u << y;
        }
        rows = closed >> 1 | (closed << 1 & ~0u >> (32 - n_));
      }
    }
  }

  /// Fills what those among `lanes` cover.
  void fill(const Bins& bins, const Candidates& c, uint32_t lanes) const {
    const OnFaces on(c);
    if (!footprint_) {
      const Float4 place_u = on.u / on.major, place_v = on.v / on.major;
      for (; lanes != 0; lanes &= lanes - 1) {
        const int k = std::countr_zero(lanes);
        keep(bins, index(on.face(k), column(place_u[k]), column(place_v[k])), c.distance2[k],
             static_cast<uint32_t>(c.links[k]));
      }
      return;
    }
    // Discs whose plane passes the receiver at less than this part of their radius are seen edge-on.
    constexpr float coplanar = 1e-3f;
    lanes &= laneMask(magnitude(c.height) >= coplanar * c.disc);
    const Extent own = on.extent(c.disc);
    const uint32_t whole = lanes & laneMask(own.front > 0.f);
    fillFace(bins, c, on, own, whole);
    // Over the edges of the face, as far as the first bins' centres on the next.
    const float next = half_ / (half_ - 0.5f);
    const uint32_t over_u = whole & own.u.over(next), over_v = whole & own.v.over(next);
    const uint32_t far = (over_u & ~own.u.overNear(on.u)) | (over_v & ~own.v.overNear(on.v));
    uint32_t several = (lanes & ~whole) | far;
    if ((over_u & ~far) != 0) several |= fillNext(bins, c, on.alongU(), over_u & ~far);
    if ((over_v & ~far) != 0) several |= fillNext(bins, c, on.alongV(), over_v & ~far);
    for (; several != 0; several &= several - 1) fillFaces(bins, c, std::countr_zero(several));
  }

 private:
  /// The parts of discs on one face each.
  void fillFace(const Bins& bins, const Candidates& c, const OnFaces& on, const Extent& extent,
                uint32_t lanes) const {
    const Int4 x0 = firstBin(extent.u.low), x1 = lastBin(extent.u.high), y0 = firstBin(extent.v.low),
               y1 = lastBin(extent.v.high);
    // Discs smaller than bins cover no bin's centre, mostly.
    for (lanes &= laneMask((x0 <= x1) & (y0 <= y1)); lanes != 0; lanes &= lanes - 1) {
      const int k = std::countr_zero(lanes);
      const Disc disc{on.offset(k), on.normal(k), c.height[k], c.disc[k], static_cast<uint32_t>(c.links[k])};
      raster(bins, disc, on.face(k), {x0[k], x1[k], y0[k], y1[k]});
    }
  }

  /// The same on a face that the offsets do not point to. Returns the lanes that this does not do for.
  uint32_t fillNext(const Bins& bins, const Candidates& c, const OnFaces& on, uint32_t lanes) const {
    const Extent extent = on.extent(c.disc);
    const uint32_t whole = lanes & laneMask(extent.front > 0.f);
    fillFace(bins, c, on, extent, whole);
    return lanes & ~whole;
  }

  /// Bins of a face.
  struct Box {
    int x0, x1, y0, y1;
  };

  int column(float u) const { return std::clamp(static_cast<int>((u + 1) * half_), 0, n_ - 1); }
  size_t index(uint32_t face, int column, int row) const {
    return static_cast<size_t>((static_cast<int>(face) * n_ + row) * n_ + column);
  }
  // Truncation of positive numbers: floor and ceil are calls where the target has no instruction for them.
  int below(float u) const { return static_cast<int>(std::max((u + 1) * half_ + 0.5f, 0.f)); }
  Int4 firstBin(Float4 u) const {
    const Float4 place = (u + 1.f) * half_ + 0.5f, end = splat(2 * half_);
    return __builtin_convertvector(greater(lesser(place, end), splat(0)), Int4);
  }
  Int4 lastBin(Float4 u) const { return firstBin(u) - 1; }

  static void keep(const Bins& bins, size_t bin, float distance2, uint32_t link) {
    if (!(distance2 < bins.distance2[bin])) return;
    bins.distance2[bin] = distance2;
    bins.links[bin] = link;
  }

  /// Distances of the bins around four of a row. Beyond the face there is nothing in between, but for empty
  /// bins.
  struct Around {
    Float4 left, right, up, down;
  };
  Around around(const float* own, int x, int y) const {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const Float4 here = load(own), beyond = here == infinity ? splat(0) : splat(infinity);
    return {.left = x > 0 ? load(own - 1) : Float4{beyond[0], here[0], here[1], here[2]},
            .right = x + 4 < n_ ? load(own + 1) : Float4{here[1], here[2], here[3], beyond[3]},
            .up = y > 0 ? load(own - n_) : beyond,
            .down = y + 1 < n_ ? load(own + n_) : beyond};
  }

  /// Whether there was something to close.
  bool closeRow(const Bins& bins, size_t row, int y) const {
    constexpr float nearer2 = 0.25f;  // half as far, squared
    bool closed = false;
    for (int start = 0; start < n_; start += 4) {
      const int x = std::min(start, n_ - 4);
      float* own = bins.distance2 + row + x;
      for (uint32_t holes = ~0u; holes != 0;) {
        const Around a = around(own, x, y);
        const Float4 limit = load(own) * nearer2;
        const Int4 nearer = (a.left < limit) + (a.right < limit) + (a.up < limit) + (a.down < limit);
        holes = laneMask(nearer <= -3);
        closed = closed || holes != 0;
        for (uint32_t some = holes; some != 0; some &= some - 1) {
          const int k = std::countr_zero(some);
          closeOne(bins, row + static_cast<size_t>(x + k), x + k, y, limit[k]);
        }
      }
    }
    return closed;
  }

  void closeOne(const Bins& bins, size_t bin, int x, int y, float limit) const {
    const size_t width = static_cast<size_t>(n_);
    size_t longest = bin;
    const auto see = [&](bool inside, size_t neighbour) {
      if (!inside || !(bins.distance2[neighbour] < limit)) return;
      if (longest == bin || bins.distance2[neighbour] > bins.distance2[longest]) longest = neighbour;
    };
    see(x > 0, bin - 1);
    see(x + 1 < n_, bin + 1);
    see(y > 0, bin - width);
    see(y + 1 < n_, bin + width);
    bins.links[bin] = bins.links[longest];
    bins.distance2[bin] = bins.distance2[longest];
  }

  /// Lane k's disc, in front of several faces.
  void fillFaces(const Bins& bins, const Candidates& c, int k) const {
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
                        static_cast<uint32_t>(c.links[k])};
        rasterFace(bins, disc, static_cast<uint32_t>(2 * axis + (sign < 0 ? 1 : 0)));
      }
    }
  }

  /// The part of a disc in front of a face.
  void rasterFace(const Bins& bins, const Disc& disc, uint32_t face) const {
    const float m = disc.offset.x, n = disc.normal.x, disc2 = disc.radius * disc.radius;
    const float front = m * m - disc2 * (1 - n * n);
    glm::vec2 low(-1), high(1);
    if (m > 0 && front > 0) {  // see OnFaces::extent
      const glm::vec2 offset(disc.offset.y, disc.offset.z), normal(disc.normal.y, disc.normal.z),
          across(disc.normal.z, disc.normal.y);
      const glm::vec2 turned = m * normal - n * offset,
                      inside = m * m + offset * offset - turned * turned - disc2 * across * across,
                      half = disc.radius * glm::sqrt(glm::max(inside, glm::vec2(0))),
                      middle = m * offset + disc2 * n * normal;
      low = glm::max((middle - half) / front, low);
      high = glm::min((middle + half) / front, high);
      if (low.x > high.x || low.y > high.y) return;
    }
    const Box box{below(low.x), std::min(n_, below(high.x)) - 1, below(low.y),
                  std::min(n_, below(high.y)) - 1};
    if (box.x0 <= box.x1 && box.y0 <= box.y1) raster(bins, disc, face, box);
  }

  /// Bins of the box whose centres lie on the disc. Four columns at once, beyond the box where it is
  /// narrower: there the disc is not.
  void raster(const Bins& bins, const Disc& c, uint32_t face, const Box& box) const {
    if (box.x1 - box.x0 >= 4) return rasterWide(bins, c, face, box);
    const int x = std::min(box.x0, n_ - 4);
    const Columns columns(c, places(x));
    size_t bin = index(face, x, box.y0);
    float v = centre(box.y0);
    for (int y = box.y0; y <= box.y1; ++y, bin += static_cast<size_t>(n_), v += width_)
      columns.fill(bins, bin, v);
  }

  /// The same for more than four columns.
  [[gnu::noinline]] void rasterWide(const Bins& bins, const Disc& c, uint32_t face, const Box& box) const {
    const RowCut cut(c);
    const glm::vec3 up = onFace(bins.up, face);
    const float margin = cornerLength * bins.margin;
    if (up.x + std::abs(up.y) + std::abs(up.z) < -margin) return;
    for (int four = box.y0; four <= box.y1; four += 4) {
      Int4 begin = Int4{} + box.x0, end = Int4{} + box.x1;
      if (cut.closed()) {
        const Bounds row = cut(places(four));
        const Int4 first = firstBin(row.low), last = lastBin(row.high);
        begin = begin > first ? begin : first;
        end = end < last ? end : last;
      }
      if (std::abs(up.y) > 1e-3f) {
        const Float4 horizon = (-margin - up.x - up.z * places(four)) / up.y;
        const Int4 first = firstBin(horizon), last = lastBin(horizon);
        if (up.y > 0)
          begin = begin > first ? begin : first;
        else
          end = end < last ? end : last;
      }
      for (int y = four; y <= std::min(four + 3, box.y1); ++y)
        for (int x = begin[y - four]; x <= end[y - four]; x += 4) {
          const int first = std::min(x, n_ - 4);
          Columns(c, places(first)).fill(bins, index(face, first, y), centre(y));
        }
    }
  }

  /// A vector in the axes of a face: major, column, row.
  static glm::vec3 onFace(const glm::vec3& v, uint32_t face) {
    const int axis = static_cast<int>(face / 2);
    return {face % 2 != 0 ? -v[axis] : v[axis], v[(axis + 1) % 3], v[(axis + 2) % 3]};
  }

  /// The place of a column's or row's centre.
  float centre(int bin) const { return (static_cast<float>(bin) + 0.5f) * width_ - 1; }
  Float4 places(int first) const { return centre(first) + Float4{0, 1, 2, 3} * width_; }

  int n_;
  float half_, width_;  ///< of bins in a row, and 1 over it
  bool footprint_;
};

}  // namespace limn::radiosity
