#include "core/base/spawn.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "core/base/error.h"

namespace limn {

pid_t startProgram(const std::string& program, const std::vector<std::string>& arguments,
                   const StandardFiles& standard, Interrupts interrupts) {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  sigset_t defaults, blocked;
  sigfillset(&defaults);
  sigemptyset(&blocked);
  if (interrupts == Interrupts::blocked)
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
  const auto give = [&](int file, int as, int mode) {
    attempt(file >= 0 ? posix_spawn_file_actions_adddup2(&files, file, as)
                      : posix_spawn_file_actions_addopen(&files, as, "/dev/null", mode, 0));
  };
  give(standard.in, STDIN_FILENO, O_RDONLY);
  give(standard.out, STDOUT_FILENO, O_WRONLY);
  give(standard.err, STDERR_FILENO, O_WRONLY);
  attempt(posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1));
  attempt(posix_spawnattr_setsigdefault(&attributes, &defaults));
  attempt(posix_spawnattr_setsigmask(&attributes, &blocked));
  attempt(posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK));
  if (error == 0)
    error = posix_spawnp(&child, program.c_str(), &files, &attributes, pointers.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw Error(fmt::format("{} cannot be started: {}", program, std::strerror(error)));
  return child;
}

PipedProgram startPiped(const std::string& program, const std::vector<std::string>& arguments,
                        StandardFiles files, int StandardFiles::*piped, Interrupts interrupts) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw Error(fmt::format("{} cannot be started: {}", program, std::strerror(errno)));
  files.*piped = ends[1];
  PipedProgram started{0, ends[0]};
  try {
    started.process = startProgram(program, arguments, files, interrupts);
  } catch (...) {
    close(ends[0]);
    close(ends[1]);
    throw;
  }
  close(ends[1]);
  return started;
}

bool programExists(const std::string& name) {
  const char* folders = std::getenv("PATH");
  std::istringstream text(folders ? folders : "/bin:/usr/bin");
  for (std::string folder; std::getline(text, folder, ':');)
    if (access((std::filesystem::path(folder) / name).c_str(), X_OK) == 0) return true;
  return false;
}

std::string awaitProgram(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0)
    if (errno != EINTR) return {};  // where nobody waits for children (SIGCHLD ignored) the answer must do
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU || signal == SIGALRM) return "it takes too long";
    const char* what = sigdescr_np(signal);
    return fmt::format("it crashed: {}", what ? what : fmt::format("signal {}", signal));
  }
  return WEXITSTATUS(status) == 0 ? "" : fmt::format("it ended with status {}", WEXITSTATUS(status));
}

std::string endProgram(pid_t process) {
  kill(process, SIGKILL);
  return awaitProgram(process);
}

ProgramOutput programOutput(const std::string& program, const std::vector<std::string>& arguments, bool talks,
                            const std::function<bool()>& stopped) {
  constexpr int kPatience = 100;  // milliseconds
  const PipedProgram started =
      startPiped(program, arguments, {.err = talks ? STDERR_FILENO : -1}, &StandardFiles::out);
  ProgramOutput output;
  char buffer[4096];
  bool ends = false;
  for (ssize_t count = 1; count > 0 || (count < 0 && errno == EINTR);) {
    ends = stopped && stopped();
    if (ends) break;
    pollfd readable{started.output, POLLIN, 0};
    if (stopped && poll(&readable, 1, kPatience) <= 0) continue;
    count = read(started.output, buffer, sizeof buffer);
    if (count > 0) output.text.append(buffer, static_cast<size_t>(count));
  }
  close(started.output);
  output.failure = ends ? endProgram(started.process) : awaitProgram(started.process);
  while (output.text.ends_with('\n')) output.text.pop_back();
  return output;
}

}  // namespace limn
