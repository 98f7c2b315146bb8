// Handles SIGINT and SIGTERM: one line says what is kept and how to continue, and the exit status is 128 plus
// the signal's number, as in shells.
#pragma once

#include <csignal>
#include <string>

namespace limn::app {

/// Says how a command ends that noticed an Interruption. It is no std::exception, so that no handler on the
/// way takes it for a failure.
struct Interrupted {
  int signal;           ///< SIGINT or SIGTERM
  std::string message;  ///< one line
};

/// Holds the previous signal handlers; the destructor restores them.
class FormerHandlers {
 public:
  FormerHandlers();
  ~FormerHandlers();
  FormerHandlers(const FormerHandlers&) = delete;
  FormerHandlers& operator=(const FormerHandlers&) = delete;

 private:
  struct sigaction int_, term_;
};

/// Makes SIGINT and SIGTERM write "limn: LINE" to stderr, as sayError() does, and end the program at once
/// while an object of this class lives; child processes that die with the program (apps/limn/worker.h) end
/// too. The class is for work whose files are written whole or not at all. If several objects live, the
/// innermost one writes its line.
class LastWords {
 public:
  explicit LastWords(const std::string& line);
  ~LastWords();
  /// Replaces the line; a signal finds either the old or the new line at any moment.
  void say(const std::string& line);

 private:
  FormerHandlers former_;
  std::string formerLine_;
};

/// Only notes the first SIGINT or SIGTERM while an object of this class lives, so that the work can keep what
/// it has; the second one ends the program with the line of the enclosing LastWords. Only one object may live
/// at a time.
class Interruption {
 public:
  Interruption();

  bool asked() const;
  int signal() const;  ///< 0: not asked

 private:
  FormerHandlers former_;
};

}  // namespace limn::app
