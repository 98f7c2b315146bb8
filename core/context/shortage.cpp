#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "core/context/private/backends.h"

namespace limn {
namespace {

/// What Mesa's software renderer takes with LLVM: libraries of 200 MiB, then heaps and stacks of its threads.
constexpr std::size_t kDriverBytes = std::size_t{512} << 20;
/// A vendor's description, libraries and their dependencies, devices.
constexpr std::size_t kDriverFiles = 4;

/// 0, or why that many files cannot be opened.
int filesError() {
  std::array<int, kDriverFiles> files;
  files.fill(-1);
  int error = 0;
  for (int& file : files) {
    file = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (file < 0) {
      error = errno;
      break;
    }
  }
  for (const int file : files)
    if (file >= 0) close(file);
  return error;
}

/// 0, or why that much memory cannot be had. None of it is touched.
int memoryError() {
  void* memory = mmap(nullptr, kDriverBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return errno;
  munmap(memory, kDriverBytes);
  return 0;
}

}  // namespace

std::string driverShortage() {
  if (const int error = filesError())
    return fmt::format("a driver opens several files at once ({}); `ulimit -n` must leave room for {} more",
                       std::strerror(error), kDriverFiles);
  if (const int error = memoryError())
    return fmt::format("too little memory for a driver ({}); `ulimit -v` and the machine must leave {} MiB",
                       std::strerror(error), kDriverBytes >> 20);
  return {};
}

}  // namespace limn
