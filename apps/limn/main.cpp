// limn: the command line.
#include <CLI/CLI.hpp>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"

int main(int argc, char** argv) {
  CLI::App limn("limn: real-time shadows and global illumination, with their error and their cost", "limn");
  limn.set_version_flag("--version", LIMN_VERSION);
  limn.require_subcommand(1);
  limn.failure_message(CLI::FailureMessage::simple);

  limn::app::Action action;
  const auto add = [&](const char* name, const char* description, limn::app::Action (*build)(CLI::App&)) {
    CLI::App* command = limn.add_subcommand(name, description);
    command->callback([&action, run = build(*command)] { action = run; });
  };
  using namespace limn::app;
  add("list", "Techniques, the terms they answer, their parameters", addListCommand);
  add("info", "OpenGL back ends, devices and limits of this machine", addInfoCommand);
  add("render", "Render a scene with techniques to a file", addRenderCommand);
  add("reference", "Compute the ground truth of a term on the CPU", addReferenceCommand);
  add("compare", "Measure how far an image is from its reference", addCompareCommand);
  add("bench", "Run a suite: error and time of many settings, as tables", addBenchCommand);

  try {
    limn.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return limn.exit(error) == 0 ? 0 : 2;
  }
  return guarded(action);
}
