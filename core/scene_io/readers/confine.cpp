#include "core/scene_io/readers/confine.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace limn {
namespace {

bool limit(decltype(RLIMIT_AS) resource, std::uint64_t soft, std::uint64_t hard) {
  const rlimit wanted{soft, hard};
  if (setrlimit(resource, &wanted) == 0) return true;
  rlimit now{};  // one that is narrower already cannot be widened, and does as well
  return getrlimit(resource, &now) == 0 && now.rlim_max <= hard;
}

}  // namespace

bool confine(std::uint64_t memory, unsigned seconds) {
  alarm(seconds + 1);
  bool granted = prctl(PR_SET_PDEATHSIG, SIGKILL) == 0;
  granted &= prctl(PR_SET_DUMPABLE, 0) == 0;  // where core dumps go to a program their limit says nothing
  granted &= limit(RLIMIT_CORE, 0, 0) && limit(RLIMIT_FSIZE, 0, 0);
  granted &= limit(RLIMIT_CPU, seconds, seconds + 1);
#if !defined(LIMN_SANITIZED)  // whose shadow memory alone takes terabytes of addresses
  granted &= limit(RLIMIT_AS, memory, memory);
#else
  static_cast<void>(memory);
#endif
  return granted;
}

bool writeAnswer(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
  return true;
}

}  // namespace limn
