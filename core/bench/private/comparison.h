// Compares the rows of one table with its baseline: how much faster they are, and how much faster than the
// baseline's technique with the fewest samples whose error is not above the row's.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/bench/ratio.h"
#include "core/bench/row.h"
#include "core/bench/tables.h"
#include "core/image/metric_table.h"

namespace limn::bench {

/// The errors at which rows are compared with the baseline; they are also measured over the penumbra. The
/// first one is shown where there is room for only one.
inline constexpr const MetricInfo* kCompared[] = {&metricInfo(&Metrics::rmse),
                                                  &metricInfo(&Metrics::structured)};

/// Returns whether the row has a picture and a time.
inline bool isTimed(const Row& row) {
  return row.failure.empty() && row.cost.frameMs.n > 0;
}

/// Returns whether two texts are the same as far as they are known: rows do not always say where they were
/// measured.
inline bool mayBeEqual(const std::string& a, const std::string& b) {
  return a == b || a.empty() || b.empty();
}

/// Returns whether one renderer, machine and driver may have measured both rows. As in tables, a row of an
/// earlier version, which does not say its machine or driver, stands with any.
inline bool sameMachine(const Row& a, const Row& b) {
  return a.cost.renderer == b.cost.renderer && mayBeEqual(a.cost.machine, b.cost.machine) &&
         mayBeEqual(a.cost.driver, b.cost.driver);
}

/// Returns the milliseconds of maps, filters and the technique's passes.
LIMN_API double shadowMs(const Row& row);

/// Returns the errors in the penumbra where they are known, else those of the whole picture.
LIMN_API const Metrics& errorOf(const Row& row);

/// Returns the timed row that the others of the table are compared with: the first baseline, an outdated one
/// only where the newest version measured none. Null if there is none.
LIMN_API const Row* baselineOf(const Table& table);

/// Returns the single times of the frames; where they are not known, the median alone.
LIMN_API std::vector<double> samplesOf(const FrameTime& time);

/// Returns how many times as long the first row's frame takes, from samplesOf() both, which must be timed.
LIMN_API Ratio frameRatio(const Row& slow, const Row& fast);

/// Returns how many times as long the technique's own passes take as those of its bound.
LIMN_API Ratio xBound(const BoundTime& time);

/// Fewer turns say nothing of how far a ratio scatters.
inline constexpr int kFewestTurns = 2;

/// Returns how many times as long the first row's maps, filters and technique's passes take, which are timed
/// in one turn; "-" where those of the other take no time.
LIMN_API std::string shadowRatio(const Row& slow, const Row& fast);

/// Returns a ratio to the digits that tables show.
LIMN_API std::string ratioText(double ratio);
/// Returns the same with the interval: "2.10 (1.80 to 2.40)"; `digits` follow each point.
LIMN_API std::string ratioText(const Ratio& ratio, int digits = 2);
/// Returns ratioText() with the interval; of fewer than kFewestTurns "2.10 (n = 1)".
LIMN_API std::string measuredText(const Ratio& ratio);

/// Returns the quickest timed row of the technique whose boundedError() is not above that of `against`, both
/// of the same pixels: of the penumbra where that is known of `against`, else of the whole picture. Null if
/// there is none. An outdated row is taken only where the newest version measured none.
LIMN_API const Row* quickest(const Table& table, const std::string& technique, const MetricInfo& error,
                             const Row& against);

/// Holds how long the reference's own method takes to reach the row's error, with as many cores.
struct ReferenceTime {
  double ms = 0;
  bool atLeast = false;  ///< the row's error is below the reference's noise: the time is a bound
};

/// Returns T (sigma / e)^2 for a reference that took T with the noise sigma, since the noise of independent
/// samples falls that way. e^2 is the row's squared RMSE without sigma^2, or (sigma / 2)^2 where less
/// remains: the smallest meaningful difference of two numbers that are known to a few percent. Returns
/// nullopt where time or noise is unknown, where the row's frames are a GPU's, and where errors and times
/// belong to different pictures: of another size, or of several frames where the time is that of one (aa, a
/// history).
LIMN_API std::optional<ReferenceTime> referenceTime(const Row& row);

/// Returns a name of the row for people: its title, or settingsName().
LIMN_API std::string rowName(const Row& row);
/// Marks the name of an outdated row; the line below a table explains it.
inline constexpr const char* kOutdatedMark = " \u2020";
/// Returns rowName() with kOutdatedMark where the row is an outdated one of its table.
LIMN_API std::string markedName(const Row& row, const Table& table);
/// Returns the technique with the parameters and the environment's lights that the suite sets.
LIMN_API std::string settingsName(const Row& row);

/// Returns Markdown with a line for each timed row except those of the baseline's technique: frame time and
/// shadow time (maps, filters, technique) as factors by which the baseline is slower (above 1: the row is
/// faster), and the same for the fastest rows of the baseline's technique whose RMSE and whose structured
/// error are not above the row's (in the penumbra, where that is known), as quickest() finds them. Outdated
/// rows have kOutdatedMark, which the table above explains. Returns "" without a timed row of the baseline.
LIMN_API std::string comparisonMarkdown(const Table& table);

}  // namespace limn::bench
