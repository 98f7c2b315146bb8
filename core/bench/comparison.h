// The rows of one table against its baseline: how much faster, and how much faster than the baseline's
// technique with the fewest samples that are not above the row's error.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/base/export.h"
#include "core/bench/row.h"

namespace limn::bench {

/// Whether the row has a picture and a time.
inline bool isTimed(const Row& row) {
  return row.failure.empty() && row.cost.frameMs.n > 0;
}

/// Milliseconds of maps, filters and the technique's passes.
LIMN_API double shadowMs(const Row& row);

/// In the penumbra where that is known, else of the whole picture.
LIMN_API const Metrics& errorOf(const Row& row);

/// How many times as long the first row's frame takes, with the interval where the single times are known;
/// both timed.
LIMN_API std::string frameRatio(const Row& slow, const Row& fast);

/// How long the reference's own method takes to be as wrong as the row, with as many cores.
struct ReferenceTime {
  double ms = 0;
  bool atLeast = false;  ///< the row's error drowns in the reference's noise: the time is that of a bound
};

/// T (sigma / e)^2 for a reference that took T with the noise sigma, as the noise of independent samples
/// falls; e^2 is the row's squared RMSE without sigma^2, or (sigma / 2)^2 where less is left: what remains of
/// the difference of two numbers that are known to a few percent. nullopt where time or noise are not known,
/// and where errors and times are those of pictures of different sizes.
LIMN_API std::optional<ReferenceTime> referenceTime(const Row& row);

/// The row for people: its title, or the technique with its parameters.
LIMN_API std::string rowName(const Row& row);

/// Markdown with a line for each timed row but those of the baseline's technique: frame time and the time of
/// its shadows (maps, filters, technique) as multiples in which the baseline is slower (above 1: the row is
/// faster), and the same for the quickest rows of the baseline's technique whose RMSE and whose structured
/// error are not above the row's (in the penumbra, where that is known). "" without a timed row of the
/// baseline.
LIMN_API std::string comparisonMarkdown(std::span<const Row> rows);

}  // namespace limn::bench
