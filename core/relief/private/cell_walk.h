// Declares the walk of a line over the cells of a height field.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <limits>

namespace limn::relief {

/// Limits how far a line is followed, in larger sides of the field.
constexpr double kFarthestSizes = 64;

/// Visits the cells that the line `start + s direction`, s >= 0, crosses, in texels, one after the other:
/// those between `enter` and `leave`, which is infinite where the line stands still.
class CellWalk {
 public:
  CellWalk(const glm::dvec2& start, const glm::dvec2& direction) : start_(start), direction_(direction) {
    for (int axis = 0; axis < 2; ++axis) {
      const double at = std::floor(start[axis]);
      cell_[axis] = static_cast<int>(at);
      // A line that leaves a border downwards begins in the cell below it.
      if (direction[axis] < 0 && at == start[axis]) --cell_[axis];
    }
    findBorder(0);
    findBorder(1);
  }

  const glm::ivec2& cell() const { return cell_; }
  double enter() const { return enter_; }
  double leave() const { return std::fmin(border_.x, border_.y); }
  /// Returns where in its cell, [0, 1]^2 but for rounding, the line is at s.
  glm::dvec2 inside(double s) const { return start_ + s * direction_ - glm::dvec2(cell_); }

  void advance() {
    const int axis = border_.x <= border_.y ? 0 : 1;
    enter_ = border_[axis];
    cell_[axis] += direction_[axis] < 0 ? -1 : 1;
    findBorder(axis);
  }

 private:
  void findBorder(int axis) {
    const double rate = direction_[axis];
    const double border = static_cast<double>(cell_[axis] + (rate > 0 ? 1 : 0));
    border_[axis] = rate == 0 ? std::numeric_limits<double>::infinity() : (border - start_[axis]) / rate;
  }

  glm::dvec2 start_, direction_;
  glm::ivec2 cell_{0};
  double enter_ = 0;
  glm::dvec2 border_{0};
};

}  // namespace limn::relief
