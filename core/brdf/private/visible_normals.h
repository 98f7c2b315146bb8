// Internal to core/brdf: functions on the unit square as grids of nodes with both edges, bilinear between
// them, and the distribution of visible normals among them, which stretches the square.
#pragma once

#include <algorithm>
#include <array>
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

/// A weighted mean of neighbours in a row of grids that stand for parameters.
struct Mix {
  std::array<std::size_t, 4> grids{};
  std::array<double, 4> weights{};
  std::size_t count = 2;

  /// Between two grids.
  Mix(const Cell& parameter)
      : grids{parameter.below, parameter.above}, weights{1 - parameter.share, parameter.share} {}
  /// Among the four around a place in two parameters, of which `fast` has `stride` nodes.
  Mix(const Cell& slow, const Cell& fast, std::size_t stride)
      : grids{slow.below * stride + fast.below, slow.below * stride + fast.above,
              slow.above * stride + fast.below, slow.above * stride + fast.above},
        weights{(1 - slow.share) * (1 - fast.share), (1 - slow.share) * fast.share,
                slow.share * (1 - fast.share), slow.share * fast.share},
        count(4) {}

  /// Returns the mean of value(grid).
  template <class Value>
  double of(const Value& value) const {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += weights[i] * value(grids[i]);
    return sum;
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

/// A density on the square for each node of one or two parameters, linear between nodes.
class LIMN_API VisibleNormals {
 public:
  VisibleNormals() = default;
  /// Takes `densities` one after the other, as many as fit; each is at least 0 and not 0 everywhere, and has
  /// two nodes or more a side. They need not be normalised.
  VisibleNormals(std::span<const double> densities, const GridSize& size);

  /// Returns what a warp that makes the density from a uniform one would have made `place` from, for the mean
  /// `mix` of densities: y by the distribution of rows, x within the row.
  glm::dvec2 invert(const glm::dvec2& place, const Mix& mix) const;

 private:
  GridSize size_;
  std::vector<double> densities_;  ///< their integrals are 1 where a cell has the area 1
  std::vector<double> rows_;       ///< integral of a row from its beginning to a node
  std::vector<double> columns_;    ///< integral of all rows from the first to a node
};

}  // namespace limn::brdf
