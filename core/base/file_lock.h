// Declares a lock that lets one process at a time use something.
#pragma once

#include <filesystem>
#include <string>

#include "core/base/export.h"

namespace limn {

/// Holds a lock that one process at a time can have, on this machine and on others that share the file system
/// (flock). The lock of a killed process becomes free when the processes that it started and that end with it
/// have ended, too; the constructor waits for that. The file is removed when the lock is released in an
/// orderly way. File systems without locks, and folders in which no file can be created, are not guarded.
class LIMN_API FileLock {
 public:
  /// Takes the lock: `path` is the lock's own file, `what` names the locked thing in messages. Throws Error
  /// "WHAT is in use by process 12 on HOST since 2026-01-31 12:00:00 UTC ..." when another process holds it.
  FileLock(std::filesystem::path path, const std::string& what);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace limn
