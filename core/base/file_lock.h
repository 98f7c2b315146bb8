// One process at a time.
#pragma once

#include <filesystem>
#include <string>

#include "core/base/export.h"

namespace limn {

/// Held by one process at a time, on this machine and on others that share the file system (flock). What a
/// killed process held is free when the processes that end with it have ended, too, which is waited for. The
/// file vanishes when the lock is given back in good order. File systems without locks, and folders in which
/// no file can be made, are not guarded.
class LIMN_API FileLock {
 public:
  /// `path` is the lock's own file, `what` what it stands for in messages. Throws Error "WHAT is in use by
  /// process 12 on HOST since 2026-01-31 12:00:00 UTC ...".
  FileLock(std::filesystem::path path, const std::string& what);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace limn
