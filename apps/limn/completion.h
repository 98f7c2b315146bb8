// Declares the completion of limn's command line by shells.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace limn::app {

/// Returns a script for bash that completes the program's commands, their options, and the values of options
/// that take one of a few; file names elsewhere. A command that hands its words to another program (limn
/// view) is completed by that program's flag --completion.
std::string bashCompletion(const CLI::App& program);

/// Adds the flag --completion, which prints that script and ends the program. It is not in the help.
void addCompletionFlag(CLI::App& program);

}  // namespace limn::app
