// Long work that ends in good order when it is interrupted.
#pragma once

#include <csignal>

namespace limn::app {

/// While one lives, the first SIGINT or SIGTERM is only noted; the second ends the program. One at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  bool asked() const;

 private:
  struct sigaction formerInt_, formerTerm_;
};

}  // namespace limn::app
