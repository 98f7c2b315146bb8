// Internal to the construction of links: which bins an element fills, as seen from a receiver.
#pragma once

#include <algorithm>
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

/// A candidate at the other end of a link.
struct Candidate {
  glm::vec3 offset{0};  ///< from the receiver
  glm::vec3 normal{0};
  glm::vec3 horizon{
      0};  ///< normal of the receiver, below whose plane nothing counts; 0: a receiver with several
  float distance2 = 0, disc = 0;
  uint32_t link = 0;
};

class BinFiller {
  /// A disc whose plane passes the receiver at less than this part of its radius is seen edge-on.
  static constexpr float coplanar = 1e-3f;
  /// The rim of a disc counts as farther than its centre by this part of the squared distance.
  static constexpr float overlap = 1e-3f;

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
  /// are not (at its edges: all but one) takes the longest of their links. Two sweeps, for holes of up to
  /// four bins.
  void close(Bins bins) const {
    if (!footprint_) return;
    for (int sweep = 0; sweep < 2; ++sweep)
      for (int face = 0; face < 6; ++face)
        for (int y = 0; y < n_; ++y)
          for (int x = 0; x < n_; ++x) {
            const size_t bin = index(static_cast<uint32_t>(face), x, y);
            if (bins.links[bin] == glsl::no_link) closeOne(bins, bin, x, y);
          }
  }

  void fill(Bins bins, const Candidate& c) const {
    glm::vec2 uv;
    const uint32_t face = glsl::bin_face(c.offset, uv);
    if (!footprint_) {
      keep(bins, index(face, column(uv.x), column(uv.y)), c.distance2, c.link);
      return;
    }
    const float disc = c.disc, disc2 = disc * disc;
    const float major = std::max({std::abs(c.offset.x), std::abs(c.offset.y), std::abs(c.offset.z)});
    if (disc < 0.5f * major) {
      const glm::vec2 reach = reachOnFace(c, face, uv, major);
      if (std::abs(uv.x) + reach.x <= 1 && std::abs(uv.y) + reach.y <= 1) {
        raster(bins, c, face, uv - reach, uv + reach, disc2);
        return;
      }
    }
    for (uint32_t other = 0; other < 6; ++other) rasterFace(bins, c, other, disc, disc2);
  }

 private:
  int column(float u) const { return std::clamp(static_cast<int>((u + 1) * half_), 0, n_ - 1); }
  size_t index(uint32_t face, int column, int row) const {
    return static_cast<size_t>((static_cast<int>(face) * n_ + row) * n_ + column);
  }

  static void keep(Bins bins, size_t bin, float distance2, uint32_t link) {
    if (!(distance2 < bins.distance2[bin])) return;
    bins.distance2[bin] = distance2;
    bins.links[bin] = link;
  }

  void closeOne(Bins bins, size_t bin, int x, int y) const {
    int missing = 0;
    size_t longest = bin;
    const auto see = [&](bool inside, size_t neighbour) {
      if (!inside) return;
      if (bins.links[neighbour] == glsl::no_link) {
        ++missing;
      } else if (longest == bin || bins.distance2[neighbour] > bins.distance2[longest]) {
        longest = neighbour;
      }
    };
    const auto row = static_cast<size_t>(n_);
    see(x > 0, bin - 1);
    see(x + 1 < n_, bin + 1);
    see(y > 0, bin - row);
    see(y + 1 < n_, bin + row);
    if (missing > 1) return;
    bins.links[bin] = bins.links[longest];
    bins.distance2[bin] = bins.distance2[longest];
  }

  /// How far from the centre's place `uv` on the face points of the disc can be; major > disc.
  static glm::vec2 reachOnFace(const Candidate& c, uint32_t face, const glm::vec2& uv, float major) {
    const auto axis = static_cast<int>(face / 2);
    const float nm = (face & 1u) != 0 ? -c.normal[axis] : c.normal[axis];
    const glm::vec2 n(c.normal[(axis + 1) % 3], c.normal[(axis + 2) % 3]);
    // The offset o of a point moves its place by (o_u - u o_m) / (major + o_m), and is perpendicular to the
    // normal.
    const glm::vec2 along = n - uv * nm;
    const glm::vec2 size2 = glm::max(glm::vec2(1) + uv * uv - along * along, glm::vec2(0));
    const float closer = c.disc * std::sqrt(std::max(1 - nm * nm, 0.f));
    return c.disc / (major - closer) * glm::vec2(std::sqrt(size2.x), std::sqrt(size2.y));
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

  /// The part of the disc in front of a face.
  void rasterFace(Bins bins, const Candidate& c, uint32_t face, float disc, float disc2) const {
    const auto axis = static_cast<int>(face / 2);
    const float major = (face & 1u) != 0 ? -c.offset[axis] : c.offset[axis];
    if (major <= -disc) return;
    glm::vec2 low(-1), high(1);
    if (major > disc) {
      const glm::vec2 uv = glm::vec2(c.offset[(axis + 1) % 3], c.offset[(axis + 2) % 3]) / major;
      const glm::vec2 reach = reachOnFace(c, face, uv, major);
      low = glm::max(uv - reach, low);
      high = glm::min(uv + reach, high);
    }
    if (low.x <= high.x && low.y <= high.y) raster(bins, c, face, low, high, disc2);
  }

  /// Bins of the face whose centres lie in [low, high] and on the disc.
  void raster(Bins bins, const Candidate& c, uint32_t face, glm::vec2 low, glm::vec2 high,
              float disc2) const {
    // Truncation of positive numbers: floor and ceil are calls where the target has no instruction for them.
    const auto below = [&](float u) { return static_cast<int>(std::max((u + 1) * half_ + 0.5f, 0.f)); };
    const auto first = [&](float u) { return below(u); };
    const auto last = [&](float u) { return std::min(n_, below(u)) - 1; };
    const int x0 = first(low.x), x1 = last(high.x), y0 = first(low.y), y1 = last(high.y);
    const float height = glm::dot(c.offset, c.normal);
    if (x0 > x1 || y0 > y1 || std::abs(height) < coplanar * c.disc) return;
    const auto axis = static_cast<int>(face / 2);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const float major = (face & 1u) != 0 ? -1.f : 1.f;
    const float step = 1 / half_;
    const Float4 lane = {0, 1, 2, 3};
    const bool wide = x1 - x0 >= 4;
    const RowCut row({major * c.offset[axis], c.offset[u], c.offset[v]},
                     {major * c.normal[axis], c.normal[u], c.normal[v]}, height, disc2);
    for (int y = y0; y <= y1; ++y) {
      const float at_v = (static_cast<float>(y) + 0.5f) * step - 1;
      const float towards = c.normal[axis] * major + c.normal[v] * at_v;
      const float length2 = 1 + at_v * at_v;
      int begin = x0, end = x1;
      if (wide) {
        float from = low.x, to = high.x;
        row.cut(at_v, from, to);
        begin = std::max(x0, below(from - 1e-4f));
        end = std::min(x1, below(to + 1e-4f) - 1);
      }
      Float4 at_u = (static_cast<float>(begin) + 0.5f + lane) * step - 1;
      size_t bin = index(face, begin, y);
      for (int x = begin; x <= end; x += 4, bin += 4, at_u += 4 * step) {
        // Where the ray (major, u, v) meets the disc's plane, and how far from its centre.
        const Float4 t = height / (towards + c.normal[u] * at_u);
        const Float4 miss_m = t * major - c.offset[axis], miss_u = t * at_u - c.offset[u],
                     miss_v = t * at_v - c.offset[v];
        const Float4 miss2 = miss_m * miss_m + miss_u * miss_u + miss_v * miss_v;
        const Int4 hit = (t > 0.f) & (miss2 <= disc2);
        uint32_t hits = laneMask(hit) & ((2u << std::min(end - x, 3)) - 1);
        if (hits == 0) continue;
        // Discs of a plane overlap at the same distance: the one whose centre is nearer wins, and not
        // rounding.
        const Float4 distance2 = t * t * (length2 + at_u * at_u) * (1 + overlap / disc2 * miss2);
        for (; hits != 0; hits &= hits - 1) {
          const int k = std::countr_zero(hits);
          keep(bins, bin + static_cast<size_t>(k), distance2[k], c.link);
        }
      }
    }
  }

  int n_;
  float half_;
  bool footprint_;
};

}  // namespace limn::radiosity
