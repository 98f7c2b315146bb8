// Declares the commands of limn. Each command adds its options to the command line and runs when it is
// chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace limn::app {

using Action = std::function<int()>;  ///< returns the exit status; may throw limn::Error

/// Declares the options of one command, as do all functions below, and returns what to do once the command
/// line has been parsed.
Action addListCommand(CLI::App& command);
Action addInfoCommand(CLI::App& command);
Action addImportCommand(CLI::App& command);
Action addRenderCommand(CLI::App& command);
Action addReferenceCommand(CLI::App& command);
Action addEnvironmentCommand(CLI::App& command);
Action addBrdfCommand(CLI::App& command);
Action addCompareCommand(CLI::App& command);
Action addBenchCommand(CLI::App& command);
Action addTuneCommand(CLI::App& command);
Action addStressCommand(CLI::App& command);
Action addFlickerCommand(CLI::App& command);
Action addExplainCostCommand(CLI::App& command);
Action addPassesCommand(CLI::App& command);
Action addReportCommand(CLI::App& command);
Action addMergeCommand(CLI::App& command);
Action addReproductionCommand(CLI::App& command);
Action addSchemaCommand(CLI::App& command);
Action addViewCommand(CLI::App& command);

}  // namespace limn::app
