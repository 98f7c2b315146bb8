// Internal to the construction of links: finds which bins an element fills, as seen from a receiver.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "core/radiosity/links.h"
#include "core/radiosity/private/face_discs.h"
#include "core/radiosity/private/triangle_rays.h"
#include "glsl/indirect/direction_bins.glsl"

namespace limn::radiosity {

/// Fills the bins of one receiver. N is the number of bins along the edge of a face, so that loops over them
/// have a known length; 0: the number in the settings.
template <int N>
class BinFiller {
  static constexpr float cornerLength = 1.7321f;  // of the longest rays, those to a face's corners

 public:
  explicit BinFiller(const LinkSettings& settings)
      : runtime_n_(settings.resolution),
        half_(0.5f * static_cast<float>(n())),
        width_(1 / half_),
        nearer2_(static_cast<float>(settings.closing * settings.closing)),
        footprint_(settings.fill != Fill::centre) {
    for (size_t i = 0; i < static_cast<size_t>(n()); ++i) {
      const float at = (static_cast<float>(i) + 0.5f) * width_ - 1;
      centres_[i] = at;
      squareColumns_[i] = Float4{at, at + width_, at, at + width_};
      squareRows_[i] = Float4{at, at, at + width_, at + width_};
    }
  }

  int count() const { return 6 * n() * n(); }

  /// Closes single empty or distant bins. Links that receivers share lie in the bins as the receivers' parent
  /// sees them; between those and the receivers' own links, single bins may remain empty or keep what lies
  /// behind. A bin whose neighbours, all but one, are nearer than LinkSettings::closing of its distance takes
  /// the longest of their links, and so on along a row. Makes two sweeps.
  void close(Bins bins) const {
    if (!footprint_) return;
    const uint32_t last = 1u << (n() - 1), all = last | (last - 1);
    for (uint32_t face = 0; face < 6; ++face) {
      // A bit for each row to look at: of a hole's nearer neighbours one lies in its row, unless it is a
      // row's first or last bin and both rows beside it hold one.
      const uint32_t held = occupied(bins.distance2 + index(face, 0, 0));
      if (held == 0) continue;
      uint32_t rows = (held | ((held << 1 | 1) & (held >> 1 | last))) & all;
      for (int sweep = 0; sweep < 2; ++sweep) {
        uint32_t closed = 0;
        for (; rows != 0; rows &= rows - 1) {
          const int y = std::countr_zero(rows);
          if (mayClose(bins.distance2 + index(face, 0, y), y) && closeRow(bins, index(face, 0, y), y))
            closed |= 1u << y;
        }
        rows = (closed >> 1 | closed << 1) & all;  // those beside what was closed
      }
    }
  }

  /// Fills the bins that the candidates among `lanes` cover.
  [[gnu::always_inline]] inline void fill(const Bins& bins, const Candidates& c, uint32_t lanes) const {
    const OnFaces on(c);
    if (!footprint_) {
      const Float4 place_u = on.u / on.major, place_v = on.v / on.major;
      for (; lanes != 0; lanes &= lanes - 1) {
        const int k = std::countr_zero(lanes);
        keep(bins, index(static_cast<uint32_t>(on.face[k]), column(place_u[k]), column(place_v[k])),
             c.distance2[k], static_cast<uint32_t>(c.links[k]));
      }
      return;
    }
    // Discs whose plane passes the receiver at less than this part of their radius are seen edge-on.
    constexpr float coplanar = 1e-3f;
    lanes &= laneMask(magnitude(c.height) >= coplanar * c.disc);
    const Extent own = on.extent(c);
    const uint32_t whole = lanes & laneMask(own.front > 0.f);
    fillFace(bins, c, on, own, whole);
    // Over the edges of the face, as far as the first bins' centres on the next.
    const float next = half_ / (half_ - 0.5f);
    const uint32_t over_u = whole & own.u.over(next), over_v = whole & own.v.over(next);
    const uint32_t far = (over_u & ~own.u.overNear(on.u)) | (over_v & ~own.v.overNear(on.v));
    uint32_t several = (lanes & ~whole) | far;
    if ((over_u & ~far) != 0) several |= fillNext(bins, c, on.alongU(), over_u & ~far);
    if ((over_v & ~far) != 0) several |= fillNext(bins, c, on.alongV(), over_v & ~far);
    if (several != 0) fillFaces(bins, c, several);
  }

  /// Fills the bins whose centres triangles cover.
  [[gnu::always_inline]] inline void fill(const Bins& bins, const SeenTriangles& triangles) const {
    if (triangles.seen == 0) return;
    const TrianglesOnFaces on(triangles);
    const Boxes boxes{firstBin(on.u.low), lastBin(on.u.high), firstBin(on.v.low), lastBin(on.v.high)};
    // Over the edges of the face, as far as the first bins' centres on the next.
    const float next = half_ / (half_ - 0.5f);
    const uint32_t several = triangles.seen & (~laneMask(on.bounded) | on.u.over(next) | on.v.over(next));
    uint32_t lanes = triangles.seen & ~several & laneMask((boxes.x0 <= boxes.x1) & (boxes.y0 <= boxes.y1));
    for (; lanes != 0; lanes &= lanes - 1) {
      const int k = std::countr_zero(lanes);
      const auto face = static_cast<uint32_t>(on.face[k]);
      raster(bins, TriangleRays(triangles, k, face), face, boxes, k);
    }
    if (several != 0) fillFaces(bins, triangles, several);
  }

 private:
  /// Fills the parts of discs that lie on one face each.
  [[gnu::noinline]] void fillFace(const Bins& bins, const Candidates& c, const OnFaces& on,
                                  const Extent& extent, uint32_t lanes) const {
    const Boxes boxes{firstBin(extent.u.low), lastBin(extent.u.high), firstBin(extent.v.low),
                      lastBin(extent.v.high)};
    // Discs smaller than bins cover no bin's centre, mostly.
    for (lanes &= laneMask((boxes.x0 <= boxes.x1) & (boxes.y0 <= boxes.y1)); lanes != 0; lanes &= lanes - 1) {
      const int k = std::countr_zero(lanes);
      if (boxes.x1[k] - boxes.x0[k] < 4)
        raster(bins, DiscRays(c, on, k), static_cast<uint32_t>(on.face[k]), boxes, k);
      else
        rasterWide(bins, c, on, boxes, k);
    }
  }

  /// Fills the parts on a face that the offsets do not point to. Returns the lanes for which this is not
  /// sufficient.
  uint32_t fillNext(const Bins& bins, const Candidates& c, const OnFaces& on, uint32_t lanes) const {
    const Extent extent = on.extent(c);
    const uint32_t whole = lanes & laneMask(extent.front > 0.f);
    fillFace(bins, c, on, extent, whole);
    return lanes & ~whole;
  }

  /// Holds a rectangle of bins on one face each: first and last columns and rows.
  struct Boxes {
    Int4 x0, x1, y0, y1;
  };

  int column(float u) const { return std::clamp(static_cast<int>((u + 1) * half_), 0, n() - 1); }
  size_t index(uint32_t face, int column, int row) const {
    return static_cast<size_t>((static_cast<int>(face) * n() + row) * n() + column);
  }
  // Truncation of positive numbers: floor and ceil are calls where the target has no instruction for them.
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

  /// Holds the distances of the bins around four bins of a row. Beyond the face nothing lies in between: the
  /// distance counts as infinite there, or as 0 beside an empty bin.
  struct Around {
    Float4 left, right, up, down;
  };
  Around around(const float* own, int x, int y) const {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const Float4 here = load(own), beyond = here == infinity ? splat(0) : splat(infinity);
    return {.left = x > 0 ? load(own - 1) : Float4{beyond[0], here[0], here[1], here[2]},
            .right = x + 4 < n() ? load(own + 1) : Float4{here[1], here[2], here[3], beyond[3]},
            .up = y > 0 ? load(own - n()) : beyond,
            .down = y + 1 < n() ? load(own + n()) : beyond};
  }

  /// Returns a bit for each row of a face that holds a link.
  uint32_t occupied(const float* face) const {
    uint32_t rows = 0;
    for (int y = 0; y < n(); ++y, face += n()) {
      Float4 shortest = load(face + n() - 4);
      for (int x = 0; x + 4 < n(); x += 4) shortest = lesser(shortest, load(face + x));
      rows |= (laneMask(shortest < std::numeric_limits<float>::infinity()) != 0 ? 1u : 0u) << y;
    }
    return rows;
  }

  /// Returns whether three of four neighbours of some bin of a row are nearer, where those beyond the face
  /// count as nearer: most rows have nothing to close.
  bool mayClose(const float* row, int y) const {
    const float *up = y > 0 ? row - n() : row, *down = y + 1 < n() ? row + n() : row;
    const Int4 beyond = Int4{} - (y == 0 ? 1 : 0) - (y + 1 == n() ? 1 : 0);
    Int4 found{};
    for (int start = 0; start < n(); start += 4) {
      const int x = std::min(start, n() - 4);
      const Float4 here = load(row + x), limit = here * nearer2_;
      const Float4 left = x > 0 ? load(row + x - 1) : __builtin_shufflevector(here, Float4{}, 4, 0, 1, 2);
      const Float4 right =
          x + 4 < n() ? load(row + x + 1) : __builtin_shufflevector(here, Float4{}, 1, 2, 3, 4);
      const Int4 nearer =
          beyond + (left < limit) + (right < limit) + (load(up + x) < limit) + (load(down + x) < limit);
      found |= nearer <= -3;
    }
    return laneMask(found) != 0;
  }

  /// Closes bins of a row and returns whether there was something to close.
  bool closeRow(const Bins& bins, size_t row, int y) const {
    bool closed = false;
    for (int start = 0; start < n(); start += 4) {
      const int x = std::min(start, n() - 4);
      float* own = bins.distance2 + row + x;
      for (uint32_t holes = ~0u; holes != 0;) {
        const Around a = around(own, x, y);
        const Float4 limit = load(own) * nearer2_;
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
    const size_t width = static_cast<size_t>(n());
    size_t longest = bin;
    const auto see = [&](bool inside, size_t neighbour) {
      if (!inside || !(bins.distance2[neighbour] < limit)) return;
      if (longest == bin || bins.distance2[neighbour] > bins.distance2[longest]) longest = neighbour;
    };
    see(x > 0, bin - 1);
    see(x + 1 < n(), bin + 1);
    see(y > 0, bin - width);
    see(y + 1 < n(), bin + width);
    bins.links[bin] = bins.links[longest];
    bins.distance2[bin] = bins.distance2[longest];
  }

  /// Fills the bins of discs that lie in front of several faces each.
  [[gnu::noinline]] void fillFaces(const Bins& bins, const Candidates& c, uint32_t lanes) const {
    for (int axis = 0; axis < 3; ++axis)
      for (const bool negative : {false, true}) {
        const OnFaces on(c, axis, negative);
        // How far points of the discs are from their centres along each axis.
        const auto reach = [&](Float4 normal) {
          return c.disc * root(greater(1.f - normal * normal, splat(0)));
        };
        const Float4 least_u = magnitude(on.u) - reach(on.n_u), least_v = magnitude(on.v) - reach(on.n_v);
        const Float4 between = greater(greater(least_u, least_v), splat(0));
        const uint32_t seen = lanes & laneMask(on.major + reach(on.n_major) > between);
        if (seen == 0) continue;
        Extent extent = on.extent(c);
        const Int4 bounded = (on.major > 0.f) & (extent.front > 0.f);
        for (Bounds* bounds : {&extent.u, &extent.v}) {
          bounds->low = bounded ? bounds->low : splat(-1);
          bounds->high = bounded ? bounds->high : splat(1);
        }
        fillFace(bins, c, on, extent, seen);
      }
  }

  /// Fills the bins of triangles that lie in front of several faces each.
  [[gnu::noinline]] void fillFaces(const Bins& bins, const SeenTriangles& triangles, uint32_t lanes) const {
    for (; lanes != 0; lanes &= lanes - 1)
      for (uint32_t face = 0; face < 6; ++face) {
        const TriangleCorners corners(triangles, std::countr_zero(lanes), face);
        if (corners.beside()) continue;
        const Float4 box = corners.box();
        const Int4 first = firstBin(box), last = first - 1;
        if (first[0] < first[2] && first[1] < first[3])
          raster(bins, TriangleRays(triangles, std::countr_zero(lanes), face), face,
                 {first, Int4{} + last[2], Int4{} + first[1], Int4{} + last[3]}, 0);
      }
  }

  /// Fills the bins of box k whose centres lie on a disc or triangle. Works in squares of four bins, which
  /// may extend beyond the box; the disc or triangle does not.
  template <class Rays>
  void raster(const Bins& bins, const Rays& rays, uint32_t face, const Boxes& boxes, int k) const {
    const size_t row = static_cast<size_t>(n()), first = index(face, 0, 0);
    const int x1 = boxes.x1[k], y0 = boxes.y0[k], y1 = boxes.y1[k];
    for (int left = boxes.x0[k]; left <= x1; left += 2) {
      const int x = std::min(left, n() - 2);
      const auto columns = rays.columns(squareColumns_[static_cast<size_t>(x)]);
      for (int top = y0; top <= y1; top += 2) {
        const int y = std::min(top, n() - 2);
        rays.fillSquare(bins, first + static_cast<size_t>(y * n() + x), row, columns,
                        squareRows_[static_cast<size_t>(y)]);
      }
    }
  }

  /// Fills the bins of a box of more than four columns in the same way.
  [[gnu::noinline]] void rasterWide(const Bins& bins, const Candidates& c, const OnFaces& on,
                                    const Boxes& boxes, int k) const {
    const auto face = static_cast<uint32_t>(on.face[k]);
    const RowCut cut(c, on, k);
    const glm::vec3 up = onFace(bins.up, face);
    const float margin = cornerLength * bins.margin;
    if (up.x + std::abs(up.y) + std::abs(up.z) < -margin) return;
    const DiscRays rays(c, on, k);
    const struct { int x0, x1, y0, y1; } box{boxes.x0[k], boxes.x1[k], boxes.y0[k], boxes.y1[k]};
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
          const int first = std::min(x, n() - 4);
          rays.fill(bins, index(face, first, y), rays.columns(places(first)), splat(centre(y)));
        }
    }
  }

  /// Returns the position of a column's or row's centre.
  float centre(int bin) const { return centres_[static_cast<size_t>(bin)]; }
  Float4 places(int first) const { return centre(first) + Float4{0, 1, 2, 3} * width_; }

  int n() const { return N > 0 ? N : runtime_n_; }

  int runtime_n_;
  float half_, width_;  ///< of bins in a row, and 1 over it
  float nearer2_;       ///< LinkSettings::closing, squared
  bool footprint_;
  // Places of columns or rows: of their centres, and of the squares of bins that begin there.
  std::array<float, 32> centres_{};
  std::array<Float4, 32> squareColumns_{}, squareRows_{};
};

}  // namespace limn::radiosity
