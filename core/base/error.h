// Declares the two kinds of failure that can end a command. A message is one line that says what failed,
// where, and what would be accepted.
#pragma once

#include <stdexcept>
#include <string>

#include "core/base/export.h"

namespace limn {

/// Reports that the work failed (missing or broken file, no driver, full disk). Exit status 1.
class LIMN_API Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
};

/// Reports that the request is invalid (unknown name, value out of range, conflicting techniques). Exit
/// status 2.
class LIMN_API UsageError : public Error {
 public:
  explicit UsageError(const std::string& message) : Error(message) {}
};

}  // namespace limn
