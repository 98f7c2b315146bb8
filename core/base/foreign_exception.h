// Exceptions that cross from code that limn did not compile into limn.
#pragma once

#include <string>

#include "core/base/export.h"

namespace limn {

/// Inside a catch block: throws limn's own Error again as it is, and anything else as an Error that begins
/// with `who`, so that no exception outlives the module whose type it is.
[[noreturn]] LIMN_API void rethrowAsError(const std::string& who);

}  // namespace limn
