// What happens at SIGINT and SIGTERM: one line says what is kept and how to go on, and the exit status is 128
// and the signal's number, as shells have it.
#pragma once

#include <csignal>
#include <string>

namespace limn::app {

/// Says how a command ends that noticed an Interruption. No std::exception, so that nothing on the way takes
/// it for a failure.
struct Interrupted {
  int signal;           ///< SIGINT or SIGTERM
  std::string message;  ///< one line
};

/// What signal handlers were before; the destructor puts them back.
class FormerHandlers {
 public:
  FormerHandlers();
  ~FormerHandlers();
  FormerHandlers(const FormerHandlers&) = delete;
  FormerHandlers& operator=(const FormerHandlers&) = delete;

 private:
  struct sigaction int_, term_;
};

/// While one lives, SIGINT or SIGTERM writes "limn: LINE" to stderr and ends the program at once, child
/// processes that die with it (apps/limn/worker.h) included. For work whose files are written whole or not at
/// all. The innermost one speaks.
class LastWords {
 public:
  explicit LastWords(const std::string& line);
  ~LastWords();

 private:
  FormerHandlers former_;
  std::string formerLine_;
};

/// While one lives, the first SIGINT or SIGTERM is only noted, so that the work can keep what it has; the
/// second ends the program with the LastWords around it. One at a time.
class Interruption {
 public:
  Interruption();

  bool asked() const;
  int signal() const;  ///< 0: not asked

 private:
  FormerHandlers former_;
};

}  // namespace limn::app
