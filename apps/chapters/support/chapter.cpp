#include "apps/chapters/support/chapter.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <sstream>

#include "apps/limn/completion.h"
#include "apps/limn/options.h"
#include "apps/limn/run_suite.h"
#include "apps/view/viewer.h"
#include "core/base/error.h"
#include "core/base/version.h"
#include "core/base/whereabouts.h"
#include "core/context/context.h"
#include "core/session/find.h"

namespace limn::app {
namespace {

namespace fs = std::filesystem;

/// A variable may name a display that is gone, so that only opening a window tells.
bool canOpenWindow() {
  const auto set = [](const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && *value != 0;
  };
  if (!set("DISPLAY") && !set("WAYLAND_DISPLAY")) return false;
  try {
    Context::create({.backend = Backend::glfw, .visible = false});
    return true;
  } catch (const Error& error) {
    fmt::print(stderr, "{}; writing pictures and tables as with --headless\n", error.what());
    return false;
  }
}

int writeFiles(const Chapter& chapter, const fs::path& out, const BackendOptions& backend,
               const std::vector<std::string>& filters) {
  bool complete = true, any = false;
  for (const char* suite : chapter.suites) {
    if (bench::selectCases(bench::readSuite(session::findSuite(suite)).cases, filters, {}).empty()) continue;
    any = true;
    const bench::Summary summary =
        runSuite(session::findSuite(suite), out / suite, backend, {.filters = filters});
    complete = complete && summary.complete();
    const bool pictures = fs::exists(out / suite / "pictures.md");
    fmt::print("{}: {}{}\n", suite, (out / suite / "tables.md").string(),
               pictures ? ", " + (out / suite / "pictures.md").string() : "");
  }
  if (!any) throw UsageError(fmt::format("{}: no case of its suites fits the filter", chapter.name));
  return complete ? 0 : 1;
}

std::vector<ViewerStep> stepsOf(const Chapter& chapter) {
  std::vector<ViewerStep> steps;
  for (const ChapterSetting& setting : chapter.settings) {
    ViewerStep step{.title = setting.title, .sentence = setting.sentence, .techniques = {}};
    step.techniques.techniques = setting.techniques;
    std::istringstream words(setting.parameters);
    for (std::string word; words >> word;) step.techniques.settings.push_back(word);
    steps.push_back(std::move(step));
  }
  return steps;
}

/// Throws UsageError if one of these options was given, of which the program makes no use as it runs now.
void refuseGiven(const CLI::App& program, std::initializer_list<const char*> options, const char* use) {
  for (const char* option : options)
    if (program.count(option) > 0) throw UsageError(fmt::format("{} is {}", option, use));
}

}  // namespace

int runChapter(const Chapter& chapter, int argc, char** argv) {
  leaveWordsAtCrash(chapter.name);
  return guarded([&] {
    CLI::App program(chapter.title, chapter.name);
    program.set_version_flag("--version", version());
    program.failure_message([&](const CLI::App*, const CLI::Error& error) {
      return fmt::format("{}: {}; see {} --help\n", chapter.name, error.what(), chapter.name);
    });
    addCompletionFlag(program);
    fs::path out = fs::path("out") / chapter.name;
    std::vector<std::string> filters;
    bool headless = false;
    int frames = 0;
    SceneQuestion scene;
    scene.scene = chapter.scene;
    BackendOptions backend;
    program.add_flag("--headless", headless,
                     "Write pictures and tables even if there is a display (the default without one)");
    program
        .add_option("-o,--out", out,
                    "Folder for the pictures and tables; a run that is in it already is resumed")
        ->capture_default_str();
    program.add_option("--filter", filters, "Only cases whose label contains this text; repeatable")
        ->take_all();
    program.add_option("--scene", scene.scene, "Scene in the window: a file, or the name of one of limn's")
        ->capture_default_str();
    addSceneFlag(program, scene, "size")->description("Size of the picture in the window, WIDTHxHEIGHT");
    program.add_option("--frames", frames, "Close the window after this many frames; 0: keep it open")
        ->transform(wholeRange(0, 1000000));
    backend.addTo(program);
    try {
      program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return program.exit(error) == 0 ? 0 : 2;
    }
    if (headless || !canOpenWindow()) {
      refuseGiven(program, {"--scene", "--size", "--frames"}, "for the window, which is not opened");
      return writeFiles(chapter, out, backend, filters);
    }
    refuseGiven(program, {"--filter", "--backend"}, "for pictures and tables, which --headless writes");
    ViewerOptions viewer;
    viewer.title = chapter.title;
    viewer.scene = scene;
    viewer.steps = stepsOf(chapter);
    viewer.device = backend.device;
    viewer.debug = backend.debug;
    viewer.save = out / "view.png";
    viewer.cache = out / "references";
    viewer.frames = frames;
    runViewer(viewer);
    return 0;
  });
}

}  // namespace limn::app
