// Computes the ground truth on the CPU: Embree for ray queries, the GPU's own definitions (glsl/*.glsl) for
// everything that both renderers must agree on. The result is deterministic: a request gives the same bits
// with any number of threads, and whether or not it was interrupted and resumed.
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
#include "core/question/relief_paths.h"
#include "core/question/subsurface_model.h"
#include "core/question/term.h"
#include "core/scene/scene.h"

namespace limn::reference {

/// Returns whether Request::bounces counts.
LIMN_API bool hasBounces(Term term);
/// Returns whether a request may ask for `interfaces`; TermInterfaces says which of them a term takes.
LIMN_API bool acceptsInterfaces(Term term, int interfaces);
/// Returns the bounces of a request that does not name any.
LIMN_API int defaultBounces(Term term);
LIMN_API int defaultInterfaces(Term term);
/// Limits the smooth interfaces that can be asked for, besides all.
constexpr int kMaxInterfaces = 64;
constexpr int kAllInterfaces = -1;
/// Counts the interfaces that image-space refraction follows: into an object and out of it.
constexpr int kImageSpaceInterfaces = 2;
/// Limits the bounces that can be asked for.
constexpr int kMaxBounces = 1024;

/// Holds the terms in which light below surfaces counts.
constexpr TermSet kSubsurfaceTerms = Term::final | Term::subsurface | Term::specular;

/// Selects all lights of the scene and the environment's map, but not the lights that stand for it.
constexpr int kAllLights = -1;

/// Returns how many lights of the pose are the scene's own: those that stand for parts of the environment
/// follow them.
LIMN_API int ownLights(const scene::Pose& pose);

struct Progress {
  double fraction = 0;     ///< of the work, in [0, 1]; with a noise target an estimate
  double noise = 0;        ///< RMS relative to the mean, so far; 0 until it is known
  double secondsLeft = 0;  ///< estimate
  int spp = 0;             ///< samples per pixel done
};

/// Reports progress, called from the calling thread after each pass over the image. The value false stops the
/// work: render() then writes the checkpoint, if there is one, and throws Error.
using ProgressCallback = std::function<bool(const Progress&)>;

struct Request {
  const scene::Scene& scene;
  const scene::Pose& pose;
  scene::CameraPose camera;
  int width = 0, height = 0;
  /// The term that is asked of every pixel. With a medium, light is attenuated on its way to a surface and
  /// from there to the camera; indirect light is not attenuated on its way between surfaces.
  /// - visibility: V of one light, the mean over samples of its area (of its cone) above the geometric
  ///   tangent plane; 1 where nothing is seen and where no part of the light lies above that plane.
  /// - relief: W of one light, a mean over the same samples: which of them a ray sees that starts on the
  ///   height map's surface above the place. V is left out of it, as it is left out of V; 0 for samples below
  ///   the plane of the interpolated normal; 1 where V's picture is 1 for want of anything to see, on
  ///   surfaces without a height map, and on backs. Heights are those of the full-size map.
  /// - direct: light of all lights and the environment, or of one of them, V and W included; no technique
  ///   stands for either. Of translucent surfaces it is what their boundary reflects.
  /// - final: direct, indirect and subsurface of up to `bounces`, caustic, media, specular or, without
  /// `interfaces`, only
  ///   the environment in specular surfaces, emission that the camera sees, the environment as background.
  /// - indirect: light over 1 to `bounces` other surfaces, other bumps of the seen one among them; of
  ///   translucent surfaces what their boundary reflects. Light comes from other translucent surfaces by the
  ///   local limit, whatever `subsurface` says.
  /// - subsurface: what leaves translucent surfaces of the light that entered them, direct or over up to
  ///   `bounces` others.
  /// - caustic: light off a specular object, or through one (LS DE, LSS DE), or with kAllInterfaces over any
  ///   number of interfaces. Translucent surfaces show it by the local limit.
  /// - media: light as direct and as caustic have it; caustic has none of the environment's.
  /// - specular: emission, direct light, indirect and subsurface of up to `bounces`, and the environment.
  Term term = Term::direct;
  /// Index into Pose::lights, or lights.size() for the environment; kAllLights for all (not with visibility
  /// and relief, which take one light of Pose::lights).
  int light = kAllLights;
  /// Surfaces that reflect light before the surface that the camera sees: indirect takes paths of 1 to this
  /// many (at least 1), final adds them to direct light; 0 with the other terms. The pictures of N and of N -
  /// 1 bounces with the same samples and seed differ by exactly what the Nth bounce adds.
  int bounces = 0;
  /// With specular and final: the most smooth interfaces between the camera and what it sees in the surfaces
  /// of one object, as image space has them (SpecularPaths::imageSpace), or kAllInterfaces: the ground truth.
  /// 0, with final alone: the environment as specular_view.glsl has it. With kAllInterfaces light also
  /// reaches surfaces and the medium over any number of interfaces, in final, caustic and media; otherwise it
  /// comes off one interface or into an object and out of it, as techniques have it.
  int interfaces = 0;
  /// Says that nothing keeps light of the lights and of the environment from arriving: V = 1, up to the
  /// horizons of the surface that receives it, those of its height map's bumps included (W). Light that comes
  /// off specular objects keeps its shadows.
  bool unshadowed = false;
  /// Says which paths of 1 to `bounces` other surfaces count, in terms that have bounces. With the same
  /// samples and seed the light of both is the sum of that of relief and of others, up to rounding. A segment
  /// from bump to bump of a height map is a bounce as any other.
  ReliefPaths reliefPaths = ReliefPaths::both;
  /// Says how light below translucent surfaces is followed, in the terms that hold it: subsurface, final and
  /// specular. Where the mean free path is too short for single precision, all three have light leave where
  /// it enters.
  /// - bssrdf: the dipole's profile (glsl/diffusion/dipole.glsl) over the straight distance to every place of
  ///   the same draw's fronts. Where materials vary, the root of the product of both places' profiles.
  /// - walk: isotropic scattering with the reduced coefficients of the seen place, under the smooth boundary
  ///   of a closed body of one draw. Light enters as diffuse light does; it leaves towards the camera
  ///   exactly.
  /// - local: the share that a half space reflects, of what enters at the seen place.
  SubsurfaceModel subsurface = SubsurfaceModel::bssrdf;
  int spp = 64;  ///< samples per pixel and light, rounded up to an even number; the maximum if noise is given
  /// Target noise, RMS relative to the mean, 0 to 1; 0: take spp samples. The noise is tested after 16, 32,
  /// 64, ... samples. Nothing is known of it while the picture is black, since light may not have been found
  /// yet: a black picture is finished after 4096 samples, or at once where nothing is traced.
  double noise = 0;
  uint64_t seed = 0;
  /// Takes aa x aa samples per pixel, on a regular grid and equally weighted, as A; other channels are the
  /// centre's. Textures are at the level that the pixel asks for, as in the frames that pictures average.
  int aa = 1;
  int threads = 0;  ///< 0: all cores
  ProgressCallback progress{};
  /// File with the state of unfinished work, resumed if it fits the request; empty: none.
  std::filesystem::path checkpoint{};
  double checkpointSeconds = 30;  ///< between two writes of it
  /// When asked to stop, render() throws Error within a few blocks of pixels; the current pass is lost, and a
  /// checkpoint is as old as its last write.
  std::stop_token stop{};
};

/// Holds the result of a request. Channels: R, G, B (radiance in W/(sr m^2); V or W three times for these),
/// variance (of the mean, estimated, averaged over R, G and B), Z, coverage, id (-1: nothing seen),
/// albedo.R/G/B, N.X/Y/Z; for visibility also V, Vw (V weighted by irradiance) and masked (1 where no part of
/// the light lies above the geometric tangent plane: V = 1); for relief W, Ww and masked; and A (1 where a
/// surface or a background is seen). Metadata: noise_rms, spp, seed, term, light, bounces, interfaces.
struct Result {
  Image image;
  double noiseRms =
      0;  ///< RMS over pixels of the standard deviation of the mean, relative to the mean; Monte Carlo only
  int spp = 0;
  /// Holds what all samples took on all cores; not known with Request::threads, nor where a checkpoint held
  /// them all. Files of a cache do not say where they are older, or another machine's.
  std::optional<double> seconds{};
};

/// Renders the request. Throws UsageError for an invalid request (the message names the member and what is
/// accepted), Error if the work failed or was stopped.
LIMN_API Result render(const Request& request);

/// Returns a hash (32 hexadecimal digits) of everything that determines the result: scene content with
/// textures, pose, camera, size, term, light, bounces, paths, models, samples or noise, seed, version of this
/// code.
LIMN_API std::string contentHash(const Request& request);

/// Keeps finished references on disk: one EXR per content hash. Their metadata has content_hash, seconds and,
/// where it is known, machine besides that of render(). Threads must not share an object.
class LIMN_API Cache {
 public:
  /// Takes the folder, which is created when the first picture is put into it. `warn` is called once, with
  /// one line, when pictures cannot be kept there; it may be empty. `machine` names the one that renders: of
  /// a picture that says another one, Result::seconds is not known. It may be empty: not compared.
  explicit Cache(std::filesystem::path folder, std::function<void(const std::string&)> warn = {},
                 std::string machine = {})
      : folder_(std::move(folder)), warn_(std::move(warn)), machine_(std::move(machine)) {}
  std::filesystem::path pathOf(const std::string& contentHash) const;
  /// Returns the picture of that hash as render() does, without seconds and machine in its metadata; nullopt
  /// if there is none, or if the file is broken or belongs to another hash.
  std::optional<Result> get(const std::string& contentHash) const;
  void put(const std::string& contentHash, const Result& result) const;
  /// Returns get(), or else calls render() and put(). Interrupted work is kept in the folder and resumed.
  /// Where put() fails the picture is kept in memory, with up to 1 GiB of pictures in all. Throws Error when
  /// another process renders the same picture into the folder.
  Result render(Request request);

 private:
  void keepInMemory(const std::string& contentHash, const Result& result);

  std::filesystem::path folder_;
  std::function<void(const std::string&)> warn_;
  std::string machine_;
  std::deque<std::pair<std::string, Result>> kept_;  ///< pictures not stored in the folder, oldest first
  bool warned_ = false;
};

}  // namespace limn::reference
