#include "apps/view/tune_search.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <utility>

#include "core/base/spawn.h"
#include "core/base/text.h"

namespace limn::app {
namespace {

constexpr int kMostReads = 16;                // at once, of a program that does not fall silent
constexpr size_t kLongestLine = 1000;         // bytes of what is shown in a panel
constexpr std::chrono::seconds kPatience{5};  // with a program that was asked to end

}  // namespace

TuneSearch::TuneSearch(const std::string& program, const std::vector<std::string>& arguments) {
  // An interrupt from the keyboard, which ends the window, ends the search as well.
  const PipedProgram started = startPiped(program, arguments, {}, &StandardFiles::err, Interrupts::reach);
  process_ = started.process;
  output_ = started.output;
  fcntl(output_, F_SETFL, O_NONBLOCK);
}

TuneSearch::~TuneSearch() {
  using Clock = std::chrono::steady_clock;
  cancel();
  // One that goes on talking is not waited for any longer than a silent one.
  const Clock::time_point until = Clock::now() + kPatience;
  while (poll()) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()).count();
    if (left <= 0) {
      kill(process_, SIGKILL);
      end();  // whatever programs of its own still hold the pipe
      break;
    }
    pollfd more{output_, POLLIN, 0};
    ::poll(&more, 1, static_cast<int>(left));
  }
}

void TuneSearch::cancel() {
  if (process_ == 0) return;
  cancelled_ = true;
  kill(process_, SIGTERM);
}

bool TuneSearch::poll() {
  char buffer[4096];
  for (int i = 0; i < kMostReads && process_ != 0; ++i) {
    const ssize_t count = read(output_, buffer, sizeof buffer);
    if (count > 0)
      hear({buffer, static_cast<size_t>(count)});
    else if (count < 0 && errno == EAGAIN)
      break;
    else if (count == 0 || errno != EINTR)
      end();
  }
  return process_ != 0;
}

void TuneSearch::hear(const std::string& text) {
  for (const char c : text) {
    if (c != '\n') {
      if (line_.size() < kLongestLine) line_ += c;
    } else if (!line_.empty()) {
      said_ = oneLine(std::exchange(line_, {}), kLongestLine);
    }
  }
}

/// The program has ended, as it does when it closes the pipe, or is about to.
void TuneSearch::end() {
  close(std::exchange(output_, -1));
  const std::string failure = awaitProgram(std::exchange(process_, 0));
  if (failure.empty() || cancelled_) return;
  const std::string prefix = "limn: ";
  problem_ = said_.starts_with(prefix) ? said_.substr(prefix.size()) : "limn tune: " + failure;
}

}  // namespace limn::app
