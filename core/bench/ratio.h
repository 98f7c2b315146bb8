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

/// Samples in the order measured, taken in turns of equal length with other work in between.
struct Samples {
  std::span<const double> values;  ///< not empty, above 0
  int turns = 1;
};

/// median(numerator) / median(denominator); both resampled with replacement, always by the same random
/// numbers, so that equal samples give equal intervals (Efron 1979). Where there are several turns, they are
/// resampled first and their samples then, since what a machine does besides changes more from turn to turn
/// than from frame to frame; the interval is then widened by sqrt(turns / (turns - 1)) in the logarithm,
/// which a resample of few turns lacks in spread (Davison and Hinkley 1997, Bootstrap Methods and their
/// Application, section 3.8).
LIMN_API Ratio ratioOfMedians(const Samples& numerator, const Samples& denominator);

}  // namespace limn::bench
