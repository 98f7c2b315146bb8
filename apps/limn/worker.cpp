#include "apps/limn/worker.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/failure.h"
#include "core/base/whereabouts.h"

namespace limn::app {

struct WorkerReport::Shared {
  enum class Ending : int { none, returned, error, usageError };
  std::atomic<int> current{-1};
  std::atomic<unsigned> signsOfLife{0};
  std::atomic<Ending> ending{Ending::none};
  char renderer[256] = {};
  char message[4096] = {};

  /// One for each case, behind the object.
  std::atomic<State>& state(std::size_t caseIndex) {
    return reinterpret_cast<std::atomic<State>*>(this + 1)[caseIndex];
  }
};

namespace {

template <std::size_t N>
void copyText(char (&to)[N], const std::string& from) {
  const std::size_t length = std::min(from.size(), N - 1);
  std::memcpy(to, from.data(), length);
  to[length] = 0;
}

/// Waits until the child has ended, and ends it when `signsOfLife` stands still for too long; gives what
/// waitpid says, and whether the child was ended.
std::pair<int, bool> waitFor(pid_t child, double stallTimeout, const std::atomic<unsigned>& signsOfLife) {
  constexpr double tick = 0.02;  // seconds
  // Ticks are counted instead of time: while all of this program is stopped (Ctrl-Z), nothing can progress.
  double idle = 0;
  bool ended = false;
  for (unsigned last = signsOfLife;;) {
    int status = 0;
    const pid_t done = waitpid(child, &status, WNOHANG);
    if (done == child) return {status, ended};
    if (done < 0 && errno != EINTR)
      throw Error(fmt::format("waiting for a worker process failed: {}", std::strerror(errno)));
    std::this_thread::sleep_for(std::chrono::duration<double>(tick));
    idle = signsOfLife == last ? idle + tick : 0;
    last = signsOfLife;
    if (stallTimeout <= 0 || idle < stallTimeout || ended) continue;
    kill(child, SIGKILL);
    ended = true;
  }
}

}  // namespace

WorkerReport::WorkerReport(std::size_t cases) : bytes_(sizeof(Shared) + cases * sizeof(std::atomic<State>)) {
  void* memory = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED)
    throw Error(fmt::format("no memory can be shared with a worker: {}", std::strerror(errno)));
  shared_ = new (memory) Shared;
  for (std::size_t i = 0; i < cases; ++i) new (&shared_->state(i)) std::atomic<State>(State::open);
}

WorkerReport::~WorkerReport() {
  munmap(shared_, bytes_);
}

void WorkerReport::started(std::size_t caseIndex) {
  shared_->current = static_cast<int>(caseIndex);
  alive();
}
void WorkerReport::finished(std::size_t caseIndex, State state) {
  std::atomic<State>& known = shared_->state(caseIndex);
  if (known == State::open || known == State::failed) known = state;
  alive();
}
void WorkerReport::alive() {
  ++shared_->signsOfLife;
}
void WorkerReport::renderer(const std::string& name) {
  copyText(shared_->renderer, name);
}
std::optional<std::size_t> WorkerReport::current() const {
  const int index = shared_->current;
  return index < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(index));
}
WorkerReport::State WorkerReport::state(std::size_t caseIndex) const {
  return shared_->state(caseIndex);
}
std::string WorkerReport::renderer() const {
  return shared_->renderer;
}

std::optional<Crash> runInWorker(WorkerReport& report, double stallTimeout,
                                 const std::function<void()>& work) {
  using Ending = WorkerReport::Shared::Ending;
  WorkerReport::Shared& shared = *report.shared_;
  shared.current = -1;
  shared.ending = Ending::none;
  std::fflush(nullptr);
  const pid_t parent = getpid(), child = fork();
  if (child < 0) throw Error(fmt::format("no worker process can be started: {}", std::strerror(errno)));
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);  // the parent has the last words
    shared.message[0] = 0;
    leaveWordsAtCrash(shared.message, sizeof shared.message);
    Ending ending = Ending::returned;
    try {
      work();
    } catch (const UsageError& error) {
      ending = Ending::usageError;
      copyText(shared.message, error.what());
    } catch (...) {
      ending = Ending::error;
      copyText(shared.message, currentFailure());
    }
    std::fflush(nullptr);
    shared.ending = ending;
    _exit(0);  // what this process inherited is the parent's to destroy
  }
  const auto [status, stalled] = waitFor(child, stallTimeout, shared.signsOfLife);
  switch (shared.ending) {
    case Ending::returned:
      return std::nullopt;
    case Ending::usageError:
      throw UsageError(shared.message);
    case Ending::error:
      throw Error(shared.message);
    case Ending::none:
      break;
  }
  if (stalled) return Crash{fmt::format("no progress for {} s", stallTimeout)};
  if (!WIFSIGNALED(status)) return Crash{fmt::format("ended with status {}", WEXITSTATUS(status))};
  const int signal = WTERMSIG(status);
  if (signal == SIGINT || signal == SIGTERM) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  return Crash{fmt::format("crashed: {}", shared.message[0] != 0 ? shared.message : strsignal(signal))};
}

}  // namespace limn::app
