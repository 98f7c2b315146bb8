// The CPU ground truth: Embree for ray queries, the GPU's own definitions (glsl/*.glsl) for everything that
// both renderers must agree on. Deterministic: a request gives the same bits with any number of threads, and
// whether or not it was interrupted and resumed.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "core/base/export.h"
#include "core/image/image.h"
#include "core/scene/scene.h"

namespace limn::reference {

/// What is asked of every pixel. With a medium, light is attenuated on its way to a surface and from there to
/// the camera; indirect light is not on the way between surfaces.
enum class Term {
  direct,  ///< reflected direct light of all lights and the environment, or of one of them; shadows included
  visibility,  ///< V of one light
  final,       ///< direct, indirect of up to Request::bounces, caustic, media, specular or, without
               ///< Request::interfaces, the environment alone in specular surfaces, emission the camera sees,
               ///< environment as background
  indirect,    ///< light that came to the seen surface over 1 to Request::bounces others (L D+ D E)
  caustic,  ///< light that came to the seen surface off a specular object, or through one (LS DE, LSS DE), or
            ///< with Request::interfaces over any number of interfaces (L S+ D E)
  media,    ///< light that the medium scattered once, directly or as that of caustic (L S* M E)
  specular,  ///< what the camera sees in specular surfaces: emission, direct light and indirect of up to
             ///< Request::bounces, and the environment (L D+ S+ E); neither caustics nor light in the medium
};
LIMN_API const char* name(Term term);
/// Throws UsageError naming the terms there are.
LIMN_API Term termFromName(const std::string& name);

/// Whether Request::bounces counts: with indirect, specular and final.
LIMN_API bool hasBounces(Term term);
/// Whether a request may ask for `interfaces`: 1 to maxInterfaces with specular and final, allInterfaces with
/// caustic and media, too, and 0 with all but specular.
LIMN_API bool acceptsInterfaces(Term term, int interfaces);
/// Most smooth interfaces that can be asked for, besides all.
constexpr int maxInterfaces = 64;
constexpr int allInterfaces = -1;
/// Those that image-space refraction follows: into an object and out of it.
constexpr int imageSpaceInterfaces = 2;
/// Most bounces that can be asked for.
constexpr int maxBounces = 1024;

/// All of the scene and the environment's map, not the lights that stand for it.
constexpr int allLights = -1;

/// How many lights of the pose are the scene's own: those that stand for parts of the environment come
/// behind.
LIMN_API int ownLights(const scene::Pose& pose);

struct Progress {
  double fraction = 0;     ///< of the work, in [0, 1]; with a noise target an estimate
  double noise = 0;        ///< RMS relative to the mean, so far; 0 until it is known
  double secondsLeft = 0;  ///< estimate
  int spp = 0;             ///< samples per pixel done
};

/// Called from the calling thread after each pass over the image. False stops the work: render() then writes
/// the checkpoint, if there is one, and throws Error.
using ProgressCallback = std::function<bool(const Progress&)>;

struct Request {
  const scene::Scene& scene;
  const scene::Pose& pose;
  scene::CameraPose camera;
  int width = 0, height = 0;
  Term term = Term::direct;
  /// Index into Pose::lights, or lights.size() for the environment; allLights for all (not with visibility,
  /// which takes one light of Pose::lights).
  int light = allLights;
  /// Surfaces that reflect light before the one that the camera sees does: indirect takes paths of 1 to this
  /// many (at least 1), final adds them to direct light; 0 with the other terms. The pictures of N and of N -
  /// 1 bounces with the same samples and seed differ by exactly what the Nth bounce brings.
  int bounces = 0;
  /// With specular and final: most smooth interfaces between the camera and what it sees in the surfaces of
  /// one object, as image space has them (SpecularPaths::imageSpace), or allInterfaces: the truth. 0, with
  /// final alone: the environment as specular_view.glsl has it. With allInterfaces light comes to surfaces
  /// and into the medium over any number of interfaces, too, in final, caustic and media; else off one
  /// interface or into an object and out of it, as techniques have it.
  int interfaces = 0;
  int spp = 64;  ///< samples per pixel and light, rounded up to an even number; the maximum if noise is given
  /// Target noise, RMS relative to the mean; 0: take spp samples. Tested after 16, 32, 64, ... samples.
  double noise = 0;
  uint64_t seed = 0;
  int aa =
      1;  ///< aa x aa samples per pixel, on a regular grid and equally weighted; other channels: the centre's
  int threads = 0;  ///< 0: all cores
  ProgressCallback progress{};
  /// State of unfinished work, resumed if it fits the request; empty: none.
  std::filesystem::path checkpoint{};
  double checkpointSeconds = 30;  ///< between two writes of it
  /// Asked to stop, render() throws Error within a few blocks of pixels; the pass it is in is lost, a
  /// checkpoint is as old as its last write.
  std::stop_token stop{};
};

/// Channels R, G, B (radiance in W/(sr m^2); V three times for visibility), variance (of the mean of R, G, B,
/// estimated), Z, coverage, id (-1: nothing seen), albedo.R/G/B, N.X/Y/Z; for visibility also V, Vw (V
/// weighted by irradiance) and masked (1 where no part of the light lies above the geometric tangent plane: V
/// = 1). Metadata: noise_rms, spp, seed, term, light,
/// bounces, interfaces.
struct Result {
  Image image;
  double noiseRms =
      0;  ///< RMS over pixels of the standard deviation of the mean, relative to the mean; Monte Carlo only
  int spp = 0;
  std::optional<double> seconds{};  ///< that all samples took; older files of a cache do not say
};

/// Throws UsageError for a request that makes no sense (names the member and what is accepted), Error if the
/// work failed or was stopped.
LIMN_API Result render(const Request& request);

/// Hash (32 hexadecimal digits) of everything that determines the result: scene content with textures, pose,
/// camera, size, term, light, bounces, samples or noise, seed, version of this code.
LIMN_API std::string contentHash(const Request& request);

/// Finished references on disk: one EXR per content hash. Their metadata has content_hash and seconds besides
/// that of render(). Not to be shared by threads.
class LIMN_API Cache {
 public:
  /// The folder is created when the first picture is put into it. `warn` is told once, in one line, when
  /// pictures cannot be kept there; may be empty.
  explicit Cache(std::filesystem::path folder, std::function<void(const std::string&)> warn = {})
      : folder_(std::move(folder)), warn_(std::move(warn)) {}
  std::filesystem::path pathOf(const std::string& contentHash) const;
  /// nullopt if there is none, or if the file is broken or not of that hash.
  std::optional<Result> get(const std::string& contentHash) const;
  void put(const std::string& contentHash, const Result& result) const;
  /// get(), else render() and put(). Interrupted work is kept in the folder and resumed. Where put() fails
  /// the picture is kept in memory, with those of up to 1 GiB in all. Throws Error when another process
  /// renders the same picture into the folder.
  Result render(Request request);

 private:
  void keepInMemory(const std::string& contentHash, const Result& result);

  std::filesystem::path folder_;
  std::function<void(const std::string&)> warn_;
  std::deque<std::pair<std::string, Result>> kept_;  ///< what the folder did not take, oldest first
  bool warned_ = false;
};

}  // namespace limn::reference
