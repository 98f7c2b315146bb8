#include "core/base/whereabouts.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstring>

namespace limn {
namespace {

std::atomic<const char*> currentTechnique{nullptr};
std::atomic<const char*> currentPass{nullptr};

// What the handler writes, and where to: `crashProgram` to stderr, or into `crashText`.
const char* crashProgram = nullptr;
int crashStderr = -1;
char* crashText = nullptr;
std::size_t crashTextSize = 0;

/// Text in memory of a fixed size; what does not fit is left out.
class Line {
 public:
  Line(char* to, std::size_t size) : to_(to), left_(size - 1) { *to_ = 0; }
  Line& operator<<(const char* text) {
    const std::size_t length = std::min(std::strlen(text), left_);
    std::memcpy(to_, text, length);
    to_ += length;
    left_ -= length;
    *to_ = 0;
    return *this;
  }

 private:
  char* to_;
  std::size_t left_;
};

void crashed(int signal) {
  if (crashText != nullptr) describeCrash(signal, crashText, crashTextSize);
  if (crashProgram != nullptr) {
    char description[512], text[640];
    describeCrash(signal, description, sizeof description);
    Line(text, sizeof text) << crashProgram << ": crashed: " << description << "\n";
    [[maybe_unused]] const ssize_t written = write(crashStderr, text, std::strlen(text));
  }
  raise(signal);  // blocked until this returns; SA_RESETHAND has put the default back
}

void handleCrashes() {
  // A stack that has run over leaves no room to handle that on it.
  static char stack[1 << 16];
  const stack_t other{stack, 0, sizeof stack};
  sigaltstack(&other, nullptr);
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler != SIG_DFL && action.sa_handler != crashed) continue;
    action = {};
    action.sa_handler = crashed;
    action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_ONSTACK;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
  }
}

}  // namespace

Whereabouts::Whereabouts(const char* technique, const char* pass)
    : formerTechnique_(currentTechnique.exchange(technique)), formerPass_(currentPass.exchange(pass)) {}

Whereabouts::~Whereabouts() {
  currentTechnique = formerTechnique_;
  currentPass = formerPass_;
}

void describeCrash(int signal, char* to, std::size_t size) noexcept {
  const char* name = sigdescr_np(signal);
  Line line(to, size);
  line << (name != nullptr ? name : "a signal");
  const char* technique = currentTechnique;
  const char* pass = currentPass;
  if (technique == nullptr) return;
  line << ", in ";
  if (pass != nullptr)
    line << "pass " << pass << " of " << technique;
  else
    line << "technique " << technique;
}

void leaveWordsAtCrash(const char* program) {
  crashProgram = program;
  if (crashStderr < 0) crashStderr = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  crashText = nullptr;
  handleCrashes();
}

void leaveWordsAtCrash(char* to, std::size_t size) {
  crashText = to;
  crashTextSize = size;
  crashProgram = nullptr;
  handleCrashes();
}

}  // namespace limn
