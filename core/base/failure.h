// What was thrown, whatever it is, as one line.
#pragma once

#include <string>

#include "core/base/export.h"

namespace limn {

/// To be called while an exception is handled: its message on one line; "out of memory" for std::bad_alloc,
/// and a sentence for what is no std::exception.
LIMN_API std::string currentFailure();

}  // namespace limn
