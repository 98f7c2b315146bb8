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

double resampledMedian(const Samples& samples, std::mt19937& random, std::vector<double>& scratch) {
  const std::size_t count = samples.values.size(),
                    turns = std::clamp<std::size_t>(static_cast<std::size_t>(std::max(samples.turns, 1)), 1,
                                                    count);
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
  const int turns = std::min(numerator.turns, denominator.turns);
  const double widening = turns > 1 ? std::sqrt(turns / (turns - 1.0)) : 1;
  const auto bound = [&](double ratio) { return value * std::pow(ratio / value, widening); };
  return {value, bound(ratios[kResamples / 40]), bound(ratios[kResamples - 1 - kResamples / 40])};
}

}  // namespace limn::bench
