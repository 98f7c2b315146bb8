// Declares what limn tune is asked: a limit, and the settings of the techniques that are searched.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/limn/options.h"
#include "core/bench/tune.h"
#include "core/image/metric_table.h"
#include "core/question/scene_question.h"
#include "core/question/term.h"
#include "core/technique/registry.h"

namespace limn::app {

struct TuneArguments {
  SceneQuestion scene;
  bool termGiven = false, json = false;
  std::optional<double> maxMs;
  std::string maxError, metric = "rmse";
  std::string techniques;
  std::vector<std::string> settings;
  int steps = 2, spp = 256, frames = 10, turns = 5;
  std::optional<int> bounces;
  double maskedShare = 0.005, stallTimeout = 1800;
  bool exhaustive = false;
  std::filesystem::path out;
  BackendOptions backend;
};

/// Holds the metric, and the limit of the error or of the time.
struct TuneGoal {
  const MetricInfo& metric;
  double limit = 0;  ///< milliseconds, or a value of the metric
  bool ofTime = false;

  bench::TuneLimit tuneLimit() const;
  /// Returns what continues "a setting".
  std::string text() const;
};

/// Returns the goal of --max-ms, or of --max-error. Throws UsageError for both or none, or an unknown metric.
TuneGoal tuneGoal(const TuneArguments& options);

using TuneParameters = std::vector<std::pair<std::string, std::string>>;  ///< "technique.parameter", value

/// Holds a technique's settings: what is searched, and what --set fixes.
struct SearchedTechnique {
  bench::TuneSpace space;
  TuneParameters fixed;
};

/// Returns the techniques that are asked for, or all that change a picture of `term`, each with `bounces`
/// where it has any, and with 0 bounces without light over other surfaces. Throws UsageError for what a
/// technique does not have.
std::vector<SearchedTechnique> searchedTechniques(const TechniqueRegistry& registry,
                                                  const TuneArguments& options, Term term, int bounces);

}  // namespace limn::app
