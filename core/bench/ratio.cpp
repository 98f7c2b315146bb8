#include "core/bench/ratio.h"

#include <algorithm>
#include <random>
#include <vector>

#include "core/render/frame_stats.h"

namespace limn::bench {
namespace {

constexpr int kResamples = 2000;

double resampledMedian(std::span<const double> samples, std::mt19937& random, std::vector<double>& scratch) {
  scratch.resize(samples.size());
  // The remainder is biased by less than 1e-5 for any number of samples that is timed, and the same
  // everywhere.
  for (double& value : scratch) value = samples[random() % samples.size()];
  return render::quartiles(scratch).median;
}

}  // namespace

Ratio ratioOfMedians(std::span<const double> numerator, std::span<const double> denominator) {
  const auto median = [](std::span<const double> samples) {
    return render::quartiles({samples.begin(), samples.end()}).median;
  };
  std::mt19937 random(1);
  std::vector<double> scratch, ratios(kResamples);
  for (double& ratio : ratios) {
    const double above = resampledMedian(numerator, random, scratch);
    ratio = above / resampledMedian(denominator, random, scratch);
  }
  std::sort(ratios.begin(), ratios.end());
  return {median(numerator) / median(denominator), ratios[kResamples / 40],
          ratios[kResamples - 1 - kResamples / 40]};
}

}  // namespace limn::bench
