// Ratios of measured times, with what the samples say about their uncertainty.
#pragma once

#include <span>

#include "core/base/export.h"

namespace limn::bench {

/// A ratio of medians and its bootstrap percentile interval.
struct Ratio {
  double value = 0;
  double low = 0, high = 0;  ///< 95 %; both equal to value where either side has one sample only
};

/// median(numerator) / median(denominator); both resampled with replacement, always by the same random
/// numbers, so that equal samples give equal intervals (Efron 1979). Neither may be empty; values above 0.
LIMN_API Ratio ratioOfMedians(std::span<const double> numerator, std::span<const double> denominator);

}  // namespace limn::bench
