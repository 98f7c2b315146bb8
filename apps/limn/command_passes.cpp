// limn passes: the programs of a frame with what they bind, for another engine.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "apps/limn/pass_record.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/gpu/device.h"
#include "core/render/renderer.h"
#include "core/session/view.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

struct PassesArguments {
  SceneQuestion scene;
  session::TechniqueChoice technique;
  BackendOptions backend;
  std::string contents;
  fs::path out, shaders;
};

constexpr const char* kJsonName = "passes.json";

/// Throws Error unless the folder can be made, or written to where it exists.
void checkFolderWritable(const fs::path& folder) {
  std::error_code unknown;
  fs::path first = fs::absolute(folder, unknown) / kJsonName;  // what is made in a folder that exists
  const auto place = [&] { return first.parent_path(); };
  while (place().has_relative_path() && !fs::exists(place(), unknown)) first = place();
  if (!fs::is_directory(place(), unknown))
    throw Error(fmt::format("{}: cannot be written: {} is a file", folder.string(), place().string()));
  checkWritable(first);
}

/// The files that an earlier run wrote to the folder. Throws UsageError for a folder with anything else in
/// it.
std::vector<std::string> earlierFiles(const fs::path& folder) {
  if (!fs::exists(folder)) return {};
  if (!fs::is_directory(folder))
    throw UsageError(fmt::format("--out '{}' is a file; a folder is accepted", folder.string()));
  if (fs::is_empty(folder)) return {};
  std::optional<std::vector<std::string>> files;
  if (fs::is_regular_file(folder / kJsonName)) files = filesOf(readTextFile(folder / kJsonName));
  if (!files)
    throw UsageError(
        fmt::format("--out '{}' holds other files; accepted are a new or empty folder, or one with the {} of "
                    "an earlier run",
                    folder.string(), kJsonName));
  return *files;
}

void removeFiles(const fs::path& folder, const std::vector<std::string>& files) {
  for (const std::string& file : files)
    if (!fileInFolder(folder, file).empty()) fs::remove(folder / file);
  std::error_code error;  // folders that hold something else stay
  for (const char* name : {"contents/before", "contents/after", "contents", "shaders"})
    fs::remove(folder / name, error);
}

void writeFolder(const fs::path& folder, const FrameRecord& frame, const std::string& title) {
  std::vector<std::string> files{"README.md"};
  for (const auto& [name, text] : frame.shaders) files.push_back("shaders/" + name);
  for (const auto& [name, bytes] : frame.contents) files.push_back("contents/" + name);
  createFolder(folder);
  // What a run that is cut short leaves is known to the next.
  writeTextFile(folder / kJsonName, toJson(frame, files, false));
  for (const std::string& file : files) createFolder((folder / file).parent_path());
  for (const auto& [name, text] : frame.shaders) writeTextFile(folder / "shaders" / name, text);
  for (const auto& [name, bytes] : frame.contents) writeFile(folder / "contents" / name, bytes);
  writeTextFile(folder / "README.md", toMarkdown(frame, title));
  writeTextFile(folder / kJsonName, toJson(frame, files, true));
}

int runPasses(const PassesArguments& options) {
  checkShaderFolder(options.shaders);
  const TechniqueRegistry registry(TechniqueRegistry::defaultFolders(), warn);
  render::Settings settings;
  settings.techniques = options.technique.resolve(registry);
  settings.term = parseTerm(options.scene.term);
  render::checkTechniques(settings.techniques, settings.term);
  const session::View view = session::open(options.scene, warn);
  if (view.aa > 1)
    throw UsageError(fmt::format("--aa {}: passes describes a single frame; 1 is accepted", view.aa));
  settings.size = view.size;
  settings.light = view.light;
  const std::vector<std::string> earlier = earlierFiles(options.out);
  checkFolderWritable(options.out);

  const auto context = Context::create(options.backend.contextOptions());
  gpu::Device device(*context);
  render::Renderer renderer(device, view.scene, options.shaders);
  renderer.configure(settings);
  renderer.setCamera(view.camera);
  renderer.setTime(view.time, view.animation);
  FrameRecord frame;
  {
    Progress progress("passes");
    renderer.setCompileProgress([&](int compiled, int wanted) {
      progress.update(double(compiled) / std::max(1, wanted),
                      fmt::format("program {} of {}", compiled + 1, wanted));
    });
    frame = recordFrame(renderer, options.contents);
    renderer.setCompileProgress({});
  }
  context->throwErrors();

  removeFiles(options.out, earlier);
  writeFolder(
      options.out, frame,
      fmt::format("Passes of {}: {}, {} x {}, {}", fs::path(options.scene.scene).filename().string(),
                  options.technique.techniques.empty() ? "no technique" : options.technique.techniques,
                  view.size.x, view.size.y, options.scene.term));
  sayWritten(options.out / "README.md");
  return 0;
}

}  // namespace

Action addPassesCommand(CLI::App& command) {
  auto options = std::make_shared<PassesArguments>();
  addSceneFlags(command, options->scene);
  addSceneFlag(command, options->scene, "term");
  addTechniqueFlags(command, options->technique);
  options->backend.addTo(command);
  command
      .add_option("-o,--out", options->out,
                  "Folder for README.md, passes.json and shaders/: new, empty, or of an earlier run")
      ->required();
  command.add_option(
      "--contents", options->contents,
      "Also write what this pass reads and leaves, as TECHNIQUE/PASS, so that it can be run elsewhere");
  command.add_option("--shaders", options->shaders,
                     "Folder with glsl/ and techniques/ whose shaders replace the embedded ones");
  return [options] { return runPasses(*options); };
}

}  // namespace limn::app
