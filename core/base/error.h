// The two failures a command can end in. A message is one line: what failed, where, and what would be
// accepted.
#pragma once

#include <stdexcept>
#include <string>

#include "core/base/export.h"

namespace limn {

/// The work failed: a file is missing or broken, no driver, a full disk. Exit status 1.
class LIMN_API Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
};

/// The request makes no sense: unknown name, value out of range, conflicting techniques. Exit status 2.
class LIMN_API UsageError : public Error {
 public:
  explicit UsageError(const std::string& message) : Error(message) {}
};

}  // namespace limn
