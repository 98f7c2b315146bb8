// Computes ratios of measured times, with the uncertainty that follows from the samples.
#pragma once

#include <span>

#include "core/base/export.h"

namespace limn::bench {

/// Holds a ratio of medians and its bootstrap percentile interval.
struct Ratio {
  double value = 0;
  double low = 0, high = 0;  ///< 95 %; of one turn, of the scatter from frame to frame alone
  int turns = 1;             ///< the smaller number of turns of the two sides
};

/// Holds samples in the order measured, taken in turns of equal length with other work in between.
struct Samples {
  std::span<const double> values;  ///< milliseconds, not empty; less than a nanosecond counts as one
  int turns = 1;
};

/// Returns median(numerator) / median(denominator). Both are resampled with replacement, always by the same
/// random numbers, so that equal samples give equal intervals (Efron 1979). Where there are several turns,
/// the turns are resampled first and then their samples, since other load on the machine changes more from
/// turn to turn than from frame to frame. The interval is then widened in the logarithm: by
/// sqrt(turns / (turns - 1)), to correct the spread that a resample of few turns lacks (Davison and Hinkley
/// 1997, Bootstrap Methods and their Application, section 3.8), and by Student's t with 2 (turns - 1) degrees
/// of freedom over the normal distribution's 1.96, since few turns do not tell their spread well.
LIMN_API Ratio ratioOfMedians(const Samples& numerator, const Samples& denominator);

/// Returns the median of the samples with its interval, which is found as that of ratioOfMedians(): `value`,
/// `low` and `high` have the samples' unit. One side's turns tell less of their spread than those of two, so
/// that Student's t has turns - 1 degrees of freedom.
LIMN_API Ratio medianWithInterval(const Samples& samples);

}  // namespace limn::bench
