// Compares two results of the same suites and finds what got slower or worse beyond noise in the later one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/bench/ratio.h"
#include "core/bench/row.h"

namespace limn::bench {

struct RegressionOptions {
  /// Share by which the whole interval of a ratio has to lie above 1 before a row counts as slower: no sample
  /// contains a machine's drift between two runs.
  double drift = 0.05;
};

/// Holds the change of a row that both results have: the same case on the same renderer.
struct Change {
  std::string label;
  Ratio time;                         ///< later / earlier, frame; value 0: not compared
  bool elsewhere = false;             ///< on another machine: the times are not compared
  bool oneFrame = false;              ///< was timed of one of them: likewise, since times scatter
  bool otherFiles = false;            ///< the scene's files have changed in between
  bool otherReference = false;        ///< the errors are those against another reference
  double errorBefore = 0, error = 0;  ///< RMSE, in the penumbra where both rows know it
  bool slower = false, faster = false;
  bool worse = false, better = false;
  std::string failure;  ///< not empty: the later one failed, and the rest is void
};

struct Regression {
  std::vector<Change> changes;              ///< in the order of the later rows
  std::size_t onlyBefore = 0, onlyNow = 0;  ///< rows without a partner
  LIMN_API bool found() const;              ///< any row slower, worse or failed
};

/// Compares the later rows with the earlier ones, of two known machines and where one frame was timed the
/// errors alone. A difference of errors counts where it exceeds three standard deviations of what the noise
/// of two independent references does to it: MSE_a - MSE_b has the standard deviation 2 sigma (RMSE_a +
/// RMSE_b + sigma) / sqrt(pixels) at most, where sigma is the references' noise and that and the errors are
/// spread evenly over the pixels. (It is larger where both gather in the same few; rows against the same
/// reference differ by no noise at all.) Against another reference than before, as its file's name says, an
/// error below the noise floor is neither worse nor better: it may be noise alone, which rare paths of dark
/// pictures gather in few pixels.
LIMN_API Regression compareResults(std::span<const Row> before, std::span<const Row> now,
                                   const RegressionOptions& options = {});

/// Returns a line of totals and a table of the rows that changed.
LIMN_API std::string toMarkdown(const Regression& regression);

}  // namespace limn::bench
