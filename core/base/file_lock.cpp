#include "core/base/file_lock.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <thread>

#include "core/base/error.h"

namespace limn {
namespace {

std::string ownName() {
  utsname system{};
  ::uname(&system);
  return fmt::format("process {} on {} since {:%Y-%m-%d %H:%M:%S} UTC", ::getpid(), system.nodename,
                     fmt::gmtime(std::time(nullptr)));
}

/// What the holder wrote about itself.
std::string holder(int file) {
  std::array<char, 256> text{};
  const ssize_t count = ::pread(file, text.data(), text.size(), 0);
  std::string name(text.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  std::ranges::replace_if(
      name, [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; }, '?');
  return name.empty() ? "another process" : name;
}

/// Whether `name`, as ownName() makes it, is that of a process of this machine that has ended: what holds its
/// lock are processes it started, which end with it but a moment later.
bool ended(const std::string& name) {
  utsname system{};
  ::uname(&system);
  int id = 0, length = 0;
  if (std::sscanf(name.c_str(), "process %d on %n", &id, &length) != 1 || length == 0 || id <= 0)
    return false;
  const std::string host = fmt::format("{} since ", system.nodename);
  return name.compare(static_cast<std::size_t>(length), host.size(), host) == 0 && ::kill(id, 0) != 0 &&
         errno == ESRCH;
}

constexpr int kPatience = 500;  // times 10 ms

/// Whether the open file is still the one of that name: its former holder may have removed it meanwhile.
bool isFile(int file, const std::filesystem::path& path) {
  struct stat open {
  }, named{};
  return ::fstat(file, &open) == 0 && ::stat(path.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
         open.st_dev == named.st_dev;
}

}  // namespace

FileLock::FileLock(std::filesystem::path path, const std::string& what) : path_(std::move(path)) {
  for (int waited = 0;;) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0) return;
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
      const bool held = errno == EWOULDBLOCK;
      const std::string name = holder(file_);
      ::close(file_);
      file_ = -1;
      if (held && waited++ < kPatience && ended(name)) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        continue;
      }
      if (held)
        throw Error(fmt::format("{} is in use by {}; wait for it, or choose another place", what, name));
      return;
    }
    if (isFile(file_, path_)) break;
    ::close(file_);
  }
  const std::string name = ownName();
  if (::ftruncate(file_, 0) == 0) [[maybe_unused]]
    const ssize_t written = ::pwrite(file_, name.data(), name.size(), 0);
}

FileLock::~FileLock() {
  if (file_ < 0) return;
  ::unlink(path_.c_str());
  ::close(file_);
}

}  // namespace limn
