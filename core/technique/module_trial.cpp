// tryModule(): a module is loaded and unloaded in a process of its own before it is loaded in this one.
#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <link.h>
#include <sys/mman.h>
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

constexpr int kPatience = 10;  // seconds

/// How far a trial has come.
enum class Stage : int { loading, leaving, left };

const char* said(Stage stage) {
  return stage == Stage::loading ? "when it is loaded" : "when the program ends";
}

/// What a trial and who waits for it both see.
class SharedStage {
 public:
  SharedStage()
      : memory_(mmap(nullptr, sizeof(Stage), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    if (memory_ == MAP_FAILED)
      throw Error(fmt::format("no memory for the trial of a technique: {}", std::strerror(errno)));
  }
  ~SharedStage() { munmap(memory_, sizeof(Stage)); }
  SharedStage(const SharedStage&) = delete;
  SharedStage& operator=(const SharedStage&) = delete;

  Stage& operator*() const { return *static_cast<Stage*>(memory_); }

 private:
  void* memory_;
};

/// Whatever the module prints or leaves behind in its last moments is not part of the answer.
void silence() {
  const int nowhere = open("/dev/null", O_RDWR);
  if (nowhere < 0) return;
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
}

/// What the loader calls when a program ends, of a module that is loaded still: one that shares a variable
/// with others (an inline static, say) outlives dlclose().
void runDestructors(void* handle) {
  link_map* map = nullptr;
  if (dlinfo(handle, RTLD_DI_LINKMAP, &map) != 0) return;
  using Function = void (*)();
  const Function* functions = nullptr;
  size_t count = 0;
  Function last = nullptr;
  for (const ElfW(Dyn)* entry = map->l_ld; entry->d_tag != DT_NULL; ++entry) {
    if (entry->d_tag == DT_FINI_ARRAY)
      functions = reinterpret_cast<const Function*>(map->l_addr + entry->d_un.d_ptr);
    if (entry->d_tag == DT_FINI_ARRAYSZ) count = entry->d_un.d_val / sizeof(Function);
    if (entry->d_tag == DT_FINI) last = reinterpret_cast<Function>(map->l_addr + entry->d_un.d_ptr);
  }
  while (functions && count > 0) functions[--count]();
  if (last) last();
}

/// exit() would run the destructors of the whole program, whose threads are not here.
[[noreturn]] void runTrial(const std::filesystem::path& file, const std::string& name, Stage& stage) {
  silence();
  for (int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGALRM}) std::signal(signal, SIG_DFL);
  alarm(kPatience);
  try {
    const Module module(file, name);
    stage = Stage::leaving;
  } catch (const Error&) {  // will be refused once more, with the reason
  }
  stage = Stage::leaving;
  if (void* handle = dlopen(file.c_str(), RTLD_LAZY | RTLD_NOLOAD)) runDestructors(handle);
  stage = Stage::left;
  _exit(0);
}

}  // namespace

void tryModule(const std::filesystem::path& file, const std::string& name) {
  const SharedStage stage;
  const pid_t child = fork();
  if (child == 0) runTrial(file, name, *stage);
  int status = 0;
  pid_t ended = child;
  while (child > 0 && (ended = waitpid(child, &status, 0)) < 0 && errno == EINTR) {
  }
  // Where nobody waits for children (SIGCHLD ignored) how far it came must do.
  if (ended < 0 && *stage != Stage::left)
    throw Error(fmt::format("{}: it cannot be tried in a process of its own: {}", file.string(),
                            std::strerror(errno)));
  const char* when = said(*stage);
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
    throw Error(fmt::format("{}: it does not come back within {} s {}", file.string(), kPatience, when));
  if (WIFSIGNALED(status))
    throw Error(fmt::format("{}: it crashes {} ({})", file.string(), when, strsignal(WTERMSIG(status))));
  if (*stage != Stage::left)
    throw Error(
        fmt::format("{}: it ends its process {} (exit status {})", file.string(), when, WEXITSTATUS(status)));
}

}  // namespace limn
