// Internal to core/brdf: functions on the unit square as grids of nodes with both edges, bilinear between
// them, and the distribution of visible normals among them, which stretches the square.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/base/export.h"

namespace limn::brdf {

/// A number in [0, 1] between two of `count` nodes that divide it evenly.
struct Cell {
  std::size_t below = 0, above = 0;
  double share = 0;  ///< of the node above

  Cell(double u, std::size_t count) {
    const double at = std::clamp(u, 0.0, 1.0) * static_cast<double>(count - 1);
    below = std::min(static_cast<std::size_t>(at), count > 1 ? count - 2 : 0);
    above = std::min(below + 1, count - 1);
    share = at - static_cast<double>(below);
  }
};

/// The sizes of a grid: x varies fastest.
struct GridSize {
  std::size_t width = 0, height = 0;
  std::size_t count() const { return width * height; }
};

template <class Number>
double bilinear(std::span<const Number> grid, const GridSize& size, const Cell& x, const Cell& y) {
  const auto row = [&](std::size_t at) {
    const Number* values = grid.data() + at * size.width;
    return (1 - x.share) * static_cast<double>(values[x.below]) +
           x.share * static_cast<double>(values[x.above]);
  };
  return (1 - y.share) * row(y.below) + y.share * row(y.above);
}

/// A density on the square for each of a row of parameters, linear between parameters.
class LIMN_API VisibleNormals {
 public:
  VisibleNormals() = default;
  /// Takes `densities` one after the other, as many as fit; each is at least 0 and not 0 everywhere, and has
  /// two nodes or more a side. They need not be normalised.
  VisibleNormals(std::span<const double> densities, const GridSize& size);

  /// Returns what a warp that makes the density from a uniform one would have made `place` from, for the mean
  /// of two parameters' densities, of which the second has the weight `parameter.share`: y by the
  /// distribution of rows, x within the row.
  glm::dvec2 invert(const glm::dvec2& place, const Cell& parameter) const;

 private:
  GridSize size_;
  std::vector<double> densities_;  ///< their integrals are 1 where a cell has the area 1
  std::vector<double> rows_;       ///< integral of a row from its beginning to a node
  std::vector<double> columns_;    ///< integral of all rows from the first to a node
};

}  // namespace limn::brdf
