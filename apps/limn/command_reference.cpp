// limn reference: the ground truth of one term, on the CPU.
#include <fmt/format.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "apps/limn/commands.h"
#include "apps/limn/interruption.h"
#include "apps/limn/options.h"
#include "apps/limn/provenance.h"
#include "apps/limn/tone_flags.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/file_lock.h"
#include "core/base/text.h"
#include "core/bench/machine.h"
#include "core/reference/reference.h"
#include "core/reference/vertices.h"
#include "core/session/view.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

struct ReferenceArguments {
  SceneQuestion scene{.term = name(Term::direct)};
  std::optional<int> spp;
  int threads = 0;
  double noise = 0;
  ToneFlags tone;
  uint64_t seed = 0;
  std::optional<int> bounces;
  std::string interfaces;
  bool atVertices = false;
  double longestEdge = 0.05;
  fs::path out, cache;
};

/// CLI11 takes -1 for the largest number there is, and larger ones as well.
uint64_t parseSeed(const std::string& text) {
  const auto seed = parseWhole<uint64_t>(text);
  if (!seed)
    throw UsageError(fmt::format("--seed '{}' is not accepted; expected a whole number from 0 to {}", text,
                                 std::numeric_limits<uint64_t>::max()));
  return *seed;
}

/// "all", or a number.
int parseInterfaces(const std::string& text) {
  if (text == "all") return reference::kAllInterfaces;
  const auto value = parseWhole<int>(text);
  if (!value || *value < 0 || *value > reference::kMaxInterfaces)
    throw UsageError(fmt::format("--interfaces '{}' is not accepted; expected 0 to {}, or all", text,
                                 reference::kMaxInterfaces));
  return *value;
}

reference::Request makeRequest(const ReferenceArguments& options, const session::View& view) {
  reference::Request request =
      session::referenceRequest(view, view.pose, view.camera, parseTerm(options.scene.term));
  request.spp = options.spp.value_or(options.noise > 0 ? 1 << 20 : 256);
  request.noise = options.noise;
  request.bounces = options.bounces.value_or(request.bounces);
  if (!options.interfaces.empty()) request.interfaces = parseInterfaces(options.interfaces);
  request.seed = options.seed;
  request.threads = options.threads;
  return request;
}

/// Irradiance of vertices, as a list in the shape of a picture.
int runAtVertices(const ReferenceArguments& options, const session::View& view, reference::Request request) {
  if (options.out.extension() != ".exr")
    throw UsageError("--at-vertices writes a list; --out takes a name ending in .exr");
  const auto points = reference::vertexPoints(view.scene, view.pose, static_cast<float>(options.longestEdge));
  std::vector<glm::vec3> irradiance;
  {
    Progress progress("reference");
    request.progress = [&](const reference::Progress& state) {
      progress.update(state.fraction, fmt::format("{} spp, {:.0f} s left", state.spp, state.secondsLeft));
      return true;
    };
    irradiance = reference::irradianceAt(request, points, 1e-4f * view.pose.bounds.radius());
  }
  Image list = reference::vertexImage(points, irradiance, view.pose.origin);
  sign(list);
  writeImage(options.out, list, 0);
  fmt::print("{}: {} points, {} samples each\n", options.out.string(), points.size(), request.spp);
  return 0;
}

/// Renders it until it is done or an interruption asks for its end; the bar has gone then.
reference::Result renderReference(const ReferenceArguments& options, reference::Request request,
                                  const Interruption& interruption) {
  Progress progress("reference");
  request.progress = [&](const reference::Progress& state) {
    progress.update(state.fraction, fmt::format("{} spp, noise {:.4f}, {:.0f} s left", state.spp, state.noise,
                                                state.secondsLeft));
    return !interruption.asked();
  };
  try {
    if (!options.cache.empty()) {
      removeAbandonedFiles(options.cache);
      return reference::Cache(options.cache, warn, bench::machineName()).render(request);
    }
    const FileLock lock(beside(options.out, ".lock"), options.out.string());
    request.checkpoint = beside(options.out, ".checkpoint");
    return reference::render(request);
  } catch (const Error& stopped) {
    if (!interruption.asked()) throw;
    throw Interrupted{interruption.signal(), std::string(stopped.what()) + "; the same command goes on"};
  }
}

int runReference(const ReferenceArguments& options) {
  checkExtension("--out", options.out, {".exr", ".png"});
  checkWritable(options.out);
  checkApart({options.out}, filesRead(options.scene));
  const session::View view = session::open(options.scene, warn);
  reference::Request request = makeRequest(options, view);
  loadPictureLibrary();
  if (options.atVertices) return runAtVertices(options, view, request);
  const Interruption interruption;  // until the picture is written: all its samples are in it alone
  reference::Result result = renderReference(options, request, interruption);
  sign(result.image);
  writePicture(options.out, result.image, options.tone.toneMapping(options.out, result.image));
  fmt::print("{}: {} samples per pixel, noise {:.5f} of the mean\n", options.out.string(), result.spp,
             result.noiseRms);
  return 0;
}

}  // namespace

Action addReferenceCommand(CLI::App& command) {
  auto options = std::make_shared<ReferenceArguments>();
  addSceneFlags(command, options->scene);
  addSceneFlag(command, options->scene, "term", "--term");
  command
      .add_option("--spp", options->spp,
                  "Samples per pixel and light (default 256); with --noise the maximum (default 1048576)")
      ->transform(wholeRange(1, 1 << 24));
  command
      .add_option(
          "--bounces", options->bounces,
          "Most surfaces that reflect light before the one that is seen does: indirect is the light that\n"
          "came over 1 to N of them (default 1), final adds it to direct light (default 0: direct alone),\n"
          "specular sees as much of both")
      ->transform(wholeRange(0, reference::kMaxBounces));
  command.add_option(
      "--interfaces", options->interfaces,
      "Most smooth interfaces between the camera and what it sees in a specular object, as image space has\n"
      "them: specular 1 to 64 (default 2), final 0 to 64 (default 0: the environment alone); or all: the\n"
      "truth. all with caustic, media and final: light over any number of interfaces, too (default: off "
      "one,\n"
      "or into an object and out of it, as techniques have it)");
  command
      .add_option("--noise", options->noise,
                  "Stop when the noise (RMS relative to the mean) falls to this value")
      ->check(realRange(0.0, 1.0));
  CLI::Option* atVertices = command.add_flag(
      "--at-vertices", options->atVertices,
      "Irradiance at the vertices of the scene instead of a picture: rows of 1024 of them, with positions\n"
      "P and normals N, as implicit_visibility sees them; far from the origin P + P.rest is the position");
  command
      .add_option("--longest-edge", options->longestEdge,
                  "With --at-vertices: halve triangle edges longer than this, in scene radii")
      ->needs(atVertices)
      ->capture_default_str()
      ->check(realRange(0.005, 1e3));
  command
      .add_option_function<std::string>(
          "--seed", [options](const std::string& text) { options->seed = parseSeed(text); },
          "Seed of the random numbers")
      ->type_name("UINT");
  command.add_option("--threads", options->threads, "0: all cores")->transform(wholeRange(0, 1024));
  options->tone.addTo(command);
  command.add_option("--cache", options->cache,
                     "Folder in which finished references are kept, and reused for the same request");
  command
      .add_option("-o,--out", options->out,
                  "Picture (.exr with all channels, or .png); interrupted work is kept beside it")
      ->required();
  for (const char* ofPictures : {"--noise", "--size", "--aa", "--exposure", "--tonemap", "--cache"})
    atVertices->excludes(command.get_option(ofPictures));
  return [options] { return runReference(*options); };
}

}  // namespace limn::app
