#include "apps/limn/worker.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>

#include "core/base/error.h"

namespace limn::app {

struct WorkerReport::Shared {
  enum class Ending : int { none, returned, error, usageError };
  std::atomic<int> caseIndex{-1};
  std::atomic<Ending> ending{Ending::none};
  char renderer[256] = {};
  char message[4096] = {};
};

namespace {

template <std::size_t N>
void copyText(char (&to)[N], const std::string& from) {
  const std::size_t length = std::min(from.size(), N - 1);
  std::memcpy(to, from.data(), length);
  to[length] = 0;
}

/// Sleeps until the child has ended; gives what waitpid says.
int waitFor(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR)
      throw Error(fmt::format("waiting for a worker process failed: {}", std::strerror(errno)));
  return status;
}

}  // namespace

WorkerReport::WorkerReport() {
  void* memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED)
    throw Error(fmt::format("no memory can be shared with a worker: {}", std::strerror(errno)));
  shared_ = new (memory) Shared;
}

WorkerReport::~WorkerReport() {
  munmap(shared_, sizeof(Shared));
}

void WorkerReport::started(int caseIndex) {
  shared_->caseIndex = caseIndex;
}
void WorkerReport::renderer(const std::string& name) {
  copyText(shared_->renderer, name);
}
int WorkerReport::caseIndex() const {
  return shared_->caseIndex;
}
std::string WorkerReport::renderer() const {
  return shared_->renderer;
}

std::optional<Crash> runInWorker(WorkerReport& report, const std::function<void()>& work) {
  using Ending = WorkerReport::Shared::Ending;
  WorkerReport::Shared& shared = *report.shared_;
  shared.caseIndex = -1;
  shared.ending = Ending::none;
  std::fflush(nullptr);
  const pid_t parent = getpid(), child = fork();
  if (child < 0) throw Error(fmt::format("no worker process can be started: {}", std::strerror(errno)));
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);  // the parent has the last words
    Ending ending = Ending::returned;
    try {
      work();
    } catch (const UsageError& error) {
      ending = Ending::usageError;
      copyText(shared.message, error.what());
    } catch (const std::bad_alloc&) {
      ending = Ending::error;
      copyText(shared.message, "out of memory");
    } catch (const std::exception& error) {
      ending = Ending::error;
      copyText(shared.message, error.what());
    }
    std::fflush(nullptr);
    shared.ending = ending;
    _exit(0);  // what this process inherited is the parent's to destroy
  }
  const int status = waitFor(child);
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
  if (!WIFSIGNALED(status)) return Crash{fmt::format("ended with status {}", WEXITSTATUS(status))};
  const int signal = WTERMSIG(status);
  if (signal == SIGINT || signal == SIGTERM) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  return Crash{fmt::format("crashed: {}", strsignal(signal))};
}

}  // namespace limn::app
