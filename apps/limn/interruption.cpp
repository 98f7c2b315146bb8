#include "apps/limn/interruption.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

#include "apps/limn/options.h"

namespace limn::app {
namespace {

// A signal handler reaches nothing but globals. Any thread may run it, at any time: of the two texts it takes
// the one that was finished last.
volatile std::sig_atomic_t noted = 0;
std::array<std::array<char, 1024>, 2> texts{};
std::atomic<const char*> words{texts[0].data()};
static_assert(decltype(words)::is_always_lock_free);

void endAtOnce(int signal) {
  const char* const text = words;
  [[maybe_unused]] const ssize_t written = write(errorDescriptor(), text, std::strlen(text));
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

void setWords(const std::string& line) {
  std::array<char, 1024>& next = texts[words == texts[0].data() ? 1 : 0];
  next.fill('\0');
  std::copy_n(line.begin(), std::min(line.size(), next.size() - 1), next.begin());
  words = next.data();
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

LastWords::LastWords(const std::string& line) : formerLine_(words) {
  say(line);
  handle(endAtOnce);
}

void LastWords::say(const std::string& line) {
  constexpr std::size_t longest = 1000;
  setWords(lineBeginning() + ("limn: " + line).substr(0, longest) + "\n");
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
