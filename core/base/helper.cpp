#include "core/base/helper.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/base/error.h"
#include "core/base/spawn.h"

namespace limn {
namespace {

using Clock = std::chrono::steady_clock;

class File {
 public:
  explicit File(int number) : number_(number) {}
  ~File() {
    if (number_ >= 0) ::close(number_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

/// Returns the number of a file in memory that holds these bytes and is read from its beginning; -1 with
/// errno where there is none.
int fileOf(std::span<const std::byte> bytes) {
  const int file = memfd_create("limn", MFD_CLOEXEC);
  std::size_t done = 0;
  while (file >= 0 && done < bytes.size()) {
    const ssize_t count = ::pwrite(file, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const int error = errno;
      ::close(file);
      errno = error;
      return -1;
    }
    done += static_cast<std::size_t>(count);
  }
  return file;
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

}  // namespace

std::filesystem::path libraryFolder() {
  Dl_info self{};
  if (dladdr(reinterpret_cast<void*>(&libraryFolder), &self) == 0 || !self.dli_fname) return {};
  return std::filesystem::absolute(self.dli_fname).parent_path();
}

HelperAnswer runHelper(const std::string& name, const std::vector<std::string>& arguments,
                       const HelperLimits& limits, std::span<const std::byte> input) {
  const std::string program = (libraryFolder() / "limn" / name).string();
  const File given(input.empty() ? -1 : fileOf(input));
  if (!input.empty() && given.number() < 0)
    throw Error(fmt::format("{} cannot be started: {}", program, std::strerror(errno)));
  const PipedProgram child = startPiped(program, arguments, {.in = given.number()}, &StandardFiles::out);
  const File in(child.output);
  HelperAnswer answer;
  try {
    answer.failure = receive(in.number(), limits, answer.bytes);
  } catch (...) {
    endProgram(child.process);
    throw;
  }
  // One that has closed its output is about to end, which a signal no longer changes.
  const std::string ending = endProgram(child.process);
  if (answer.failure.empty()) answer.failure = ending;
  return answer;
}

}  // namespace limn
