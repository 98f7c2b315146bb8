// Hands a suite to the workload manager Slurm, in parts that are measured on nodes of their own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/limn/run_suite.h"

namespace limn::app {

struct SlurmJob {
  std::string partition;  ///< "": Slurm's default
  int nodes = 1;          ///< that work at once
  /// Further arguments of `limn bench` for each part, such as --backend.
  std::vector<std::string> arguments{};
};

/// Puts what finished parts of the suite left under `out`/parts into `out`, writes labels and baselines that
/// the suite changed since into the rows, and submits the parts with unfinished cases: an array job whose
/// tasks have a node for themselves, and a job after it that merges. A part whose task or node dies is queued
/// again, and goes on where it was. Returns what was done as a line for people. Throws UsageError when the
/// suite names what does not exist or the folder's name has a backslash, and Error where Slurm is not
/// installed or refuses, or while an earlier job of the folder that the same user submitted is not finished.
std::string submitSuite(const std::filesystem::path& suite, const std::filesystem::path& out,
                        const SuiteRun& run, const SlurmJob& job);

}  // namespace limn::app
