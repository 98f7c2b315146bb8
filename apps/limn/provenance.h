// What made a picture, inside the picture.
#pragma once

#include <string>

#include "core/image/image.h"

namespace limn::app {

/// The command line of this process as a line for a shell, beginning with "limn"; paths as they were typed.
std::string commandLine();

/// Puts the command that gives the picture and limn's version into the picture's metadata ("command",
/// "version"). What a signed picture holds depends on nothing else: no clock, no machine.
void sign(Image& picture, const std::string& command = commandLine());

}  // namespace limn::app
