// Declares `limn brdf fit`: what factorisations make of a BRDF.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace limn::app {

/// Declares the options of the subcommand and returns what to do once the command line has been parsed.
std::function<int()> addBrdfFit(CLI::App& command);

}  // namespace limn::app
