// Declares how any thrown object is described on one line.
#pragma once

#include <string>

#include "core/base/export.h"

namespace limn {

/// Returns the message of the exception that is being handled, on one line: "out of memory" for
/// std::bad_alloc, and a fixed sentence for anything that is not a std::exception. Must be called inside a
/// catch block.
LIMN_API std::string currentFailure();

}  // namespace limn
