// Runs work in a separate process, so that a crash there ends nothing else.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace limn::app {

/// Holds what a worker and the process that waits for it share.
class WorkerReport {
 public:
  enum class State : unsigned char { open, skipped, done, failed };

  explicit WorkerReport(std::size_t cases);
  ~WorkerReport();
  WorkerReport(const WorkerReport&) = delete;
  WorkerReport& operator=(const WorkerReport&) = delete;

  /// Says, on behalf of the worker, which case it works on. Texts are cut to 255 bytes.
  void started(std::size_t caseIndex);
  /// Sets the state of a case that has ended; a case that was skipped or done keeps its state.
  void finished(std::size_t caseIndex, State state);
  /// Gives a sign of life, as the other functions do.
  void alive();
  void renderer(const std::string& name);

  std::optional<std::size_t> current() const;  ///< the case that was started last
  State state(std::size_t caseIndex) const;
  std::string renderer() const;

 private:
  friend std::optional<struct Crash> runInWorker(WorkerReport& report, double stallTimeout,
                                                 const std::function<void()>& work);
  struct Shared;
  std::size_t bytes_;
  Shared* shared_;
};

/// Describes how a worker ended that neither returned nor threw: "crashed: Segmentation fault", "ended with
/// status 3", "no progress for 60 s".
struct Crash {
  std::string what;
};

/// Runs `work` in a child process and waits for it. No thread and no OpenGL context may exist yet. Throws the
/// Error or UsageError that `work` throws, and an Error for anything else that it throws; an interruption of
/// the child (SIGINT, SIGTERM) ends this process in the same way; the child does not outlive this process.
/// Kills a child that gives no sign of life for `stallTimeout` seconds (0: no limit). Returns what happened
/// if the child crashed or was killed.
std::optional<Crash> runInWorker(WorkerReport& report, double stallTimeout,
                                 const std::function<void()>& work);

}  // namespace limn::app
