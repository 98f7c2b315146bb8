// Runs the cases of a suite that have no row yet. Rendering is passed in as callbacks, so that the logic is
// tested without it.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/bench/results_file.h"
#include "core/image/image.h"

namespace limn::bench {

struct Reference {
  Image image;
  std::string file;               ///< as recorded in the row
  std::optional<double> noise;    ///< RMS relative to the mean
  std::optional<double> seconds;  ///< of rendering it
};

struct Measurement {
  Image image;
  Cost cost;
};

struct Progress {
  int index = 0, count = 0;  ///< case number from 0
  int place = 0;             ///< of the case in its turn, from 0
  int turn = 1, turns = 1;   ///< from 1
  const Case& what;
  enum class State { skipped, started, done, failed } state;
  std::string failure;
};

struct Callbacks {
  /// Renders the reference, and keeps its picture where the case wants pictures; called once per question
  /// (consecutive cases share it), and again for the first of its cases that wants pictures.
  std::function<Reference(const Case&)> reference;
  /// Keeps a picture under a name and returns its file; called for cases that want it, with the row's key,
  /// and with KEY.difference for differenceImage(). May be empty.
  std::function<std::string(const std::string& name, const Image&)> keepPicture;
  /// Returns the technique's picture and its cost. For kSeparationFloor it returns unshadowed light times the
  /// reference's visibility, untimed (n = 0).
  std::function<Measurement(const Case&)> measure;
  /// Returns the milliseconds of the frames of a further turn; called for cases with several turns.
  std::function<std::vector<double>(const Case&)> time;
  /// Returns one turn of the technique's own passes and of its bound, nullopt where it has none; called in
  /// each turn of the cases that ask for it. May be empty: no row has a bound then.
  std::function<std::optional<BoundTime>(const Case&)> bound;
  std::function<void(const Progress&)> progress;  ///< may be empty
  /// Returns what the case is measured with now: rows that were measured with something else are measured
  /// again. May be empty: every row then counts as valid.
  std::function<Provenance(const Case&)> provenance;
  /// Where it is measured now, as in Cost: a row of elsewhere that lacks turns is measured again, since times
  /// of two machines are no sample of either. Empty: not compared.
  std::string machine, driver;
  /// Whether rows of elsewhere are measured again even if they lack no turn: for those who compare rows
  /// without the tables, which keep machines apart.
  bool hereAlone = false;
};

struct Summary {
  int done = 0, skipped = 0, failed = 0;
  int shortened = 0;  ///< shortenedRows(); they are among the others
  /// Returns whether every case has its row with all of its turns.
  bool complete() const { return failed == 0 && shortened == 0; }
};

/// Returns how many of the cases have a row that was measured with something else, by what has changed
/// (staleness()).
LIMN_API std::map<std::string, int> staleRows(std::span<const Case> cases, const std::string& renderer,
                                              const ResultsFile& results,
                                              const std::function<Provenance(const Case&)>& provenance);

/// Returns how many of the cases have a good row that is timed in fewer turns than they ask for, as a row is
/// left by a further turn that failed or crashed.
LIMN_API int shortenedRows(std::span<const Case> cases, const std::string& renderer,
                           std::span<const Row> rows);

/// Returns the cases for which no renderer has a row that is finished: good, measured with what `provenance`
/// gives now, with the picture and within the masked share that the case asks for, and timed in all of its
/// turns.
LIMN_API std::vector<Case> unfinishedCases(std::span<const Case> cases, std::span<const Row> rows,
                                           const std::function<Provenance(const Case&)>& provenance);

/// Gives the rows of the cases, whatever their renderer, the case's title, baseline and limit where these
/// have changed and the row holds otherwise; turns may be missing. For rows that no runCases() comes by, such
/// as merged ones.
LIMN_API void restateRows(std::span<const Case> cases, ResultsFile& results,
                          const std::function<Provenance(const Case&)>& provenance);

/// Runs all cases first, then further turns of timing, each of which replaces the rows by longer ones. These
/// go by scene, so that each is opened once in a turn; cases of one scene stay in their order.
/// `renderer` is recorded in the rows and part of their keys: results of another renderer are measured again.
/// Rows that hold get the case's title, baseline and limit where these have changed.
/// Whatever a callback other than `progress` and `provenance` throws is recorded in the case's row, and the
/// next case is run. Throws the Error of the results file, which ends the run.
LIMN_API Summary runCases(std::span<const Case> cases, const std::string& renderer, ResultsFile& results,
                          const Callbacks& callbacks);

}  // namespace limn::bench
