// Does the complete work of `limn bench`: a suite's rows, its tables and its report.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/limn/options.h"
#include "core/bench/runner.h"
#include "core/bench/suite.h"

namespace limn::app {

/// Declares which part of a suite is run, and how long a case may stall.
struct SuiteRun {
  std::vector<std::string> filters{};  ///< bench::selectCases()
  bench::Shard shard{};
  std::optional<double> stallTimeout{};  ///< seconds; nothing: the suite's
};

/// Runs the cases of a suite for which `out` has no row yet, or whose row was measured with something that
/// has changed since, with a progress bar, and writes tables and report. Throws UsageError before anything is
/// measured when the suite names what does not exist, and Error when another process works in `out`. Measures
/// in a separate process: a case that crashes, or that shows no sign of life for too long, loses only its own
/// row. No thread and no OpenGL context may exist. Returns how many rows were measured, found and failed, and
/// how many lack turns.
bench::Summary runSuite(const std::filesystem::path& suite, const std::filesystem::path& out,
                        const BackendOptions& backend, const SuiteRun& run = {});

}  // namespace limn::app
