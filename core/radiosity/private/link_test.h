// Internal to the construction of links: tests four elements against one receiver at once.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>

#include "core/radiosity/links.h"
#include "core/radiosity/private/float4.h"
#include "glsl/indirect/direction_bins.glsl"

namespace limn::radiosity {

inline Float4 lanes(const glm::vec4& v) {
  return load(&v.x);
}

/// Holds an element as the near end of links.
struct Receiver {
  glm::vec3 position{0}, normal{0};
  float radius = 0, spread = 0;
  float extent = 0;  ///< what counts as size when links are opened

  static Receiver of(const glsl::ElementGroup& g, uint32_t laneIndex) {
    const int k = static_cast<int>(laneIndex);
    return {.position = {g.x[k], g.y[k], g.z[k]},
            .normal = {g.nx[k], g.ny[k], g.nz[k]},
            .radius = g.radius[k],
            .spread = g.spread[k],
            .extent = std::max(g.area[k], g.radius[k] * g.radius[k])};
  }
};

/// Holds what is to be done with each lane of a group.
struct Decision {
  uint32_t link = 0;                  ///< store a link
  uint32_t open = 0;                  ///< try its children
  uint32_t defer = 0;                 ///< leave it to the receiver's children
  Float4 x, y, z, distance2, height;  ///< offset from the receiver; height: along the element's own normal
};

class LinkTest {
 public:
  explicit LinkTest(const LinkSettings& settings) : triangles_(settings.fill == Fill::triangles) {
    const float n = static_cast<float>(settings.resolution);
    const float angle = settings.opening * 4 / (n * n);
    angle2_ = angle * angle;
  }

  /// Decides what is done with the pairs of a group. Only pairs that face each other are taken (thesis: pairs
  /// that face away from each other are culled), conservatively for elements that stand for many. A grazing
  /// angle of 1e-4 counts as facing away.
  template <bool leaf>
  Decision decide(const Receiver& r, const glsl::ElementGroup& g) const {
    Decision d;
    d.x = lanes(g.x) - r.position.x;
    d.y = lanes(g.y) - r.position.y;
    d.z = lanes(g.z) - r.position.z;
    d.distance2 = d.x * d.x + d.y * d.y + d.z * d.z;
    d.height = d.x * lanes(g.nx) + d.y * lanes(g.ny) + d.z * lanes(g.nz);
    const Float4 above = d.x * r.normal.x + d.y * r.normal.y + d.z * r.normal.z;
    const Float4 distance = root(d.distance2);
    const Float4 reach = leaf ? lanes(g.radius) : lanes(g.radius) + r.radius;
    constexpr float grazing = 1e-4f;
    // A leaf's triangles rise above its centre by no more than twice what the disc of a third of them does.
    const Float4 rise = seenAsTriangles(g) ? reach + 2.f * lanes(g.disc) : reach;
    Int4 facing = above + rise + (leaf ? -grazing : r.spread - grazing) * distance > 0.f;
    if (g.backs == 0) facing &= reach + (lanes(g.spread) - grazing) * distance > d.height;
    const uint32_t visible = laneMask(facing) & ((1u << g.lanes) - 1);
    if (visible == 0) return d;

    // Solid angle of the bin: angle major^3 / distance^3; opened while that of the element, extent cosine /
    // distance^2, is more. Receivers' own tilt does not count: across it directions differ all the same.
    const Float4 major = greater(greater(magnitude(d.x), magnitude(d.y)), magnitude(d.z)),
                 major2 = major * major;
    const Float4 limit = angle2_ * major2 * major2 * major2;
    const Float4 radius = lanes(g.radius), extent = greater(lanes(g.area), radius * radius);
    if (g.children != glsl::no_link || !leaf) {
      const Float4 shown = lesser(magnitude(d.height) + lanes(g.spread) * distance, distance);
      const Int4 tooLarge = extent * extent * shown * shown >= limit;
      uint32_t deferrable = 0;
      if constexpr (!leaf) deferrable = laneMask(r.extent * r.extent * d.distance2 >= limit);
      if (g.children != glsl::no_link)
        d.open = laneMask(tooLarge) & (leaf ? 15 : laneMask(extent >= r.extent) | ~deferrable) & visible;
      d.defer = deferrable & ~d.open & visible;
    }
    const Int4 apart = d.distance2 > 1e-14f;
    d.link = visible & ~d.open & ~d.defer & laneMask(apart);
    if (g.backs != 0 && !seenAsTriangles(g)) d.link &= laneMask((d.height <= 0.f) | behind(d, g));
    return d;
  }

  /// Returns whether the group's elements are leaves that fill bins by their triangles.
  bool seenAsTriangles(const glsl::ElementGroup& g) const {
    return triangles_ && g.children == glsl::no_link;
  }
  /// Returns where a receiver is so far behind the discs that it sees their backs. Nearer than that,
  /// neighbours on one surface may seem to show them where normals bend more than triangles do.
  static Int4 behind(const Decision& d, const glsl::ElementGroup& g) {
    return (d.height > 0.1f * root(d.distance2)) & (d.height > lanes(g.disc));
  }

 private:
  bool triangles_;
  float angle2_;
};

}  // namespace limn::radiosity
