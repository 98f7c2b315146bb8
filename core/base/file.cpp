#include "core/base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "core/base/error.h"

namespace limn {
namespace {

[[noreturn]] void failRead(const std::filesystem::path& path, int error) {
  throw Error(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(error)));
}

[[noreturn]] void failWrite(const std::filesystem::path& path, int error) {
  throw Error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(error)));
}

constexpr std::size_t kMaxName = 255;    // bytes, of Linux's file systems
constexpr std::size_t kShownName = 100;  // of the target's, in a temporary's
constexpr std::string_view kUnfinished = ".part";

/// A random number: a count or a process number comes back where processes have their own numbering.
std::string randomDigits() {
  std::uint64_t value = 0;
  if (::getrandom(&value, sizeof value, 0) != static_cast<ssize_t>(sizeof value))
    value = static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
  return fmt::format("{:016x}", value);
}

/// In the same folder, so that rename cannot cross devices.
std::filesystem::path temporaryBeside(const std::filesystem::path& path) {
  return path.parent_path() /
         fmt::format(".{}.{}{}", path.filename().string().substr(0, kShownName), randomDigits(), kUnfinished);
}

/// .NAME.0123456789abcdef.part, or .NAME.12-0.part of earlier versions.
bool isTemporary(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(kUnfinished)) return false;
  name.remove_suffix(kUnfinished.size());
  const std::string_view tag = name.substr(name.rfind('.') + 1);
  const std::size_t digits = tag.find_first_not_of("0123456789abcdef");
  if (digits == std::string_view::npos) return tag.size() == 16;
  return digits > 0 && tag[digits] == '-' && digits + 1 < tag.size() &&
         tag.find_first_not_of("0123456789", digits + 1) == std::string_view::npos;
}

/// A new file that this process writes: locked, so that removeAbandonedFiles() elsewhere leaves it alone. On
/// failure -1 and errno.
int openTemporary(const std::filesystem::path& path, std::filesystem::path& temporary) {
  for (;;) {
    temporary = temporaryBeside(path);
    const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0) {
      if (errno == EEXIST) continue;
      return -1;
    }
    // File systems without locks go without; there nothing is taken for abandoned either.
    while (::flock(file, LOCK_EX) != 0)
      if (errno != EINTR) return file;
    struct stat status {};
    if (::fstat(file, &status) == 0 && status.st_nlink > 0) return file;
    ::close(file);  // removed between open() and flock()
  }
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

/// A regular file that is open for reading.
class SourceFile {
 public:
  explicit SourceFile(const std::filesystem::path& path) : path_(path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    // It may be there: a folder above it may not be searched, a link may lead to itself.
    if (!std::filesystem::status_known(status)) failRead(path, error.value());
    if (!std::filesystem::exists(status)) throw Error(fmt::format("{}: no such file", path.string()));
    if (!std::filesystem::is_regular_file(status))
      throw Error(fmt::format("{}: not a regular file", path.string()));
    file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file_ < 0) failRead(path, errno);
  }
  ~SourceFile() { ::close(file_); }
  SourceFile(const SourceFile&) = delete;
  SourceFile& operator=(const SourceFile&) = delete;

  std::uint64_t size() const {
    struct stat status {};
    if (::fstat(file_, &status) != 0) failRead(path_, errno);
    return static_cast<std::uint64_t>(status.st_size);
  }

  /// Fills `bytes` as far as the file goes; gives how many that are.
  std::size_t read(std::span<std::byte> bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t count = ::read(file_, bytes.data() + done, bytes.size() - done);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) failRead(path_, errno);
      if (count == 0) break;
      done += static_cast<std::size_t>(count);
    }
    return done;
  }

 private:
  const std::filesystem::path& path_;
  int file_ = -1;
};

template <class Container>
Container readInto(const std::filesystem::path& path, std::uint64_t maxBytes) {
  SourceFile file(path);
  const std::uint64_t size = file.size();
  if (size > maxBytes)
    throw Error(fmt::format("{}: {} bytes, at most {} are accepted", path.string(), size, maxBytes));
  Container content(size, typename Container::value_type{});
  if (file.read(std::as_writable_bytes(std::span(content))) < size) failRead(path, EIO);
  return content;
}

}  // namespace

std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t maxBytes) {
  return readInto<std::vector<std::byte>>(path, maxBytes);
}

std::string readTextFile(const std::filesystem::path& path, std::uint64_t maxBytes) {
  return readInto<std::string>(path, maxBytes);
}

std::string readBeginning(const std::filesystem::path& path, std::uint64_t bytes) {
  SourceFile file(path);
  std::string content(std::min(file.size(), bytes), '\0');
  content.resize(file.read(std::as_writable_bytes(std::span(content))));
  return content;
}

std::uint64_t readLines(const std::filesystem::path& path,
                        const std::function<void(const std::string&)>& take, std::uint64_t maxBytes) {
  SourceFile file(path);
  std::vector<char> buffer(std::size_t{1} << 20);
  std::string line;
  std::uint64_t whole = 0;
  const auto extend = [&](std::string_view by) {
    line += by;
    if (line.size() > maxBytes)
      throw Error(
          fmt::format("{}: a line of more than the {} bytes that are accepted", path.string(), maxBytes));
  };
  while (const std::size_t count = file.read(std::as_writable_bytes(std::span(buffer)))) {
    std::string_view rest(buffer.data(), count);
    for (std::size_t end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
      extend(rest.substr(0, end));
      take(line);
      whole += line.size() + 1;
      line.clear();
      rest.remove_prefix(end + 1);
    }
    extend(rest);
  }
  return whole;
}

bool isSpecialFile(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
      !std::filesystem::is_directory(status))
    return true;
  // Of /dev/stdout, which may lead to a regular file.
  return std::filesystem::read_symlink(path, ignored).string().starts_with("/proc/");
}

TemporaryFile::TemporaryFile(std::filesystem::path target) : target_(std::move(target)) {
  if (isSpecialFile(target_))
    throw Error(fmt::format("{}: cannot be written: it is not a regular file", target_.string()));
  file_ = openTemporary(target_, path_);
  if (file_ < 0) failWrite(target_, errno);
}

TemporaryFile::~TemporaryFile() {
  if (!kept_) ::unlink(path_.c_str());
  ::close(file_);  // last, since it ends the lock; what it could report, fsync has reported
}

void TemporaryFile::write(std::span<const std::byte> bytes) {
  if (const int error = writeAll(file_, bytes)) failWrite(target_, error);
}

void TemporaryFile::keep() {
  // Some file systems report a full disk only here.
  if (::fsync(file_) != 0 && errno != EINVAL) failWrite(target_, errno);
  if (::rename(path_.c_str(), target_.c_str()) != 0) failWrite(target_, errno);
  kept_ = true;
}

void writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  TemporaryFile file(path);
  file.write(bytes);
  file.keep();
}

void writeTextFile(const std::filesystem::path& path, std::string_view text) {
  writeFile(path, std::as_bytes(std::span(text.data(), text.size())));
}

void removeAbandonedFiles(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (!isTemporary(entry.path().filename().string()) || !entry.is_regular_file(ignored)) continue;
    const int file = ::open(entry.path().c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(entry.path().c_str());
    ::close(file);
  }
}

std::filesystem::path fileInFolder(const std::filesystem::path& folder, const std::string& file) {
  std::error_code error;
  // Nothing is outside of an empty path, which names the current folder.
  const std::filesystem::path root =
      std::filesystem::weakly_canonical(folder.empty() ? std::filesystem::path(".") : folder, error);
  if (error) return {};
  const std::filesystem::path path = std::filesystem::weakly_canonical(folder / file, error);
  if (file.empty() || error || !std::filesystem::is_regular_file(path, error)) return {};
  const auto [end, ignored] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  return end == root.end() ? path : std::filesystem::path();
}

void createFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(fmt::format("folder '{}' cannot be created: {}", folder.string(), error.message()));
}

std::filesystem::path beside(const std::filesystem::path& path, std::string_view suffix) {
  std::string name = path.filename().string();
  if (name.size() + suffix.size() > kMaxName)
    name = fmt::format("{}.{:016x}", name.substr(0, kShownName), XXH3_64bits(name.data(), name.size()));
  return path.parent_path() / name.append(suffix);
}

}  // namespace limn
