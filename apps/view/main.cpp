// limn-view: the window as a program.
#include <CLI/CLI.hpp>

#include "apps/limn/completion.h"
#include "apps/limn/options.h"
#include "apps/view/viewer.h"
#include "core/base/version.h"
#include "core/base/whereabouts.h"
#include "core/image/image.h"

namespace limn::app {
namespace {

/// What could not be written when the window closes, or when F5 is pressed, is refused before it opens.
/// `saved`: --save was given. Its folder is made when it is needed.
void checkFiles(const ViewerOptions& options, bool saved) {
  checkExtension("--save", options.save, {".exr", ".png"});
  if (!options.screenshot.empty()) checkExtension("--screenshot", options.screenshot, {".png"});
  std::filesystem::path save = saved ? options.save : std::filesystem::path();
  std::vector<std::filesystem::path> read = filesRead(options.scene);
  read.emplace_back(options.scene.environment);  // also where the scene is chosen later
  checkApart({save, options.screenshot, options.stats}, read);
  std::error_code ignored;
  while (save.has_parent_path() && !std::filesystem::exists(save.parent_path(), ignored))
    save = save.parent_path();
  for (const std::filesystem::path& file : {save, options.screenshot, options.stats})
    if (!file.empty()) checkWritable(file);
  if (!options.screenshot.empty()) loadPictureLibrary();
}

}  // namespace
}  // namespace limn::app

int main(int argc, char** argv) {
  using namespace limn::app;
  limn::leaveWordsAtCrash("limn-view");
  return guarded([&] {
    CLI::App program("Interactive viewer of a scene: techniques, parameters, cost and error", "limn-view");
    program.set_version_flag("--version", limn::version());
    program.failure_message([](const CLI::App*, const CLI::Error& error) {
      return std::string("limn-view: ") + error.what() + "; see limn-view --help\n";
    });
    addCompletionFlag(program);
    ViewerOptions options;
    options.title = "limn";
    addSceneFlags(program, options.scene);
    program.get_option("scene")->required(false);  // it can be chosen in the window
    addSceneFlag(program, options.scene, "term");
    addTechniqueFlags(program, options.techniques);
    options.tone.addTo(program);
    program.add_option("--shaders", options.shaders,
                       "Folder with glsl/ and techniques/ whose shaders replace the embedded ones; reloaded "
                       "when a file changes");
    program
        .add_option("--scale", options.scale,
                    "Size of text and widgets; by default that of the monitor (1 at 96 dots per inch)")
        ->check(realRange(0.5, 8.0));
    addDeviceFlags(program, options.device, options.debug);
    program.add_flag("--debug", options.debug)->group("");  // the same, from before limn's name for it
    program.add_option("--save", options.save, "File to which F5 saves the picture (.exr or .png)")
        ->capture_default_str();
    program
        .add_option("--cache", options.cache,
                    "Folder of the truth's pictures, as limn reference --cache keeps them; empty: none")
        ->capture_default_str();
    program
        .add_option("--open", options.panels,
                    "Panels open at first, comma-separated: scene, techniques, lights, environment, compare, "
                    "budget, frame, save, keys")
        ->delimiter(',')
        ->check(CLI::IsMember(
            {"scene", "techniques", "lights", "environment", "compare", "budget", "frame", "save", "keys"}))
        ->capture_default_str();
    program
        .add_option("--compare", options.compareWith, "Show beside the picture at first: techniques or truth")
        ->check(CLI::IsMember({"techniques", "truth"}));
    program
        .add_option("--frames", options.frames,
                    "Close the window after this many frames that show the complete picture; 0: keep it open")
        ->transform(wholeRange(0, 1000000));
    program.add_option("--screenshot", options.screenshot,
                       "When the window closes, write its last content to this .png file");
    program.add_option("--stats", options.stats,
                       "When the window closes, write the times of its frames to this .json file");
    try {
      program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return program.exit(error) == 0 ? 0 : 2;
    }
    checkShaderFolder(options.shaders);
    checkFiles(options, program.count("--save") > 0);
    runViewer(options);
    return 0;
  });
}
