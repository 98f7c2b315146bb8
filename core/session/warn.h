// Declares how this library reports warnings, which do not end the work.
#pragma once

#include <functional>
#include <string>

namespace limn::session {

/// Receives one line with a warning; an empty function discards warnings.
using Warn = std::function<void(const std::string&)>;

}  // namespace limn::session
