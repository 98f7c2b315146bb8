// Sums of products of a function of the half vector and one of the difference: Kautz and McCool 1999,
// Interactive Rendering with Arbitrary BRDFs using Separable Approximations.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/brdf/factor_fit_kinds.h"
#include "core/brdf/factor_fit_spread.h"

namespace limn::brdf {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr int kRounds = 60;

/// The directions of a disc's texels (see factored_disc_place); beyond the rim that of the rim.
std::vector<dvec3> discDirections(int side, bool warped) {
  std::vector<dvec3> directions;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      dvec2 p = dvec2(2.0 * x, 2.0 * y) / static_cast<double>(side - 1) - 1.0;
      if (warped) p *= glm::length(p);
      const double radius = glm::length(p);
      if (radius > 1) p /= radius;
      const double r2 = glm::dot(p, p);
      directions.emplace_back(2.0 * p / (1 + r2), (1 - r2) / (1 + r2));
    }
  return directions;
}

/// A matrix of half vectors (rows) by differences (columns), of which some entries are unknown. Rows and
/// columns without any known entry are 0, and so are their factors: they have no part in the others'.
class PartialMatrix {
 public:
  explicit PartialMatrix(std::size_t side) : side_(side), values_(side * side, 0), known_(side * side, 0) {}

  void set(std::size_t row, std::size_t column, double value) {
    values_[row * side_ + column] = value;
    known_[row * side_ + column] = 1;
  }

  /// Says of each row, or column, whether any of its entries is known.
  std::vector<char> knownRows() const {
    std::vector<char> rows(side_, 0);
    for (std::size_t i = 0; i < known_.size(); ++i)
      if (known_[i]) rows[i / side_] = 1;
    return rows;
  }
  std::vector<char> knownColumns() const {
    std::vector<char> columns(side_, 0);
    for (std::size_t i = 0; i < known_.size(); ++i)
      if (known_[i]) columns[i % side_] = 1;
    return columns;
  }

  /// Factors of the nearest matrix of rank `terms`, term after term: one round of subspace iteration, then
  /// unknown entries are taken from the product, until both stand still. Returns the columns' factors, and
  /// the rows' in `rows`.
  std::vector<double> factors(int terms, std::vector<double>& rows) {
    const auto rank = static_cast<std::size_t>(terms);
    const std::vector<char> known = knownColumns();
    std::vector<double> columns(rank * side_, 0);
    for (std::size_t k = 0; k < rank;
         ++k)  // independent vectors of which none is orthogonal to all of the matrix
      for (std::size_t i = 0; i < side_; ++i)
        if (known[i])
          columns[k * side_ + i] =
              1 + std::cos(static_cast<double>(k * (2 * i + 1)) * 1.7 / static_cast<double>(side_));
    rows.assign(rank * side_, 0);
    fillUnknown();
    for (int round = 0; round < kRounds; ++round) {
      orthonormalise(columns, rank);
      multiply(columns, rows, rank, false);
      impute(columns, rows, rank);
      std::vector<double> basis = rows;
      orthonormalise(basis, rank);
      multiply(basis, columns, rank, true);
    }
    orthonormalise(columns, rank);
    multiply(columns, rows, rank, false);
    return columns;
  }

 private:
  /// Unknown entries start as the mean of the known ones of their row.
  void fillUnknown() {
    const std::vector<char> columns = knownColumns();
    for (std::size_t i = 0; i < side_; ++i) {
      double sum = 0;
      std::size_t count = 0;
      for (std::size_t j = i * side_; j < (i + 1) * side_; ++j)
        if (known_[j]) {
          sum += values_[j];
          ++count;
        }
      for (std::size_t j = i * side_; j < (i + 1) * side_; ++j)
        if (!known_[j])
          values_[j] = count > 0 && columns[j - i * side_] ? sum / static_cast<double>(count) : 0;
    }
  }

  /// to = matrix * from, or with the matrix transposed, vector by vector.
  void multiply(const std::vector<double>& from, std::vector<double>& to, std::size_t rank,
                bool transposed) const {
    std::fill(to.begin(), to.end(), 0);
    for (std::size_t k = 0; k < rank; ++k) {
      const double* in = &from[k * side_];
      double* out = &to[k * side_];
      for (std::size_t i = 0; i < side_; ++i) {
        const double* line = &values_[i * side_];
        double sum = 0;
        for (std::size_t j = 0; j < side_; ++j)
          if (transposed)
            out[j] += line[j] * in[i];
          else
            sum += line[j] * in[j];
        if (!transposed) out[i] = sum;
      }
    }
  }

  void impute(const std::vector<double>& columns, const std::vector<double>& rows, std::size_t rank) {
    for (std::size_t i = 0; i < side_; ++i)
      for (std::size_t j = 0; j < side_; ++j) {
        if (known_[i * side_ + j]) continue;
        double sum = 0;
        for (std::size_t k = 0; k < rank; ++k) sum += rows[k * side_ + i] * columns[k * side_ + j];
        values_[i * side_ + j] = sum;
      }
  }

  /// Gram and Schmidt, twice; vectors that vanish become 0.
  void orthonormalise(std::vector<double>& vectors, std::size_t rank) const {
    for (std::size_t k = 0; k < rank; ++k) {
      double* x = &vectors[k * side_];
      const double before = norm(x);
      for (int pass = 0; pass < 2; ++pass)
        for (std::size_t other = 0; other < k; ++other) {
          const double* y = &vectors[other * side_];
          double sum = 0;
          for (std::size_t i = 0; i < side_; ++i) sum += x[i] * y[i];
          for (std::size_t i = 0; i < side_; ++i) x[i] -= sum * y[i];
        }
      const double after = norm(x);
      const double factor = after > 1e-12 * before && after > 0 ? 1 / after : 0;
      for (std::size_t i = 0; i < side_; ++i) x[i] *= factor;
    }
  }
  double norm(const double* x) const {
    double sum = 0;
    for (std::size_t i = 0; i < side_; ++i) sum += x[i] * x[i];
    return std::sqrt(sum);
  }

  std::size_t side_;
  std::vector<double> values_;
  std::vector<char> known_;
};

/// Puts a channel of `factors` into a table of layers, over its largest size, and returns that.
double store(FactorTable& table, int channel, const std::vector<double>& factors) {
  double largest = 0;
  for (double x : factors) largest = std::max(largest, std::abs(x));
  if (!(largest > 0)) return 0;
  for (std::size_t i = 0; i < factors.size(); ++i)
    table.texels[i][channel] = static_cast<float>(factors[i] / largest);
  return largest;
}

/// Leads all layers on to the texels of which nothing is known.
void spreadLayers(FactorTable& table, const std::vector<char>& known) {
  std::vector<char> all;
  for (int layer = 0; layer < table.depth; ++layer) all.insert(all.end(), known.begin(), known.end());
  spread(table, all, 2);
}

}  // namespace

FactoredBrdf fitSvd(const Brdf& brdf, const FitSettings& settings, const dvec3& floor) {
  if (settings.texels > kMostSvdTexels)
    throw UsageError(fmt::format("svd has {} texels along an axis: 2 to {} are possible", settings.texels,
                                 kMostSvdTexels));
  const std::vector<dvec3> halves = discDirections(settings.texels, true);
  const std::vector<dvec3> differences = discDirections(settings.texels, false);
  const std::size_t side = halves.size();
  std::vector<PartialMatrix> matrices(3, PartialMatrix(side));
  for (std::size_t i = 0; i < side; ++i)
    for (std::size_t j = 0; j < side; ++j) {
      dvec3 l, v;
      directionsOf(halves[i], differences[j], l, v);
      if (!(l.z > 1e-3 && v.z > 1e-3)) continue;
      const dvec3 f = brdf(l, v);
      if (!finite(f)) continue;
      for (int c = 0; c < 3; ++c)
        matrices[static_cast<std::size_t>(c)].set(i, j, std::max(f[c], 0.0) - floor[c]);
    }
  FactoredBrdf fit;
  fit.factorisation = Factorisation::svd;
  fit.floor = floor;
  fit.name = fmt::format("svd {} x {}, {} term{}", settings.texels, settings.texels, settings.terms,
                         settings.terms == 1 ? "" : "s");
  const FactorTable empty{
      settings.texels, settings.texels, settings.terms, settings.format,
      std::vector<glm::vec3>(side * static_cast<std::size_t>(settings.terms), glm::vec3(0))};
  fit.tables.assign(2, empty);
  tbb::parallel_for(0, 3, [&](int c) {
    std::vector<double> rows;
    const std::vector<double> columns = matrices[static_cast<std::size_t>(c)].factors(settings.terms, rows);
    fit.scale[c] = store(fit.tables[0], c, rows) * store(fit.tables[1], c, columns);
  });
  spreadLayers(fit.tables[0], matrices[0].knownRows());
  spreadLayers(fit.tables[1], matrices[0].knownColumns());
  for (FactorTable& table : fit.tables) table.round();
  return fit;
}

}  // namespace limn::brdf
