// Stores in a picture how it was made.
#pragma once

#include <string>

#include "core/base/export.h"
#include "core/image/image.h"

namespace limn {

/// Puts the command that gives the picture and limn's version into the picture's metadata ("command",
/// "version"). The content of a signed picture depends on nothing else, in particular on no clock and no
/// machine.
LIMN_API void sign(Image& picture, const std::string& command);

}  // namespace limn
