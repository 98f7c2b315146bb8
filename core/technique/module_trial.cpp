// tryModule(): a module is loaded in a process of its own before it is loaded in this one.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "core/base/error.h"
#include "core/technique/module.h"

namespace limn {
namespace {

constexpr int lived = 113;    // exit status that a module is unlikely to end its process with
constexpr int patience = 10;  // seconds

/// Whatever the module prints or leaves behind in its last moments is not part of the answer.
void silence() {
  const int nowhere = open("/dev/null", O_RDWR);
  if (nowhere < 0) return;
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
}

[[noreturn]] void runTrial(const std::filesystem::path& file, const std::string& name) {
  silence();
  for (int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGALRM}) std::signal(signal, SIG_DFL);
  alarm(patience);
  try {
    const Module module(file, name);
  } catch (const Error&) {  // will be refused once more, with the reason
  }
  _exit(lived);
}

}  // namespace

void tryModule(const std::filesystem::path& file, const std::string& name) {
  const pid_t child = fork();
  if (child == 0) runTrial(file, name);
  int status = 0;
  pid_t ended = child;
  while (child > 0 && (ended = waitpid(child, &status, 0)) < 0 && errno == EINTR) {
  }
  if (ended < 0)
    throw Error(fmt::format("{}: it cannot be tried in a process of its own: {}", file.string(),
                            std::strerror(errno)));
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
    throw Error(
        fmt::format("{}: it does not come back within {} s when it is loaded", file.string(), patience));
  if (WIFSIGNALED(status))
    throw Error(
        fmt::format("{}: it crashes when it is loaded ({})", file.string(), strsignal(WTERMSIG(status))));
  if (WEXITSTATUS(status) != lived)
    throw Error(fmt::format("{}: it ends its process when it is loaded (exit status {})", file.string(),
                            WEXITSTATUS(status)));
}

}  // namespace limn
