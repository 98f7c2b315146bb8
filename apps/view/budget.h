// Finds the best setting for a time among those that limn tune or limn bench measured of a scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/bench/row.h"
#include "core/image/metric_table.h"
#include "core/question/term.h"

namespace limn::app {

/// Holds a setting with its error and the median time of its frames.
struct MeasuredSetting {
  std::string technique;
  std::vector<std::pair<std::string, std::string>> parameters;  ///< "technique.parameter", value
  Metrics error;
  double ms = 0;
  bool outdated = false;  ///< measured with another version than the newest row of its table

  /// Returns technique and parameters on one line, and whether they are outdated.
  std::string text() const;
};

/// Holds a table of the bench: what was measured in one way, on one machine, for one question about a scene.
struct MeasuredQuestion {
  SceneQuestion question;
  Term term = Term::final;  ///< the question's
  std::string text;         ///< camera, light, term, size, mode and reference
  std::string renderer;
  std::int64_t pixels = 0;
  std::vector<MeasuredSetting> settings;
};

/// Says whether both name the same scene: by its name or by that of its file. Two files that exist are two
/// scenes even where they have one name: many a model is a scene.gltf.
bool sameScene(const std::string& a, const std::string& b);

/// Returns what the rows hold of `scene`: the largest pictures first, then the questions with the most
/// settings, as makeTables() keeps them apart. Rows without a picture or a time do not count. Throws
/// UsageError for a row of a term that there is not.
std::vector<MeasuredQuestion> measuredQuestions(std::span<const bench::Row> rows, const std::string& scene);

struct BudgetAnswer {
  std::optional<MeasuredSetting> best;  ///< nothing: no setting is quick enough
  /// The best setting of another technique that is quick enough, or else the second best.
  std::optional<MeasuredSetting> runnerUp;
};

/// Returns the settings that are best by `metric`, which is no basis, among those whose frames take no longer
/// than `ms`. Outdated ones come after all others.
BudgetAnswer bestWithin(const MeasuredQuestion& question, double ms, const MetricInfo& metric);

/// Declares a search of limn tune.
struct TuneOrder {
  SceneQuestion question;
  double ms = 16;               ///< that a frame may take
  std::string techniques = {};  ///< comma-separated; empty: all that answer the term
  int steps = 1;                ///< from a parameter's default in each direction
  const MetricInfo* metric = &metricInfo(&Metrics::rmse);  ///< that is to be best
  double maskedShare = CompareOptions().maxMaskedShare;    ///< of the pixels that may be left out
  std::string folder;
  int device = -1;  ///< as in ContextOptions

  /// Returns what is asked of techniques for a picture that the window shows: of the whole picture only the
  /// part that they compete for, direct light, or the visibility of its only light.
  static SceneQuestion questionOf(const SceneQuestion& shown);
};

/// Returns what limn is started with.
std::vector<std::string> tuneArguments(const TuneOrder& order);
/// Returns the same as a command for a shell.
std::string tuneCommand(const TuneOrder& order);

/// Returns the index of the question among what was measured of its scene; 0 where it is not there.
std::size_t placeOf(const SceneQuestion& question, std::span<const MeasuredQuestion> measured);

}  // namespace limn::app
