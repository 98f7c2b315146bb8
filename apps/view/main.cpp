// limn-view: the window as a program.
#include <CLI/CLI.hpp>

#include "apps/view/viewer.h"
#include "core/base/whereabouts.h"

int main(int argc, char** argv) {
  using namespace limn::app;
  limn::leaveWordsAtCrash("limn-view");
  return guarded([&] {
    CLI::App program("A window on a scene: techniques, parameters, cost and error while one looks",
                     "limn-view");
    program.set_version_flag("--version", LIMN_VERSION);
    program.failure_message([](const CLI::App*, const CLI::Error& error) {
      return std::string("limn-view: ") + error.what() + "; see limn-view --help\n";
    });
    ViewerOptions options;
    options.title = "limn";
    options.scene.addTo(program);
    options.techniques.addTo(program);
    program
        .add_option("--output-term", options.outputTerm,
                    "final, visibility, direct, indirect, caustic, media or specular")
        ->capture_default_str();
    program.add_option("--exposure", options.exposure, "EV")->check(CLI::Range(-60.0, 60.0));
    program.add_option(
        "--shaders", options.shaders,
        "Folder with glsl/ and techniques/ that overrides the embedded shaders, reloaded when they change");
    program.add_flag("--debug", options.debug, "OpenGL errors end the program");
    program.add_option("--save", options.save, "Where F5 saves the picture (.exr, .png)")
        ->capture_default_str();
    program
        .add_option("--cache", options.cache,
                    "Folder of the truth's pictures, as limn reference --cache keeps them; empty: none")
        ->capture_default_str();
    program
        .add_option("--open", options.panels,
                    "Panels open at first, comma-separated: scene, techniques, lights, environment, compare, "
                    "frame, save, keys")
        ->delimiter(',')
        ->check(CLI::IsMember(
            {"scene", "techniques", "lights", "environment", "compare", "frame", "save", "keys"}))
        ->capture_default_str();
    program
        .add_option("--compare", options.compareWith, "Show beside the picture at first: techniques or truth")
        ->check(CLI::IsMember({"techniques", "truth"}));
    program
        .add_option("--frames", options.frames,
                    "Close the window after so many frames with the whole picture; 0: stay")
        ->check(CLI::NonNegativeNumber);
    program.add_option("--screenshot", options.screenshot, "Write the window to this .png when it closes");
    program.add_option("--stats", options.stats,
                       "Write to this .json how long the window's frames took, when it closes");
    try {
      program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return program.exit(error) == 0 ? 0 : 2;
    }
    runViewer(options);
    return 0;
  });
}
