// limn passes: the programs of a frame with what they bind, for another engine.
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <type_traits>

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

/// Throws UsageError for a folder with anything in it but what an earlier run wrote.
void checkFolder(const fs::path& folder) {
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw UsageError(fmt::format("--out '{}' is a file; a folder is accepted", folder.string()));
  if (fs::exists(folder) && !fs::is_empty(folder) && !fs::exists(folder / kJsonName))
    throw UsageError(
        fmt::format("--out '{}' holds other files; accepted are a new or empty folder, or one with an "
                    "earlier {}",
                    folder.string(), kJsonName));
}

/// Writes the files, and removes what an earlier run left in the folder beside them.
template <class Content>
void writeFolder(const fs::path& folder, const std::map<std::string, Content>& files) {
  fs::remove_all(folder);
  for (const auto& [name, content] : files) {
    createFolder((folder / name).parent_path());
    if constexpr (std::is_same_v<Content, std::string>)
      writeTextFile(folder / name, content);
    else
      writeFile(folder / name, content);
  }
}

int runPasses(const PassesArguments& options) {
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
  checkFolder(options.out);

  const auto context = Context::create(options.backend.contextOptions());
  gpu::Device device(*context);
  render::Renderer renderer(device, view.scene, options.shaders);
  renderer.configure(settings);
  renderer.setCamera(view.camera);
  renderer.setTime(view.time, view.animation);
  const FrameRecord frame = recordFrame(renderer, options.contents);

  createFolder(options.out);
  writeTextFile(options.out / kJsonName,
                toJson(frame));  // first: it marks the folder as one that may be written to again
  writeFolder(options.out / "shaders", frame.shaders);
  writeFolder(options.out / "contents", frame.contents);
  const std::string title =
      fmt::format("Passes of {}: {}, {} x {}, {}", fs::path(options.scene.scene).filename().string(),
                  options.technique.techniques.empty() ? "no technique" : options.technique.techniques,
                  view.size.x, view.size.y, options.scene.term);
  writeTextFile(options.out / "README.md", toMarkdown(frame, title));
  sayWritten(options.out / "README.md");
  for (const std::string& error : context->takeErrors()) throw Error("OpenGL: " + error);
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
