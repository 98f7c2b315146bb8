// Finds the best setting for a time among those that limn tune or limn bench measured of a scene.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/bench/row.h"

namespace limn::app {

/// Holds a setting with its error and the median time of its frames.
struct MeasuredSetting {
  std::string technique;
  std::vector<std::pair<std::string, std::string>> parameters;  ///< "technique.parameter", value
  double rmse = 0, ms = 0;

  /// Returns technique and parameters on one line.
  std::string text() const;
};

/// Holds what was measured on one machine for one question about a scene, which makes it comparable.
struct MeasuredQuestion {
  std::string text;  ///< camera, light, term and size
  std::string renderer;
  std::int64_t pixels = 0;
  std::vector<MeasuredSetting> settings;
};

/// Returns what the rows hold of `scene`, by its name or that of its file: the largest pictures first, then
/// the questions with the most settings. Rows without a picture or a time do not count.
std::vector<MeasuredQuestion> measuredQuestions(std::span<const bench::Row> rows, const std::string& scene);

struct BudgetAnswer {
  std::optional<MeasuredSetting> best;  ///< nothing: no setting is quick enough
  /// The best setting of another technique that is quick enough, or else the second best.
  std::optional<MeasuredSetting> runnerUp;
};

/// Returns the settings with the least error among those whose frames take no longer than `ms`.
BudgetAnswer bestWithin(const MeasuredQuestion& question, double ms);

/// Returns the command that measures settings for the question into `folder`, for a shell.
std::string tuneCommand(const SceneQuestion& question, double ms, const std::string& folder);

}  // namespace limn::app
