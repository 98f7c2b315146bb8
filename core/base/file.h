// Declares functions that read files and that write files completely or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"

namespace limn {

/// Returns the content of a regular file. Throws Error naming the file when it is missing, unreadable or
/// larger than `maxBytes`.
LIMN_API std::vector<std::byte> readFile(const std::filesystem::path& path,
                                         std::uint64_t maxBytes = std::uint64_t{1} << 34);
LIMN_API std::string readTextFile(const std::filesystem::path& path,
                                  std::uint64_t maxBytes = std::uint64_t{1} << 30);

/// Returns the first `bytes` bytes of a regular file, all where it has no more. Throws Error naming the file
/// when it is missing or unreadable.
LIMN_API std::string readBeginning(const std::filesystem::path& path, std::uint64_t bytes);

/// Hands each line of a regular file that ends in '\n' to `take`, without that. Returns the bytes of these
/// lines: what follows them is torn. No more than one line is held at a time. Throws Error naming the file
/// when it is missing, unreadable or has a line of more than `maxBytes`.
LIMN_API std::uint64_t readLines(const std::filesystem::path& path,
                                 const std::function<void(const std::string&)>& take,
                                 std::uint64_t maxBytes = std::uint64_t{1} << 30);

/// Returns whether `path` names something that a file must not take the place of: a device, a pipe, a socket,
/// or what a process has open (/dev/stdout).
LIMN_API bool isSpecialFile(const std::filesystem::path& path);

/// Holds a new file beside `target` that gets that name when it is whole. Other programs may write to it. It
/// is gone when its holder ends before that; where the process is killed, removeAbandonedFiles() removes it.
class LIMN_API TemporaryFile {
 public:
  /// Creates the file. Throws Error naming `target` and the reason.
  explicit TemporaryFile(std::filesystem::path target);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Appends to the file. Throws Error naming the target.
  void write(std::span<const std::byte> bytes);
  /// Flushes the file and gives it the name of its target, in place of what has that name. Throws Error
  /// naming the target.
  void keep();

 private:
  std::filesystem::path target_, path_;
  int file_ = -1;
  bool kept_ = false;
};

/// Writes to a temporary file beside `path`, flushes it and renames it: readers see the old file or the new
/// one, never a part. Throws Error naming `path` and the reason (no such folder, no permission, disk full, a
/// special file) and leaves nothing behind.
LIMN_API void writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);
LIMN_API void writeTextFile(const std::filesystem::path& path, std::string_view text);

/// Removes from a folder the temporary files that were left there when their process was killed and that no
/// living writer holds. Leaves other files alone, and does nothing when the folder does not exist.
LIMN_API void removeAbandonedFiles(const std::filesystem::path& folder);

/// Returns where the regular file `file` of `folder` lies, or nothing where there is none or where it lies
/// outside of the folder, links followed: what a list of names may be allowed to read or remove.
LIMN_API std::filesystem::path fileInFolder(const std::filesystem::path& folder, const std::string& file);

/// Creates the folder and all folders above it; does nothing where it exists. Throws Error when that fails.
LIMN_API void createFolder(const std::filesystem::path& folder);

/// Returns `path` with `suffix` appended to its file name. A name that would become too long for file systems
/// (255 bytes) is cut and made unique by a hash of the whole name.
LIMN_API std::filesystem::path beside(const std::filesystem::path& path, std::string_view suffix);

}  // namespace limn
