#include "core/brdf/factor_fit_solver.h"

#include <cmath>
#include <numeric>

namespace limn::brdf {
namespace {

double squared(const std::vector<double>& x) {
  return std::inner_product(x.begin(), x.end(), x.begin(), 0.0);
}

void addScaled(std::vector<double>& x, double factor, const std::vector<double>& y) {
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += factor * y[i];
}

}  // namespace

std::vector<double> SparseEquations::times(const std::vector<double>& unknowns) const {
  std::vector<double> rows(size());
  std::size_t entry = 0;
  for (std::size_t row = 0; row < size(); ++row) {
    double sum = 0;
    for (; entry < ends_[row]; ++entry)
      sum += values_[entry] * unknowns[static_cast<std::size_t>(columns_[entry])];
    rows[row] = sum;
  }
  return rows;
}

std::vector<double> SparseEquations::transposedTimes(const std::vector<double>& rows,
                                                     std::size_t unknowns) const {
  std::vector<double> result(unknowns, 0);
  std::size_t entry = 0;
  for (std::size_t row = 0; row < size(); ++row)
    for (; entry < ends_[row]; ++entry)
      result[static_cast<std::size_t>(columns_[entry])] += values_[entry] * rows[row];
  return result;
}

std::vector<double> SparseEquations::solve(std::vector<double> start, int iterations,
                                           double tolerance) const {
  // Unknowns are scaled to columns of equal length, without which texels that few samples meet converge last.
  const std::size_t count = start.size();
  std::vector<double> length(count, 0);
  for (std::size_t entry = 0; entry < columns_.size(); ++entry)
    length[static_cast<std::size_t>(columns_[entry])] += values_[entry] * values_[entry];
  for (double& x : length) x = x > 0 ? 1 / std::sqrt(x) : 0;
  const auto scaled = [&](std::vector<double> x) {
    for (std::size_t i = 0; i < count; ++i) x[i] *= length[i];
    return x;
  };

  std::vector<double> residual = right_;
  addScaled(residual, -1, times(start));
  std::vector<double> gradient = scaled(transposedTimes(residual, count));
  std::vector<double> direction = gradient, step(count, 0);
  double norm = squared(gradient);
  const double enough = tolerance * tolerance * norm;
  for (int i = 0; i < iterations && norm > enough; ++i) {
    const std::vector<double> along = times(scaled(direction));
    const double curvature = squared(along);
    if (!(curvature > 0)) break;
    const double size = norm / curvature;
    addScaled(step, size, direction);
    addScaled(residual, -size, along);
    gradient = scaled(transposedTimes(residual, count));
    const double next = squared(gradient);
    for (std::size_t j = 0; j < count; ++j) direction[j] = gradient[j] + next / norm * direction[j];
    norm = next;
  }
  addScaled(start, 1, scaled(step));
  return start;
}

}  // namespace limn::brdf
