// Stores in a picture the command line that made it.
#pragma once

#include <string>

#include "core/image/image.h"

namespace limn::app {

/// Returns the command line of this process as a line for a shell, beginning with "limn"; paths are kept as
/// they were typed.
std::string commandLine();

/// Does what limn::sign() does, with the command line of this process.
void sign(Image& picture);

}  // namespace limn::app
