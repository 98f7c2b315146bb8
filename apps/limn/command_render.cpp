// limn render: a picture, or a sequence, and what it cost.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/limn/commands.h"
#include "apps/limn/interruption.h"
#include "apps/limn/movie.h"
#include "apps/limn/options.h"
#include "apps/limn/provenance.h"
#include "apps/limn/tone_flags.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/text.h"
#include "core/gpu/device.h"
#include "core/render/renderer.h"
#include "core/render/supersample.h"
#include "core/session/view.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

struct RenderArguments {
  SceneQuestion scene;
  session::TechniqueChoice technique;
  BackendOptions backend;
  std::string frames;
  double fps = 30;
  ToneFlags tone;
  int repeat = 0;
  bool dynamicFrames = false, staticFrames = false, explain = false;
  fs::path out, stats, graph, shaders;
};

void checkOutputName(const RenderArguments& options) {
  const fs::path& out = options.out;
  if (isMovie(out)) {
    if (options.frames.empty())
      throw UsageError(fmt::format("--out '{}' is a movie and needs --frames", out.string()));
    return checkMovieProgram();
  }
  if (out.extension() != ".png" && out.extension() != ".exr")
    throw UsageError(fmt::format(
        "--out '{}' is not accepted; expected a name ending in .exr or .png, or in .mp4, .webm or .gif with "
        "--frames",
        out.string()));
}

void printExplanation(const std::vector<frame::PassReport>& passes, const render::FrameStats* stats) {
  fmt::print("{:<9} {:<24} {:<34} {:>10} {:>9}  {}\n", "state", "technique", "pass", "KiB", "ms", "why");
  for (size_t i = 0; i < passes.size(); ++i) {
    const auto& pass = passes[i];
    const bool timed = stats && stats->passes[i].ms.n > 0;
    fmt::print("{:<9} {:<24} {:<34} {:>10.1f} {:>9}  {}\n", frame::name(pass.state), pass.technique,
               pass.name, static_cast<double>(pass.bytes) / 1024,
               timed ? fmt::format("{:.3f}", stats->passes[i].ms.median) : "", pass.reason);
  }
}

void printStats(const render::FrameStats& stats) {
  fmt::print(
      "{}: {:.3f} ms a frame (quartiles {:.3f} to {:.3f}, {} frames, {}), passes {:.3f} ms, {:.1f} MiB\n",
      stats.renderer, stats.frameMs.median, stats.frameMs.q1, stats.frameMs.q3, stats.frameMs.n,
      stats.dynamic ? "dynamic" : "static", stats.passSumMs,
      static_cast<double>(stats.memoryBytes) / (1 << 20));
  if (stats.framesPerPicture > 1)
    fmt::print("a picture takes {} frames: {:.3f} ms\n", stats.framesPerPicture,
               stats.framesPerPicture * stats.frameMs.median);
  constexpr double allowed = 0.15;  // else the passes' times do not explain the frame's
  if (std::abs(stats.passSumMs - stats.frameMs.median) > allowed * stats.frameMs.median)
    fmt::print(stderr,
               "limn: warning: the passes sum to {:.3f} ms, the frame takes {:.3f} ms: the machine was busy, "
               "or work "
               "happens outside the passes\n",
               stats.passSumMs, stats.frameMs.median);
}

/// Writes pictures whose values are finite; all with the exposure of the first.
class Writer {
 public:
  explicit Writer(const RenderArguments& options) : options_(options) {}

  void add(Movie& movie, const Image& picture) {
    check(picture, options_.out);
    // The exposure of what a display shows, as of a .png.
    if (!tone_) tone_ = options_.tone.toneMapping(fs::path(options_.out).replace_extension(".png"), picture);
    movie.add(toneMapped(picture, *tone_));
  }

  void write(const fs::path& file, Image picture) {
    check(picture, file);
    if (!tone_) tone_ = options_.tone.toneMapping(file, picture);
    sign(picture);
    writePicture(file, picture, *tone_);
  }

  /// Returns the option by which a command that goes on has the exposure that was found here, in place of
  /// that of its own first picture; empty where no exposure was to be found.
  std::string exposureFound() const {
    const bool found = tone_ && options_.tone.automatic() && options_.out.extension() == ".png";
    return found ? fmt::format("--exposure {} ", tone_->exposureEv) : std::string();
  }

 private:
  void check(const Image& picture, const fs::path& file) const {
    checkFinite(picture, file, options_.scene.term, options_.technique.techniques);
  }

  const RenderArguments& options_;
  std::optional<ToneMapping> tone_;
};

void writeText(const fs::path& file, const std::string& text) {
  writeTextFile(file, text);
  sayWritten(file);
}

/// One frame of `frames` that says which program it compiles and which pass it is in. What was asked for is
/// waited for before each pass, so that the bar tells where the time goes.
void renderWithProgress(render::Renderer& renderer, Progress& progress, int frame, int frames) {
  const double compiling = frame == 0 ? 0.5 : 0;  // share of the frame's part of the bar
  const auto update = [&](double fraction, const std::string& note) {
    progress.update((frame + fraction) / frames, note);
  };
  renderer.setCompileProgress([&](int compiled, int wanted) {
    update(compiling * compiled / std::max(1, wanted), fmt::format("program {} of {}", compiled + 1, wanted));
  });
  std::vector<frame::PassReport> passes;
  std::size_t next = 0;
  renderer.render(frame::Timing::off, [&] {
    if (passes.empty()) {
      passes = renderer.explain();
      std::erase_if(passes, [](const auto& pass) { return pass.state == frame::PassState::leftOut; });
    }
    renderer.finish();
    if (next < passes.size())
      update(compiling + (1 - compiling) * double(next) / double(passes.size()), passes[next].name);
    ++next;
    return false;
  });
  renderer.setCompileProgress({});
  renderer.finish();
}

/// Times `frames` frames, which are said one by one outside of their times.
render::FrameStats measureWithProgress(render::Renderer& renderer, int frames) {
  constexpr int warmUp = 3;
  const int all = warmUp + 2 * frames;  // as a whole, then pass by pass
  Progress progress("timing", kProgressPatience);
  int shown = 0;
  render::Playback playback;
  playback.beforeFrame = [&] {
    progress.update(double(shown) / all, fmt::format("frame {} of {}", shown + 1, all));
    ++shown;
  };
  return render::measure(renderer, frames, warmUp, playback);
}

template <class FrameAt>
void writeFrames(const RenderArguments& options, const FrameRange& frames, Writer& writer, FrameAt frameAt) {
  LastWords words("interrupted; no frame was written");
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    if (frame > frames.first)
      words.say(fmt::format("interrupted; the frames {}:{} are written, {}--frames {}:{} goes on",
                            frames.first, frame - 1, writer.exposureFound(), frame, frames.last));
    writer.write(numbered(options.out, frame), frameAt(frame));
  }
  sayWritten(fmt::format("{} to {}", numbered(options.out, frames.first).string(),
                         numbered(options.out, frames.last).string()));
}

template <class FrameAt>
void writeMovie(const RenderArguments& options, const FrameRange& frames, Writer& writer, FrameAt frameAt) {
  const std::string words = "interrupted; no movie was written";
  const LastWords lastWords(words);
  const Interruption interruption;  // what is half-written goes before the program
  Movie movie(options.out, options.fps, commandLine());
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    writer.add(movie, frameAt(frame));
    if (interruption.asked()) throw Interrupted{interruption.signal(), words};
  }
  movie.finish();
  sayWritten(options.out);
}

int runRender(const RenderArguments& options) {
  checkOutputName(options);
  checkShaderFolder(options.shaders);
  for (const fs::path& file : {options.out, options.stats, options.graph})
    if (!file.empty()) checkWritable(file);
  const auto frames = parseFrames(options.frames);
  std::vector<fs::path> others = filesRead(options.scene);
  checkApart({options.out, options.stats, options.graph}, others);
  if (frames && !isMovie(options.out)) {
    others.insert(others.end(), {options.stats, options.graph});
    checkFramesApart(options.out, *frames, others);
  }
  const TechniqueRegistry registry(TechniqueRegistry::defaultFolders(), warn);
  render::Settings settings;
  settings.techniques = options.technique.resolve(registry);
  settings.term = parseTerm(options.scene.term);
  settings.channels = options.out.extension() == ".exr";
  render::checkTechniques(settings.techniques, settings.term);

  session::View view = session::open(options.scene, warn);
  settings.size = view.size;
  settings.light = view.light;
  // The frames of an anti-aliased picture differ in the camera alone; what does not depend on it is found
  // once.
  const bool timed = options.repeat > 0 || !options.stats.empty();
  settings.dynamic = !options.staticFrames && (timed || view.aa == 1);
  if (!isMovie(options.out)) loadPictureLibrary();
  const auto context = Context::create(options.backend.contextOptions());
  gpu::Device device(*context);
  render::Renderer renderer(device, view.scene, options.shaders);
  renderer.configure(settings);
  renderer.setTime(view.time, view.animation);

  const int framesPerPicture = view.aa * view.aa + render::historyOf(settings.term, settings.techniques) - 1;
  Writer writer(options);
  if (frames) {
    Progress progress("rendering");
    const auto frameAt = [&](int frame) {
      session::moveTo(view, options.scene, frame / options.fps);
      session::chooseLight(view, options.scene);
      if (settings.light != view.light) {
        settings.light = view.light;
        renderer.configure(settings);
      }
      renderer.setTime(view.time, view.animation);
      Image picture = render::supersample(renderer, view.camera, view.size, view.aa);
      progress.update(double(frame - frames->first + 1) / (frames->last - frames->first + 1));
      return picture;
    };
    if (isMovie(options.out))
      writeMovie(options, *frames, writer, frameAt);
    else
      writeFrames(options, *frames, writer, frameAt);
  } else {
    Image picture;
    {
      const LastWords words("interrupted; no picture was written");
      Progress progress("rendering", kProgressPatience);
      int rendered = 0;
      picture = render::supersample(renderer, view.camera, view.size, view.aa, [&] {
        renderWithProgress(renderer, progress, rendered++, framesPerPicture);
      });
    }
    writer.write(options.out, std::move(picture));
    sayWritten(options.out);
  }

  std::optional<render::FrameStats> stats;
  const int repeat = options.repeat > 0 ? options.repeat : (options.stats.empty() ? 0 : 10);
  if (repeat > 0) {
    stats = measureWithProgress(renderer, repeat);
    stats->scene = options.scene.scene;
    stats->framesPerPicture = framesPerPicture;
    printStats(*stats);
  }
  if (options.explain) printExplanation(renderer.explain(), stats ? &*stats : nullptr);
  if (!options.stats.empty()) writeText(options.stats, render::toJson(*stats) + "\n");
  if (!options.graph.empty()) writeText(options.graph, renderer.graph().graphviz());
  context->throwErrors();
  return 0;
}

}  // namespace

Action addRenderCommand(CLI::App& command) {
  auto options = std::make_shared<RenderArguments>();
  addSceneFlags(command, options->scene);
  addSceneFlag(command, options->scene, "term");
  addTechniqueFlags(command, options->technique);
  options->backend.addTo(command);
  CLI::Option* frames =
      command
          .add_option(
              "--frames", options->frames,
              "Render frames a:b of the animation, both included, or the first N, to NAME.0000.png and "
              "so on, or to a movie; their times take the place of --time")
          ->excludes(command.get_option("--time"));
  command.add_option("--fps", options->fps, "With --frames: frames per second of the animation")
      ->needs(frames)
      ->capture_default_str()
      ->check(realRange(0.001, 1e5));
  options->tone.addTo(command);
  command
      .add_option("--repeat", options->repeat,
                  "After the picture, time this many frames (with --stats 10 by default)")
      ->transform(wholeRange(1, 100000));
  auto* dynamicFlag = command.add_flag("--dynamic", options->dynamicFrames,
                                       "Compute everything again in each timed frame (default)");
  command.add_flag("--static", options->staticFrames, "Reuse unchanged results in timed frames")
      ->excludes(dynamicFlag);
  command
      .add_option("-o,--out", options->out,
                  "Picture: .exr (linear, with depth, id, albedo, normal) or .png; with --frames also a "
                  "movie: .mp4, .webm or .gif, which needs the program ffmpeg")
      ->required();
  command.add_flag("--explain", options->explain,
                   "Print for every pass whether it was run, cached or left out and why, with its memory, "
                   "and with its time where frames are timed (--repeat)");
  command.add_option("--stats", options->stats, "Write times and memory to this JSON file");
  command.add_option("--graph", options->graph, "Write the frame graph to this Graphviz file");
  command.add_option("--shaders", options->shaders,
                     "Folder with glsl/ and techniques/ whose shaders replace the embedded ones");
  return [options] { return runRender(*options); };
}

}  // namespace limn::app
