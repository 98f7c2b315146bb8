// Declares the handling of exceptions that enter limn from code that was compiled separately.
#pragma once

#include <string>

#include "core/base/export.h"

namespace limn {

/// Rethrows limn's own Error unchanged, and any other exception as an Error that begins with `who`, so that
/// no exception outlives the module that defines its type. Must be called inside a catch block.
[[noreturn]] LIMN_API void rethrowAsError(const std::string& who);

}  // namespace limn
