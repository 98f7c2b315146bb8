#include "core/base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#include "core/base/error.h"

namespace limn {
namespace {

[[noreturn]] void failWrite(const std::filesystem::path& path, int error) {
  throw Error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(error)));
}

/// Unique within the machine: process number and a count; the same folder, so that rename cannot cross
/// devices.
std::filesystem::path temporaryBeside(const std::filesystem::path& path) {
  static std::atomic<unsigned> count{0};
  return path.parent_path() / fmt::format(".{}.{}-{}.part", path.filename().string(), ::getpid(), count++);
}

/// Returns 0 or the error number.
int writeAll(int file, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return 0;
}

template <class Container>
Container readInto(const std::filesystem::path& path, std::uint64_t maxBytes) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw Error(fmt::format("{}: no such file", path.string()));
  if (!std::filesystem::is_regular_file(path, error)) {
    throw Error(fmt::format("{}: not a regular file", path.string()));
  }
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error) throw Error(fmt::format("{}: cannot be read: {}", path.string(), error.message()));
  if (size > maxBytes) {
    throw Error(fmt::format("{}: {} bytes, at most {} are accepted", path.string(), size, maxBytes));
  }
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw Error(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
  Container content(size, typename Container::value_type{});
  std::size_t done = 0;
  int failure = 0;
  while (done < size) {
    const ssize_t count = ::read(file, content.data() + done, size - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      failure = count < 0 ? errno : EIO;
      break;
    }
    done += static_cast<std::size_t>(count);
  }
  ::close(file);
  if (failure != 0) {
    throw Error(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(failure)));
  }
  return content;
}

}  // namespace

std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t maxBytes) {
  return readInto<std::vector<std::byte>>(path, maxBytes);
}

std::string readTextFile(const std::filesystem::path& path, std::uint64_t maxBytes) {
  return readInto<std::string>(path, maxBytes);
}

void writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  const std::filesystem::path temporary = temporaryBeside(path);
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) failWrite(path, errno);
  int error = writeAll(file, bytes);
  // Some file systems report a full disk only here.
  if (error == 0 && ::fsync(file) != 0 && errno != EINVAL) error = errno;
  if (::close(file) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    failWrite(path, error);
  }
}

void writeTextFile(const std::filesystem::path& path, std::string_view text) {
  writeFile(path, std::as_bytes(std::span(text.data(), text.size())));
}

}  // namespace limn
