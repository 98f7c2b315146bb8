// Declares the version of limn, which is defined once, in the project's CMakeLists.txt.
#pragma once

#include "core/base/export.h"

namespace limn {

/// Returns "MAJOR.MINOR.PATCH" of the loaded liblimn.
LIMN_API const char* version();

}  // namespace limn
