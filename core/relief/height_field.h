// Declares the heights of a bump map over its flat base, as shadows and interreflection of bumps read them.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"

namespace limn::relief {

/// Says what lies beyond the last texel: the first one again, or the last one for ever.
enum class Wrap { periodic, clamped };

/// Is one cell of a bilinear field, between four texel centres: z = corner + slope.x a + slope.y b + twist a
/// b over a, b of [0, 1].
struct Patch {
  double corner;
  glm::dvec2 slope;
  double twist;

  double at(const glm::dvec2& ab) const {
    return corner + slope.x * ab.x + slope.y * ab.y + twist * ab.x * ab.y;
  }
};

/// Is a field of heights in metres over the base plane, bilinear between texel centres. Places are in texels:
/// texel (i, j) has its centre at (i, j). Directions are in metres along (T, B, N), where T follows u, B
/// follows v and N leaves the base.
class LIMN_API HeightField {
 public:
  /// Takes `values`, x running fastest, as heights scale * value + offset; the map spans `tile` metres along
  /// u and v. Throws Error for a size below 1, values that are not as many as texels, a value that is no
  /// number or infinite, a scale or an offset that is not finite, heights beyond 32 bits, and a tile that is
  /// not positive and finite.
  HeightField(const glm::ivec2& size, const std::vector<float>& values, const glm::dvec2& tile,
              double scale = 1, double offset = 0, Wrap wrap = Wrap::periodic);

  const glm::ivec2& size() const { return size_; }
  /// Returns the place, in texels, of a texture coordinate: (0, 0) is the corner of texel (0, 0), half a
  /// texel from its centre.
  glm::dvec2 place(const glm::dvec2& uv) const { return uv * glm::dvec2(size_) - 0.5; }
  Wrap wrap() const { return wrap_; }
  std::size_t texels() const { return heights_.size(); }
  /// Returns the metres from texel to texel.
  const glm::dvec2& spacing() const { return spacing_; }
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }

  /// Returns the height of a texel, which may lie outside of the map.
  double texel(const glm::ivec2& at) const { return heights_[index(at)]; }
  /// Returns the bilinear height at a place.
  double height(const glm::dvec2& place) const;
  /// Returns the cell whose lowest corner is the given texel.
  Patch patch(const glm::ivec2& cell) const;
  /// Returns the mean slope of the four cells that meet at a texel's centre: dz over metres along u and v.
  glm::dvec2 slope(const glm::ivec2& at) const;
  /// Returns the unit normal at a texel's centre, where four cells meet: that of their mean slope.
  glm::dvec3 normal(const glm::ivec2& at) const;
  /// Returns the slope, dz over metres along the base, of the steepest place of all cells.
  double steepest() const;
  /// Returns the number of a texel, which may lie outside of the map, among those inside.
  std::size_t index(const glm::ivec2& at) const;

 private:
  glm::ivec2 size_;
  Wrap wrap_;
  glm::dvec2 spacing_;
  std::vector<double> heights_;
  double lowest_ = 0, highest_ = 0;
};

}  // namespace limn::relief
