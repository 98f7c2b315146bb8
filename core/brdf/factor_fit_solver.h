// Declares sparse linear least squares by conjugate gradients.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/export.h"

namespace limn::brdf {

/// Is a system of equations in few unknowns each: row i says that the sum of `value` times the unknown of
/// `column`, over its entries, is `right`.
class LIMN_API SparseEquations {
 public:
  /// Adds a coefficient to the equation that `finish` ends.
  void add(int column, double value) {
    columns_.push_back(column);
    values_.push_back(value);
  }
  void finish(double right) {
    right_.push_back(right);
    ends_.push_back(columns_.size());
  }

  /// Returns the unknowns of the least sum of squares, from `start` on, and of least distance from it where
  /// the equations leave them free. Conjugate gradients on the normal equations, which are never formed
  /// (Hestenes and Stiefel 1952, CGLS); ends after `iterations` or where the gradient is `tolerance` of that
  /// at the start.
  std::vector<double> solve(std::vector<double> start, int iterations, double tolerance) const;

  std::size_t size() const { return ends_.size(); }

 private:
  std::vector<double> times(const std::vector<double>& unknowns) const;
  std::vector<double> transposedTimes(const std::vector<double>& rows, std::size_t unknowns) const;

  std::vector<int> columns_;
  std::vector<double> values_, right_;
  std::vector<std::size_t> ends_;  // of each row in columns_ and values_
};

}  // namespace limn::brdf
