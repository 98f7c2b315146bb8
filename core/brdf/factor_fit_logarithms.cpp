// Products of one- and two-dimensional factors, as sums of logarithms: McCool, Ang and Ahmad 2001,
// Homomorphic Factorization of BRDFs for High-Performance Rendering; with factors of the distribution's and
// Fresnel's angles compare Bagher, Snyder and Nowrouzezahrai 2016, A Non-Parametric Factor Microfacet Model
// for Isotropic BRDFs.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/brdf/factor_fit_kinds.h"
#include "core/brdf/factor_fit_solver.h"
#include "glsl/materials/factored.glsl"

namespace limn::brdf {
namespace {

using glm::dvec3;
using glm::ivec3;
using glm::vec2;
using glm::vec3;

/// What is added to f before its logarithm is taken, over f's mean: zeros get a place among the values.
constexpr double kLeastShare = 1e-4;
/// Share of the mean below which values lose weight.
constexpr double kSmallShare = 1e-2;
/// Weight of a factor's second differences over that of the samples; it leads factors on where no sample is.
constexpr double kSmoothness = 0.03;

/// A share of a texel in the sum of logarithms.
struct Share {
  int texel;
  double weight;
};
using Shares = std::vector<Share>;  // of one sample

/// The axes of the logarithms of one product: texels of a factor lie beside each other, factors behind each
/// other, Fresnel's row of dfg_disc behind the discs; products follow each other.
struct Layout {
  Factorisation factorisation;
  bool warped;
  ivec3 size;  ///< without that row

  bool disc() const { return size.z > 1; }
  bool fresnel() const {
    return factorisation == Factorisation::dfg || factorisation == Factorisation::dfg_disc;
  }
  int factors() const { return fresnel() ? 4 : 3; }  ///< of the product: p or G is taken twice
  int tableCount() const { return size.x * size.y * size.z; }
  int rowCount() const { return factorisation == Factorisation::dfg_disc ? size.x : 0; }
  int count() const { return tableCount() + rowCount(); }
};

Layout layoutOf(const FitSettings& settings) {
  const int n = settings.texels;
  switch (settings.factorisation) {
    case Factorisation::pqp_disc:
    case Factorisation::dfg_disc:
      return {settings.factorisation, settings.warped, {n, n, 2}};
    case Factorisation::pqp:
      return {settings.factorisation, settings.warped, {n, 2, 1}};
    default:
      return {settings.factorisation, settings.warped, {n, 3, 1}};
  }
}

void addLine(Shares& shares, const Layout& layout, int row, float place) {
  const double x = static_cast<double>(place) * (layout.size.x - 1);
  const int low = std::clamp(static_cast<int>(x), 0, layout.size.x - 2);
  shares.push_back({row * layout.size.x + low, 1 - (x - low)});
  shares.push_back({row * layout.size.x + low + 1, x - low});
}

void addDisc(Shares& shares, const Layout& layout, int layer, const vec2& place) {
  const dvec3 p = dvec3(place, 0) * static_cast<double>(layout.size.x - 1);
  const int x = std::clamp(static_cast<int>(p.x), 0, layout.size.x - 2);
  const int y = std::clamp(static_cast<int>(p.y), 0, layout.size.y - 2);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i)
      shares.push_back({(layer * layout.size.y + y + j) * layout.size.x + x + i,
                        (i ? p.x - x : 1 - (p.x - x)) * (j ? p.y - y : 1 - (p.y - y))});
}

/// The texels that factored_dfg_response, factored_pqp_response, factored_pqp_disc_response or
/// factored_dfg_disc_response takes the sum of, for their first product.
Shares sharesOf(const Layout& layout, const BrdfSample& sample) {
  const vec3 n(0, 0, 1), l(sample.l), v(sample.v);
  const glsl::FactoredAngles a = glsl::factored_angles(n, v, l);
  const float ofL = glsl::factored_cosine_place(a.n_dot_l), ofV = glsl::factored_cosine_place(a.n_dot_v);
  Shares shares;
  if (layout.disc()) {
    addDisc(shares, layout, 0, glsl::factored_disc_place(l, false));
    addDisc(shares, layout, 1, glsl::factored_disc_place(glsl::factored_half(n, v, l), layout.warped));
    addDisc(shares, layout, 0, glsl::factored_disc_place(v, false));
    if (layout.fresnel()) addLine(shares, layout, 2 * layout.size.y, glsl::factored_cosine_place(a.l_dot_h));
    return shares;
  }
  const bool fresnel = layout.fresnel();
  addLine(shares, layout, fresnel ? 0 : 1, glsl::factored_half_place(a));
  if (fresnel) addLine(shares, layout, 1, glsl::factored_cosine_place(a.l_dot_h));
  addLine(shares, layout, fresnel ? 2 : 0, ofL);
  addLine(shares, layout, fresnel ? 2 : 0, ofV);
  return shares;
}

/// The logarithm of the product whose texels begin at `first`.
double sumOf(const Shares& shares, const std::vector<double>& logs, int first) {
  double sum = 0;
  for (const Share& share : shares) sum += share.weight * logs[static_cast<std::size_t>(first + share.texel)];
  return sum;
}

/// Calls `add(a, b, c)` for all texels beside each other along an axis of a factor of one product.
template <typename Add>
void forTriples(const Layout& layout, const Add& add) {
  const int nx = layout.size.x, ny = layout.size.y;
  for (int row = 0; row < layout.count() / nx; ++row)
    for (int x = 1; x + 1 < nx; ++x) add(row * nx + x - 1, row * nx + x, row * nx + x + 1);
  if (!layout.disc()) return;
  for (int layer = 0; layer < layout.size.z; ++layer)
    for (int y = 1; y + 1 < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        const int middle = (layer * ny + y) * nx + x;
        add(middle - nx, middle, middle + nx);
      }
}

class ChannelFit {
 public:
  /// Fits what samples have above `floor`.
  ChannelFit(const Layout& layout, const std::vector<BrdfSample>& samples, const std::vector<Shares>& shares,
             int channel, double floor)
      : layout_(layout), samples_(samples), shares_(shares) {
    for (const BrdfSample& sample : samples) {
      target_.push_back(sample.f[channel] - floor);
      mean_ += std::max(target_.back(), 0.0) / static_cast<double>(samples.size());
    }
    smoothness_ = kSmoothness * std::sqrt(static_cast<double>(samples.size()) / layout.count());
  }

  double mean() const { return mean_; }
  const std::vector<double>& logs() const { return logs_; }

  /// Least squares of the logarithms of what the samples have above `diffuse`.
  void solveLogarithms(double diffuse) {
    SparseEquations equations;
    double sum = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const double f = std::max(target_[i] - diffuse, 0.0);
      const double right = std::log(f + kLeastShare * mean_);
      const double w = logarithmWeight(i, f);
      for (const Share& share : shares_[i]) equations.add(share.texel, w * share.weight);
      equations.finish(w * right);
      sum += right;
    }
    addSmoothness(equations, nullptr);
    logs_.assign(static_cast<std::size_t>(layout_.count()),
                 sum / static_cast<double>(samples_.size()) / layout_.factors());
    logs_ = equations.solve(std::move(logs_), 400, 1e-9);
  }

  /// Adds a product that is `diffuse` everywhere. Next to nothing becomes a small share of the mean, from
  /// which refinement leads on.
  void addProduct(double diffuse) {
    ++products_;
    logs_.resize(logs_.size() + static_cast<std::size_t>(layout_.count()),
                 std::log(std::max(diffuse, kSmallShare * mean_)) / layout_.factors());
  }

  /// Gauss-Newton (Levenberg and Marquardt's damping) on the error of f n.l n.v over f + mean.
  void refine() {
    double damping = 1e-3, least = objective(logs_);
    for (int i = 0; i < 12 && damping < 1e3; ++i) {
      const std::vector<double> next = stepped(damping);
      const double value = objective(next);
      if (value < least) {
        const bool still = value > 0.9995 * least;
        logs_ = next;
        least = value;
        damping *= 0.2;
        if (still) return;
      } else {
        damping *= 10;
      }
    }
  }

 private:
  /// Grazing angles count by the cosines, in which f n.l and its counterpart of v vanish; what a floor left
  /// little of, by its share, since its logarithm is that of a rounding error.
  double logarithmWeight(std::size_t i, double f) const {
    return std::sqrt(samples_[i].l.z * samples_[i].v.z * f / (f + kSmallShare * mean_));
  }
  double weight(std::size_t i) const {
    return samples_[i].l.z * samples_[i].v.z / (std::max(target_[i], 0.0) + mean_);
  }
  /// The value of the product whose texels begin at `first`; a step that would overflow is as bad as any.
  double product(std::size_t i, const std::vector<double>& logs, int first) const {
    return std::exp(std::min(sumOf(shares_[i], logs, first), 80.0));
  }
  /// Calls `add(first)` for the first texel of each product.
  template <typename Add>
  void forProducts(const Add& add) const {
    for (int k = 0; k < products_; ++k) add(k * layout_.count());
  }
  double value(std::size_t i, const std::vector<double>& logs) const {
    double sum = 0;
    forProducts([&](int first) { sum += product(i, logs, first); });
    return sum;
  }

  double objective(const std::vector<double>& logs) const {
    double sum = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const double r = weight(i) * (value(i, logs) - target_[i]);
      sum += r * r;
    }
    forProductTriples([&](int a, int b, int c) {
      const double r = refinedSmoothness() * bend(logs, a, b, c);
      sum += r * r;
    });
    return sum;
  }

  std::vector<double> stepped(double damping) const {
    SparseEquations equations;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const double w = weight(i);
      double f = 0;
      forProducts([&](int first) {
        const double part = product(i, logs_, first);
        for (const Share& share : shares_[i]) equations.add(first + share.texel, w * part * share.weight);
        f += part;
      });
      equations.finish(-w * (f - target_[i]));
    }
    addSmoothness(equations, &logs_);
    const double size = damping * std::sqrt(static_cast<double>(samples_.size()) / layout_.count());
    for (int texel = 0; texel < products_ * layout_.count(); ++texel) {
      equations.add(texel, size);
      equations.finish(0);
    }
    std::vector<double> next = equations.solve(std::vector<double>(logs_.size(), 0), 200, 1e-5);
    for (std::size_t i = 0; i < next.size(); ++i) next[i] += logs_[i];
    return next;
  }

  template <typename Add>
  void forProductTriples(const Add& add) const {
    forProducts([&](int first) {
      forTriples(layout_, [&](int a, int b, int c) { add(first + a, first + b, first + c); });
    });
  }

  static double bend(const std::vector<double>& logs, int a, int b, int c) {
    return logs[static_cast<std::size_t>(a)] - 2 * logs[static_cast<std::size_t>(b)] +
           logs[static_cast<std::size_t>(c)];
  }
  /// Residuals of the refinement are smaller than those of logarithms.
  double refinedSmoothness() const { return 0.1 * smoothness_; }

  /// Asks for second differences of 0: of the logarithms themselves, or of a step from `logs`.
  void addSmoothness(SparseEquations& equations, const std::vector<double>* logs) const {
    const double size = logs ? refinedSmoothness() : smoothness_;
    forProductTriples([&](int a, int b, int c) {
      equations.add(a, size);
      equations.add(b, -2 * size);
      equations.add(c, size);
      equations.finish(logs ? -size * bend(*logs, a, b, c) : 0);
    });
  }

  Layout layout_;
  const std::vector<BrdfSample>& samples_;
  const std::vector<Shares>& shares_;
  std::vector<double> target_, logs_;
  double mean_ = 0, smoothness_ = 0;
  int products_ = 1;
};

/// Moves each factor to 0 at the brightest sample, around which formats are finest, and returns what this
/// takes out: the value there of the product that is largest. Factors of another are moved to an equal part
/// each of the logarithm of what it is there over the largest. Texels that no sample holds may have run away;
/// bounded, no product of four overflows.
double takeScale(std::vector<double>& logs, const Layout& layout, const Shares& brightest) {
  const int each = layout.size.x * (layout.disc() ? layout.size.y : 1), count = layout.count();
  const int products = static_cast<int>(logs.size()) / count;
  double largest = sumOf(brightest, logs, 0);
  for (int k = 1; k < products; ++k) largest = std::max(largest, sumOf(brightest, logs, k * count));
  for (int k = 0; k < products; ++k) {
    const int first = k * count;
    std::array<double, 3> sum{}, weight{};
    for (const Share& share : brightest) {
      const auto factor = static_cast<std::size_t>(share.texel / each);
      sum[factor] += share.weight * logs[static_cast<std::size_t>(first + share.texel)];
      weight[factor] += share.weight;
    }
    const double kept = (sumOf(brightest, logs, first) - largest) / layout.factors();
    for (int i = 0; i < count; ++i) {
      const auto factor = static_cast<std::size_t>(i / each);
      double& log = logs[static_cast<std::size_t>(first + i)];
      log = std::clamp(log - sum[factor] / weight[factor] + kept, -60.0, 15.0);
    }
  }
  return std::exp(largest);
}

std::string nameOf(const Layout& layout, const FitSettings& settings) {
  std::string name = layout.fresnel() ? "dfg" : "pqp";
  name += fmt::format(" {}", settings.texels);
  if (layout.disc()) name += fmt::format(" x {}{}", settings.texels, settings.warped ? ", warped" : "");
  return settings.terms > 1 ? fmt::format("{}, {} terms", name, settings.terms) : name;
}

/// The texels of all products as the tables of a fit, products behind each other: Fresnel's row of dfg_disc
/// has a table of its own.
std::vector<FactorTable> tablesOf(const Layout& layout, const std::vector<vec3>& texels,
                                  const FitSettings& settings) {
  std::vector<FactorTable> tables{
      {layout.size.x, layout.size.y, layout.size.z * settings.terms, settings.format, {}}};
  if (layout.rowCount() > 0) tables.push_back({layout.size.x, 1, settings.terms, settings.format, {}});
  for (auto product = texels.begin(); product != texels.end(); product += layout.count()) {
    const auto row = product + layout.tableCount();
    tables.front().texels.insert(tables.front().texels.end(), product, row);
    tables.back().texels.insert(tables.back().texels.end(), row, product + layout.count());
  }
  for (FactorTable& table : tables) table.round();
  return tables;
}

/// The sample that reflects most, grazing angles counted by their cosines.
std::size_t brightestOf(const std::vector<BrdfSample>& samples, int channel) {
  const auto power = [&](const BrdfSample& sample) { return sample.f[channel] * sample.l.z * sample.v.z; };
  return static_cast<std::size_t>(
      std::max_element(samples.begin(), samples.end(),
                       [&](const BrdfSample& a, const BrdfSample& b) { return power(a) < power(b); }) -
      samples.begin());
}

}  // namespace

FactoredBrdf fitLogarithms(const std::vector<BrdfSample>& samples, const FitSettings& settings,
                           const dvec3& floor) {
  const Layout layout = layoutOf(settings);
  std::vector<Shares> shares;
  shares.reserve(samples.size());
  for (const BrdfSample& sample : samples) shares.push_back(sharesOf(layout, sample));

  FactoredBrdf fit;
  fit.factorisation = settings.factorisation;
  fit.warped = settings.warped;
  fit.floor = floor;
  fit.name = nameOf(layout, settings);
  const dvec3 diffuse = settings.terms > 1 ? diffuseFloor(samples) - floor : dvec3(0);
  std::vector<vec3> texels(static_cast<std::size_t>(layout.count() * settings.terms), vec3(0));
  // Channels have nothing in common but the samples.
  tbb::parallel_for(0, 3, [&](int c) {
    ChannelFit channel(layout, samples, shares, c, floor[c]);
    if (!(channel.mean() > 1e-9 * floor[c])) {  // the floor is all there is
      fit.scale[c] = 0;
      return;
    }
    channel.solveLogarithms(diffuse[c]);
    if (settings.terms > 1) channel.addProduct(diffuse[c]);
    if (settings.refine) channel.refine();
    std::vector<double> logs = channel.logs();
    fit.scale[c] = takeScale(logs, layout, shares[brightestOf(samples, c)]);
    for (std::size_t i = 0; i < logs.size(); ++i) texels[i][c] = static_cast<float>(logs[i]);
  });
  fit.tables = tablesOf(layout, texels, settings);
  return fit;
}

}  // namespace limn::brdf
