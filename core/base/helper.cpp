#include "core/base/helper.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "core/base/error.h"

namespace limn {
namespace {

using Clock = std::chrono::steady_clock;

class File {
 public:
  explicit File(int number) : number_(number) {}
  ~File() { close(); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

/// A started helper whose standard output is `out`.
pid_t start(const std::string& program, const std::vector<std::string>& arguments, int out) {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  sigset_t defaults, blocked;
  sigfillset(&defaults);
  sigemptyset(&blocked);
  for (const int interruption : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) sigaddset(&blocked, interruption);
  std::vector<char*> pointers{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);

  int error = posix_spawn_file_actions_init(&files);
  if (error != 0) throw Error(fmt::format("{} cannot be started: {}", program, std::strerror(error)));
  error = posix_spawnattr_init(&attributes);
  pid_t child = 0;
  const auto attempt = [&](int result) {
    if (error == 0) error = result;
  };
  attempt(posix_spawn_file_actions_adddup2(&files, out, STDOUT_FILENO));
  attempt(posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0));
  attempt(posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0));
  attempt(posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1));
  attempt(posix_spawnattr_setsigdefault(&attributes, &defaults));
  attempt(posix_spawnattr_setsigmask(&attributes, &blocked));
  attempt(posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK));
  if (error == 0) error = posix_spawn(&child, program.c_str(), &files, &attributes, pointers.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw Error(fmt::format("{} cannot be started: {}", program, std::strerror(error)));
  return child;
}

/// Reads what the helper writes until it closes its output; returns why it is to be stopped before, or
/// nothing.
std::string receive(int in, const HelperLimits& limits, std::vector<std::byte>& bytes) {
  constexpr std::size_t block = std::size_t{1} << 20;
  const Clock::time_point end = Clock::now() + limits.time;
  std::size_t size = 0;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd ready{in, POLLIN, 0};
    const int count = left > 0 ? poll(&ready, 1, static_cast<int>(std::min<long>(left, 1 << 30))) : 0;
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0)
      return fmt::format("it takes longer than {} s", static_cast<double>(limits.time.count()) / 1000);
    if (bytes.size() - size < block)
      bytes.resize(std::min(std::max(2 * bytes.size(), block), limits.answerBytes + 1));
    const ssize_t got = ::read(in, bytes.data() + size, bytes.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return fmt::format("its answer cannot be read: {}", std::strerror(errno));
    size += static_cast<std::size_t>(got);
    if (size > limits.answerBytes) return "it answers more than was asked for";
    if (got > 0) continue;
    bytes.resize(size);
    return {};
  }
}

/// Ends the helper if it has not ended and says how it failed, or nothing. One that has closed its output is
/// about to end, which a signal no longer changes.
std::string finish(pid_t child) {
  kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return {};  // where nobody waits for children (SIGCHLD ignored) the answer must do
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU || signal == SIGALRM) return "it takes too long";
    const char* what = sigdescr_np(signal);
    return fmt::format("it crashed: {}", what ? what : fmt::format("signal {}", signal));
  }
  return WEXITSTATUS(status) == 0 ? "" : fmt::format("it ended with status {}", WEXITSTATUS(status));
}

}  // namespace

std::filesystem::path libraryFolder() {
  Dl_info self{};
  if (dladdr(reinterpret_cast<void*>(&libraryFolder), &self) == 0 || !self.dli_fname) return {};
  return std::filesystem::absolute(self.dli_fname).parent_path();
}

HelperAnswer runHelper(const std::string& name, const std::vector<std::string>& arguments,
                       const HelperLimits& limits) {
  const std::string program = (libraryFolder() / "limn" / name).string();
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw Error(fmt::format("{} cannot be started: {}", program, std::strerror(errno)));
  const File in(ends[0]);
  File out(ends[1]);
  const pid_t child = start(program, arguments, out.number());
  out.close();
  HelperAnswer answer;
  try {
    answer.failure = receive(in.number(), limits, answer.bytes);
  } catch (...) {
    finish(child);
    throw;
  }
  const std::string ending = finish(child);
  if (answer.failure.empty()) answer.failure = ending;
  return answer;
}

}  // namespace limn
