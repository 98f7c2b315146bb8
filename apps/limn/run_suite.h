// The whole of `limn bench`: a suite's rows, its tables and its report.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/limn/options.h"
#include "core/bench/runner.h"
#include "core/bench/suite.h"

namespace limn::app {

/// A suite by its file, or by its name if it came with limn. Throws Error when there is neither.
std::filesystem::path findSuite(const std::filesystem::path& nameOrFile);

/// Which part of a suite is run, and how patiently.
struct SuiteRun {
  std::vector<std::string> filters{};  ///< bench::selectCases()
  bench::Shard shard{};
  std::optional<double> stallTimeout{};  ///< seconds; nothing: the suite's
};

/// Runs the cases of a suite that `out` has no row for yet, or one that was measured with something else than
/// what there is now, with a progress bar, and writes tables and report. Throws UsageError before anything is
/// measured when the suite names what is not there, and Error when another process works in `out`. Measures
/// in a process of its own: a case that crashes, or that shows no sign of life for too long, loses its own
/// row only. No thread and no OpenGL context may exist. Returns how many rows were measured, found and
/// failed.
bench::Summary runSuite(const std::filesystem::path& suite, const std::filesystem::path& out,
                        const BackendOptions& backend, const SuiteRun& run = {});

}  // namespace limn::app
