#include "core/bench/ratio.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/render/frame_stats.h"

namespace limn::bench {
namespace {

constexpr int kResamples = 2000;

// The remainder is biased by less than 1e-5 for any number of samples that is timed, and the same everywhere.
std::size_t below(std::size_t limit, std::mt19937& random) {
  return random() % limit;
}

/// No turn is without a sample.
std::size_t turnsOf(const Samples& samples) {
  return std::clamp<std::size_t>(static_cast<std::size_t>(std::max(samples.turns, 1)), 1,
                                 samples.values.size());
}

double resampledMedian(const Samples& samples, std::mt19937& random, std::vector<double>& scratch) {
  const std::size_t count = samples.values.size(), turns = turnsOf(samples);
  scratch.clear();
  for (std::size_t i = 0; i < turns; ++i) {
    const std::size_t turn = turns > 1 ? below(turns, random) : 0;
    const std::size_t first = turn * count / turns, size = (turn + 1) * count / turns - first;
    for (std::size_t k = 0; k < size; ++k) scratch.push_back(samples.values[first + below(size, random)]);
  }
  return render::quartiles(scratch).median;
}

double median(const Samples& samples) {
  return render::quartiles({samples.values.begin(), samples.values.end()}).median;
}

/// The t within which 95 % of Student's distribution with 2 (turns - 1) degrees of freedom lie, from its sine
/// s, t = sqrt(df) s / sqrt(1 - s^2) (Abramowitz and Stegun, 26.7.4).
double studentT(std::size_t turns) {
  double low = 0, high = 1;
  for (int step = 0; step < 50; ++step) {
    const double s = (low + high) / 2;
    double sum = 0, term = 1;
    for (std::size_t k = 1; k < turns; ++k) {
      sum += term;
      term *= (1 - s * s) * (2 * static_cast<double>(k) - 1) / (2 * static_cast<double>(k));
    }
    (s * sum < 0.95 ? low : high) = s;
  }
  return std::sqrt(2 * static_cast<double>(turns - 1)) * low / std::sqrt(1 - low * low);
}

/// By how much the logarithms of an interval are widened that resampled turns give.
double widening(std::size_t turns) {
  constexpr double kNormal = 1.959964;
  if (turns < 2) return 1;
  const auto count = static_cast<double>(turns);
  return std::sqrt(count / (count - 1)) * studentT(turns) / kNormal;
}

}  // namespace

Ratio ratioOfMedians(const Samples& numerator, const Samples& denominator) {
  std::mt19937 random(1);
  std::vector<double> scratch, ratios(kResamples);
  for (double& ratio : ratios) {
    const double above = resampledMedian(numerator, random, scratch);
    ratio = above / resampledMedian(denominator, random, scratch);
  }
  std::sort(ratios.begin(), ratios.end());
  const double value = median(numerator) / median(denominator);
  const std::size_t turns = std::min(turnsOf(numerator), turnsOf(denominator));
  const double wider = widening(turns);
  const auto bound = [&](double ratio) { return value * std::pow(ratio / value, wider); };
  return {value, bound(ratios[kResamples / 40]), bound(ratios[kResamples - 1 - kResamples / 40]),
          static_cast<int>(turns)};
}

}  // namespace limn::bench
