// Declares the completion of limn's command line by shells.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace limn::app {

/// Returns a script for bash that completes the program's commands, their options, and the values of options
/// that take one of a few; file names elsewhere.
std::string bashCompletion(const CLI::App& program);

}  // namespace limn::app
