// Work in a process of its own, so that what crashes there ends nothing else.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace limn::app {

/// What a worker and the process that waits for it share.
class WorkerReport {
 public:
  WorkerReport();
  ~WorkerReport();
  WorkerReport(const WorkerReport&) = delete;
  WorkerReport& operator=(const WorkerReport&) = delete;

  /// The worker says what it does. Texts are cut to 255 bytes.
  void started(int caseIndex);
  void renderer(const std::string& name);

  int caseIndex() const;  ///< -1: none
  std::string renderer() const;

 private:
  friend std::optional<struct Crash> runInWorker(WorkerReport& report, const std::function<void()>& work);
  struct Shared;
  Shared* shared_;
};

/// How a worker ended that neither returned nor threw: "crashed: Segmentation fault", "ended with status 3".
struct Crash {
  std::string what;
};

/// Runs `work` in a child process and waits for it. No thread and no OpenGL context may exist yet. An Error
/// or UsageError that `work` throws is thrown here; an interruption of the child (SIGINT, SIGTERM) ends this
/// process in the same way; the child does not outlive this process. Returns what happened if it crashed.
std::optional<Crash> runInWorker(WorkerReport& report, const std::function<void()>& work);

}  // namespace limn::app
