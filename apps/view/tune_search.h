// Runs limn tune beside the window.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace limn::app {

/// Holds a search that runs in a process of its own. Nothing here waits for it but the destructor, which ends
/// it. A window that crashes ends it, too, as soon as it says something more.
class TuneSearch {
 public:
  /// Starts `program` with these arguments. Throws Error if it cannot be started.
  TuneSearch(const std::string& program, const std::vector<std::string>& arguments);
  /// Ends the search as cancel() does, and waits for that; what has not ended after seconds is killed.
  ~TuneSearch();
  TuneSearch(const TuneSearch&) = delete;
  TuneSearch& operator=(const TuneSearch&) = delete;

  /// Takes in what has happened since the last call, and returns whether the search still runs.
  bool poll();
  /// Asks the search to end. It keeps what it has measured, and the same search goes on from there.
  void cancel();

  /// Returns the last line that the search said: how far it is.
  const std::string& progress() const { return said_; }
  bool cancelled() const { return cancelled_; }
  /// Returns why the search failed, in one line; empty while it runs, when it succeeded and when it was
  /// cancelled.
  const std::string& problem() const { return problem_; }

 private:
  void hear(const std::string& text);
  void end();

  pid_t process_ = 0;  ///< 0: it has ended
  int output_ = -1;
  std::string line_, said_, problem_;
  bool cancelled_ = false;
};

}  // namespace limn::app
