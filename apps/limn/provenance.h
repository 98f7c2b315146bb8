// Stores in a picture how it was made.
#pragma once

#include <string>

#include "core/image/image.h"

namespace limn::app {

/// Returns the command line of this process as a line for a shell, beginning with "limn"; paths are kept as
/// they were typed.
std::string commandLine();

/// Puts the command that gives the picture and limn's version into the picture's metadata ("command",
/// "version"). The content of a signed picture depends on nothing else, in particular on no clock and no
/// machine.
void sign(Image& picture, const std::string& command = commandLine());

}  // namespace limn::app
