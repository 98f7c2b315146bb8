#include "apps/limn/interruption.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "apps/limn/options.h"

namespace limn::app {
namespace {

// A signal handler reaches nothing but globals.
volatile std::sig_atomic_t noted = 0;
std::array<char, 1024> words{};

void endAtOnce(int signal) {
  [[maybe_unused]] const ssize_t written = write(errorDescriptor(), words.data(), std::strlen(words.data()));
  _exit(128 + signal);
}

void note(int signal) {
  if (noted != 0) endAtOnce(signal);
  noted = signal;
}

void handle(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

/// No signal finds the words half-written.
void setWords(const std::string& line) {
  sigset_t both, before;
  sigemptyset(&both);
  sigaddset(&both, SIGINT);
  sigaddset(&both, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &both, &before);
  words.fill('\0');
  std::copy_n(line.begin(), std::min(line.size(), words.size() - 1), words.begin());
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace

FormerHandlers::FormerHandlers() {
  sigaction(SIGINT, nullptr, &int_);
  sigaction(SIGTERM, nullptr, &term_);
}

FormerHandlers::~FormerHandlers() {
  sigaction(SIGINT, &int_, nullptr);
  sigaction(SIGTERM, &term_, nullptr);
}

LastWords::LastWords(const std::string& line) : formerLine_(words.data()) {
  say(line);
  handle(endAtOnce);
}

void LastWords::say(const std::string& line) {
  const char* begin = isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "";  // over a progress bar
  constexpr std::size_t longest = 1000;
  setWords(begin + ("limn: " + line).substr(0, longest) + "\n");
}

LastWords::~LastWords() {
  setWords(formerLine_);
}

Interruption::Interruption() {
  noted = 0;
  handle(note);
}

bool Interruption::asked() const {
  return noted != 0;
}

int Interruption::signal() const {
  return noted;
}

}  // namespace limn::app
