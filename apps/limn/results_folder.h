// Measures cases of a bench into a folder of results, each in a process that may crash.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/limn/options.h"
#include "core/base/file_lock.h"
#include "core/bench/runner.h"

namespace limn::app {

/// Says which rows of a folder count.
enum class Measured {
  anywhere,  ///< tables keep machines apart
  here       ///< those of this machine and driver alone
};

/// Holds a folder with results.jsonl, references, pictures, tables and report while cases are measured into
/// it.
class ResultsFolder {
 public:
  /// Creates the folder where it is missing, and keeps other processes out of it. Throws Error when another
  /// one works in it. A case that shows no sign of life for `stallTimeout` seconds is ended (0: never).
  ResultsFolder(std::filesystem::path folder, BackendOptions backend, double stallTimeout);

  /// Throws UsageError when something does not exist that an unfinished case needs; it says the last such
  /// thing, stderr the others. Throws Error when their pictures are to be kept and cannot be written.
  void check(const std::vector<bench::Case>& cases);
  /// Measures the cases for which there is no row yet, or whose row was measured with something that has
  /// changed since, with a progress bar of that name. Measures in a separate process: a case that crashes, or
  /// that stalls, loses only its own row. No thread and no OpenGL context may exist. With Measured::here rows
  /// of another machine or driver are measured again as well. Returns how many rows were measured, found and
  /// failed, and how many lack turns.
  bench::Summary measure(const std::vector<bench::Case>& cases, const std::string& progressName,
                         Measured counts = Measured::anywhere);
  /// Returns the renderer of the last rows that were measured or found; "" before.
  const std::string& renderer() const { return renderer_; }
  /// Returns whether case `index` of the last measure() failed there. A good row of another machine or driver
  /// may be in its place still.
  bool failed(std::size_t index) const { return failed_[index]; }
  /// Returns all rows of the folder.
  std::vector<bench::Row> rows() const;
  /// Writes tables and report of all rows.
  void writeReport() const;

 private:
  std::filesystem::path file() const { return folder_ / "results.jsonl"; }

  std::filesystem::path folder_;
  BackendOptions backend_;
  double stallTimeout_;
  FileLock lock_;
  std::string renderer_;
  std::vector<bool> failed_;
};

}  // namespace limn::app
