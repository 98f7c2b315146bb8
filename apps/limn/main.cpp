// limn: the command line.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>

#include "apps/limn/commands.h"
#include "apps/limn/completion.h"
#include "apps/limn/interruption.h"
#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/base/whereabouts.h"

namespace {

/// CLI11 would call an unknown command a missing one.
void checkCommand(const CLI::App& limn, const std::string& name) {
  std::vector<std::string> known;
  for (const CLI::App* command : limn.get_subcommands({})) known.push_back(command->get_name());
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  throw limn::UsageError("unknown command '" + name + "'" + limn::didYouMean(name, known) + "; known are " +
                         limn::joined(known));
}

/// Returns the command whose arguments were read last, with the program's name before it.
std::string chosenCommand(const CLI::App& program) {
  std::string name = program.get_name();
  for (std::vector<CLI::App*> chosen = program.get_subcommands(); !chosen.empty();
       chosen = chosen.back()->get_subcommands())
    name += " " + chosen.back()->get_name();
  return name;
}

/// Throws Error unless all that was printed has been written. Of what failed before the end only the stream's
/// mark is left.
void checkStandardOutput() {
  if (std::fflush(stdout) != 0)
    throw limn::Error(std::string("standard output cannot be written: ") + std::strerror(errno));
  if (std::ferror(stdout) != 0) throw limn::Error("standard output cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  limn::leaveWordsAtCrash("limn");
  CLI::App limn("limn: real-time shadows and global illumination, with their error and their cost", "limn");
  limn.set_version_flag("--version", limn::version());
  limn.require_subcommand(1);
  limn.failure_message([](const CLI::App* program, const CLI::Error& error) {
    return std::string("limn: ") + error.what() + "; see " + chosenCommand(*program) + " --help\n";
  });

  using namespace limn::app;
  const LastWords words("interrupted; what it was to write is whole or not there");
  Action action;
  bool quiet = false;
  const auto add = [&](const char* name, const char* description, Action (*build)(CLI::App&)) {
    CLI::App* command = limn.add_subcommand(name, description);
    command->callback([&action, run = build(*command)] { action = run; });
    if (command->get_prefix_command()) return;  // what follows is another program's
    command->add_flag("-q,--quiet", quiet, "Print only results and errors: no progress, notes or warnings");
  };
  add("list", "List the techniques and their parameters, or scenes, environments, suites", addListCommand);
  add("info",
      "Show the OpenGL back ends, devices and limits of this machine and the technique modules, or what a "
      "scene holds",
      addInfoCommand);
  add("import", "Convert a model of another format to a scene, by assimp", addImportCommand);
  add("render", "Render a scene with techniques to a file", addRenderCommand);
  add("reference", "Compute the ground truth of a term on the CPU", addReferenceCommand);
  add("compare", "Measure how far an image is from its reference", addCompareCommand);
  add("environment", "List and show the area lights that stand for an environment", addEnvironmentCommand);
  add("brdf", "Show, simulate and factorise BRDFs: measured data, models, materials of scenes",
      addBrdfCommand);
  add("bench", "Measure error and time of every case of a suite; write tables and a report", addBenchCommand);
  add("tune", "Search techniques and their parameters: the least error in a given time, or the least time",
      addTuneCommand);
  add("stress", "Test the stability of every technique on extreme cases: pass, degraded or refused",
      addStressCommand);
  add("flicker", "Measure how much more a technique changes from frame to frame than the reference does",
      addFlickerCommand);
  add("explain-cost",
      "Measure what it saves to leave out work that a scene does not need: force each kind in; compare frame "
      "times (ms), memory (MiB) and pictures",
      addExplainCostCommand);
  add("passes",
      "Write the programs of a frame's passes, with what each binds, sets and dispatches, for another engine",
      addPassesCommand);
  add("report", "Write the tables and the report of finished benches again", addReportCommand);
  add("merge", "Put the rows of several benches into one folder; write its tables and its report",
      addMergeCommand);
  add("reproduction", "Compare the thesis's ratios with those of bench results; write a Markdown page",
      addReproductionCommand);
  add("schema", "Print the JSON Schema of rows of results or of frame statistics", addSchemaCommand);
  add("view", "Open a window on a scene; accepts the options of limn-view", addViewCommand);
  limn.add_subcommand("completion",
                      "Print a script that completes this command line in bash: source <(limn completion)")
      ->callback([&] {
        action = [&limn] {
          std::fputs(bashCompletion(limn).c_str(), stdout);
          return 0;
        };
      });

  return guarded([&] {
    if (argc > 1 && argv[1][0] != '-') checkCommand(limn, argv[1]);
    try {
      limn.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      const int status = limn.exit(error) == 0 ? 0 : 2;
      checkStandardOutput();
      return status;
    }
    std::optional<SilentStderr> silence;
    if (quiet) silence.emplace();
    const int status = action();
    checkStandardOutput();
    return status;
  });
}
