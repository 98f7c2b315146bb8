#include "core/bench/ratio.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "core/render/frame_stats.h"

namespace limn::bench {
namespace {

constexpr int kResamples = 2000;

// The remainder is biased by less than 1e-5 for any number of samples that is timed, and the same everywhere.
std::size_t below(std::size_t limit, std::mt19937& random) {
  return random() % limit;
}

/// The sample within what clocks tell, from a nanosecond to some years: rows of unknown origin may hold any
/// number, and two times of 0 would have a ratio that compares with none.
double plausible(double ms) {
  constexpr double kLeast = 1e-6, kMost = 1e12;
  return ms > kLeast ? std::min(ms, kMost) : kLeast;
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
    for (std::size_t k = 0; k < size; ++k)
      scratch.push_back(plausible(samples.values[first + below(size, random)]));
  }
  return render::quartiles(scratch).median;
}

double median(const Samples& samples) {
  std::vector<double> values(samples.values.begin(), samples.values.end());
  std::ranges::transform(values, values.begin(), plausible);
  return render::quartiles(std::move(values)).median;
}

/// The share of Student's distribution that lies within t, which is sqrt(degrees) s / sqrt(1 - s^2)
/// (Abramowitz and Stegun, 26.7.3 and 26.7.4).
double studentShare(std::size_t degrees, double s) {
  const double square = 1 - s * s;  // of the cosine
  const bool odd = degrees % 2 != 0;
  double sum = 0, term = s;
  if (odd) term *= std::sqrt(square);
  for (std::size_t k = 1; 2 * k <= degrees - (odd ? 1 : 0); ++k) {
    sum += term;
    const double even = 2 * static_cast<double>(k);
    term *= square * (odd ? even / (even + 1) : (even - 1) / even);
  }
  return odd ? 2 / std::numbers::pi * (std::asin(s) + sum) : sum;
}

/// The t within which 95 % of Student's distribution lie.
double studentT(std::size_t degrees) {
  double low = 0, high = 1;
  for (int step = 0; step < 50; ++step) {
    const double s = (low + high) / 2;
    (studentShare(degrees, s) < 0.95 ? low : high) = s;
  }
  return std::sqrt(static_cast<double>(degrees)) * low / std::sqrt(1 - low * low);
}

/// By how much the logarithms of an interval are widened that the resampled turns of so many sides give.
double widening(std::size_t turns, std::size_t sides) {
  constexpr double kNormal = 1.959964;
  if (turns < 2) return 1;
  const auto count = static_cast<double>(turns);
  return std::sqrt(count / (count - 1)) * studentT(sides * (turns - 1)) / kNormal;
}

/// The value with the interval that its resamples give.
Ratio widened(double value, std::vector<double> resamples, std::size_t turns, std::size_t sides) {
  std::sort(resamples.begin(), resamples.end());
  const double wider = widening(turns, sides);
  const auto bound = [&](double resample) { return value * std::pow(resample / value, wider); };
  return {value, bound(resamples[kResamples / 40]), bound(resamples[kResamples - 1 - kResamples / 40]),
          static_cast<int>(turns)};
}

}  // namespace

Ratio ratioOfMedians(const Samples& numerator, const Samples& denominator) {
  std::mt19937 random(1);
  std::vector<double> scratch, ratios(kResamples);
  for (double& ratio : ratios) {
    const double above = resampledMedian(numerator, random, scratch);
    ratio = above / resampledMedian(denominator, random, scratch);
  }
  return widened(median(numerator) / median(denominator), std::move(ratios),
                 std::min(turnsOf(numerator), turnsOf(denominator)), 2);
}

Ratio medianWithInterval(const Samples& samples) {
  std::mt19937 random(1);
  std::vector<double> scratch, medians(kResamples);
  for (double& resampled : medians) resampled = resampledMedian(samples, random, scratch);
  return widened(median(samples), std::move(medians), turnsOf(samples), 1);
}

}  // namespace limn::bench
