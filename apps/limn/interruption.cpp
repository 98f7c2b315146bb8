#include "apps/limn/interruption.h"

namespace limn::app {
namespace {

volatile std::sig_atomic_t interrupted = 0;  // a signal handler reaches nothing but globals

void note(int) {
  interrupted = 1;
}

}  // namespace

Interruption::Interruption() {
  interrupted = 0;
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, &formerInt_);
  sigaction(SIGTERM, &action, &formerTerm_);
}

Interruption::~Interruption() {
  sigaction(SIGINT, &formerInt_, nullptr);
  sigaction(SIGTERM, &formerTerm_, nullptr);
}

bool Interruption::asked() const {
  return interrupted != 0;
}

}  // namespace limn::app
