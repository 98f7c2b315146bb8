// Work in a process of its own, so that what crashes there ends nothing else.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace limn::app {

/// What a worker and the process that waits for it share.
class WorkerReport {
 public:
  enum class State : unsigned char { open, skipped, done, failed };

  explicit WorkerReport(std::size_t cases);
  ~WorkerReport();
  WorkerReport(const WorkerReport&) = delete;
  WorkerReport& operator=(const WorkerReport&) = delete;

  /// The worker says what it does. Texts are cut to 255 bytes.
  void started(std::size_t caseIndex);
  /// What was skipped or done stays so.
  void finished(std::size_t caseIndex, State state);
  /// A sign of life; so are the others.
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

/// How a worker ended that neither returned nor threw: "crashed: Segmentation fault", "ended with status 3",
/// "no progress for 60 s".
struct Crash {
  std::string what;
};

/// Runs `work` in a child process and waits for it. No thread and no OpenGL context may exist yet. An Error
/// or UsageError that `work` throws is thrown here, anything else as an Error; an interruption of the child
/// (SIGINT, SIGTERM) ends this process in the same way; the child does not outlive this process. A child that
/// gives no sign of life for `stallTimeout` seconds (0: any time) is killed. Returns what happened if it
/// crashed or was killed.
std::optional<Crash> runInWorker(WorkerReport& report, double stallTimeout,
                                 const std::function<void()>& work);

}  // namespace limn::app
