// Whole files: read into memory, written whole or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"

namespace limn {

/// The content of a regular file. Throws Error naming it if it is missing, unreadable or larger than
/// `maxBytes`.
LIMN_API std::vector<std::byte> readFile(const std::filesystem::path& path,
                                         std::uint64_t maxBytes = std::uint64_t{1} << 34);
LIMN_API std::string readTextFile(const std::filesystem::path& path,
                                  std::uint64_t maxBytes = std::uint64_t{1} << 30);

/// Writes beside `path`, flushes, then renames: readers see the old file or the new one, never a part. Throws
/// Error naming `path` and the reason (no such folder, no permission, disk full) and leaves nothing behind.
LIMN_API void writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);
LIMN_API void writeTextFile(const std::filesystem::path& path, std::string_view text);

/// Removes from a folder what writeFile() left there when its process was killed: unfinished files that no
/// living writer holds. Others, and a folder that is not there, are left as they are.
LIMN_API void removeAbandonedFiles(const std::filesystem::path& folder);

/// `path` with `suffix` behind its name. A name that file systems would then not take (255 bytes) is cut and
/// told apart by a hash of the whole.
LIMN_API std::filesystem::path beside(const std::filesystem::path& path, std::string_view suffix);

}  // namespace limn
