#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/reference/private/airlight.h"
#include "core/reference/private/content_hash.h"
#include "core/reference/private/direct_light.h"
#include "core/reference/private/film.h"
#include "core/reference/private/light_tracer.h"
#include "core/reference/private/validate.h"
#include "core/reference/reference.h"
#include "core/scene/camera.h"
#include "core/scene/medium.h"

namespace limn::reference {
namespace {

constexpr TermSet kBouncingTerms =
    termsWhere([](const TermInfo& info) { return info.bounces != TermBounces::none; });

/// Samples per pixel after which a picture that is still black is taken for one without light.
constexpr uint32_t kFewestBlack = 4096;

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string acceptedInterfaces(Term term) {
  const auto seen = [](int least) {
    return fmt::format("accepted are {} to {} and {} (all)", least, kMaxInterfaces, kAllInterfaces);
  };
  switch (termInfo(term).interfaces) {
    case TermInterfaces::fromZero:
      return seen(0);
    case TermInterfaces::fromOne:
      return seen(1);
    case TermInterfaces::light:
      return fmt::format("accepted are 0 (off one, or in and out) and {} (all)", kAllInterfaces);
    case TermInterfaces::none:
      break;
  }
  constexpr TermSet others =
      termsWhere([](const TermInfo& info) { return info.interfaces != TermInterfaces::none; });
  return fmt::format("only {} have interfaces", joined(termNames(others)));
}

void checkBounces(const Request& r) {
  const int least = defaultBounces(r.term);
  if (r.bounces >= least && r.bounces <= (hasBounces(r.term) ? kMaxBounces : 0)) return;
  if (hasBounces(r.term))
    throw UsageError(fmt::format("reference: bounces {} is not in {} .. {} with the term {}", r.bounces,
                                 least, kMaxBounces, name(r.term)));
  throw UsageError(fmt::format("reference: bounces {} with the term {}; only {} have bounces", r.bounces,
                               name(r.term), joined(termNames(kBouncingTerms))));
}

void checkReliefPaths(const Request& r) {
  if (r.reliefPaths == ReliefPaths::both || hasBounces(r.term)) return;
  throw UsageError(fmt::format("reference: relief paths '{}' with the term {}; only {} have bounces",
                               name(r.reliefPaths), name(r.term), joined(termNames(kBouncingTerms))));
}

void checkSubsurface(const Request& r) {
  if (r.subsurface == SubsurfaceModel::bssrdf || contains(kSubsurfaceTerms, r.term)) return;
  throw UsageError(fmt::format("reference: subsurface '{}' with the term {}; only {} hold such light",
                               name(r.subsurface), name(r.term), joined(termNames(kSubsurfaceTerms))));
}

void validate(const Request& r) {
  if (r.aa < 1 || r.aa > 16) throw UsageError(fmt::format("reference: aa {} is not in 1 .. 16", r.aa));
  if (r.width < 1 || r.height < 1 || r.width > kMaxImageSide / r.aa || r.height > kMaxImageSide / r.aa)
    throw UsageError(fmt::format("reference: size {}x{} with aa {} is not in 1 .. {} per side", r.width,
                                 r.height, r.aa, kMaxImageSide));
  // Before rays are traced: all samples of the pixels lie side by side.
  const int64_t values =
      int64_t{r.width} * r.height * r.aa * r.aa * static_cast<int64_t>(channelNames(r.term).size());
  if (values > kMaxImageValues)
    throw UsageError(fmt::format("reference: size {}x{} with aa {} has {} values; at most {} are accepted",
                                 r.width, r.height, r.aa, values, kMaxImageValues));
  if (!(r.noise >= 0 && r.noise <= 1))
    throw UsageError(fmt::format("reference: noise {} is not in 0 .. 1 (0: take spp samples)", r.noise));
  if (!contains(kPicturedTerms, r.term))
    throw UsageError(fmt::format("reference: no picture shows the term {} alone", name(r.term)));
  checkLight(r);
}

std::unique_ptr<Integrator> makeIntegrator(const RayScene& rays, const Request& request) {
  return isLightFactor(request.term) ? makeLightFactorIntegrator(rays, request)
                                     : makePathIntegrator(rays, request);
}

/// One picture in the making.
class Work {
 public:
  explicit Work(const Request& request)
      : request_(request),
        rays_(request.scene, request.pose, request.unshadowed),
        view_{.rays = rays_,
              .near = request.camera.near,
              .width = request.width * request.aa,
              .height = request.height * request.aa,
              .aa = request.aa},
        integrator_(makeIntegrator(rays_, request)),
        needed_(static_cast<uint32_t>(request.spp + 1) / 2) {
    scene::setCamera(view_.frame, request.camera, request.pose.bounds, view_.width, view_.height);
    scene::setMedium(view_.frame, request.scene.medium, request.pose.bounds);
    const bool background = showsBackground(request.term, static_cast<bool>(request.scene.environment),
                                            request.scene.medium.present());
    view_.findHits(request.stop);
    image_ = renderFeatures(view_, request.term, background, request.stop);
    checkStop();
    state_.sums.resize(2 * view_.pixelCount());
    prepareMedia();
    if (!request.checkpoint.empty()) resume();
  }

  Result run() {
    const Clock::time_point start = Clock::now();
    const uint32_t before = state_.samples;
    const auto perSample = [&] { return secondsSince(start) / std::max(1u, state_.samples - before); };
    Clock::time_point saved = start;
    while (!finished()) {
      pass(std::min(passSize(), needed_ - state_.samples));
      const bool last = finished();
      const bool goOn = last || !request_.progress || request_.progress(progress(perSample()));
      if (!last && !request_.checkpoint.empty() &&
          (!goOn || secondsSince(saved) >= request_.checkpointSeconds)) {
        save(!goOn);
        saved = Clock::now();
      }
      if (!goOn)
        throw Error(fmt::format(
            "reference: stopped after {} of {} samples per pixel{}", 2 * state_.samples, 2 * needed_,
            request_.checkpoint.empty() ? "" : "; kept in " + request_.checkpoint.string()));
    }
    const double seconds = perSample() * state_.samples;
    const bool known = request_.threads <= 0 && state_.samples > before;
    Result result = finish();
    if (known) result.seconds = seconds;
    return result;
  }

 private:
  void prepareMedia() {
    const Term term = request_.term;
    if (term == Term::media || term == Term::final) airlight_.emplace(rays_, request_);
    if (airlight_ && !airlight_->present()) airlight_.reset();
    counts_.resize(view_.pixelCount());
    for (size_t i = 0; i < counts_.size(); ++i) counts_[i] = airlight_ || view_.shows(i);
    if (term != Term::media && term != Term::caustic && term != Term::final) return;
    tracer_.emplace(view_, request_);
    if (!tracer_->present()) tracer_.reset();
  }

  void resume() {
    hash_ = workHash(request_);
    Accumulators found;
    found.sums.resize(state_.sums.size());
    if (!loadCheckpoint(request_.checkpoint, hash_, found) || found.samples > needed_) return;
    state_ = std::move(found);
    noise_ = noise();
  }

  /// A disk that is full ends no work that may still succeed: only the last save, of stopped work, must.
  void save(bool must) const {
    try {
      saveCheckpoint(request_.checkpoint, hash_, state_);
    } catch (const Error&) {
      if (must) throw;
    }
  }

  /// Samples per half of the next pass: at most as many as take the work to the next of the counts 8, 16, 32,
  /// ... at which noise is tested, also where a checkpoint is between two of them. They depend on what the
  /// work's hash holds and on what is done alone.
  uint32_t passSize() const {
    const double work = static_cast<double>(view_.pixelCount()) * raysOfSample(request_);
    const double wanted = std::clamp(0x1p21 / work, 1.0, 64.0);
    const uint32_t next = std::bit_ceil(std::max(state_.samples + 1, 8u));
    return std::min(std::bit_floor(static_cast<uint32_t>(wanted)), next - state_.samples);
  }

  void pass(uint32_t count) {
    constexpr size_t block = 64;
    const size_t pixels = view_.pixelCount();
    tbb::parallel_for(size_t{0}, (pixels + block - 1) / block, [&](size_t b) {
      for (size_t pixel = b * block; pixel < std::min(pixels, (b + 1) * block); ++pixel) {
        if (request_.stop.stop_requested()) return;
        samplePixel(pixel, count);
      }
    });
    if (tracer_) tracer_->trace(state_.samples, count, state_.sums);
    checkStop();
    state_.samples += count;
    if (std::has_single_bit(state_.samples) || state_.samples == needed_) noise_ = noise();
  }

  void checkStop() const {
    if (request_.stop.stop_requested()) throw Error("reference: stopped");
  }

  void samplePixel(size_t pixel, uint32_t count) {
    Surface surface;
    const bool seen = reflects() && view_.surface(pixel, surface);
    if (!seen && !airlight_) return;
    const glm::vec3 passes = seen ? view_.transmittance(pixel) : glm::vec3(0);
    for (uint32_t half = 0; half < 2; ++half) {
      Sampler sampler(request_.seed, pixel, half);
      Sums& sums = state_.sums[2 * pixel + half];
      if (seen && isLightFactor(request_.term)) {
        integrator_->sample(surface, sampler, state_.samples, count, sums);
        continue;
      }
      Sums reflected{};
      if (seen) integrator_->sample(surface, sampler, state_.samples, count, reflected);
      for (int c = 0; c < 3; ++c)
        sums[static_cast<size_t>(c)] += reflected[static_cast<size_t>(c)] * static_cast<double>(passes[c]);
      if (airlight_) sampleAirlight(pixel, count, sampler, sums);
    }
  }

  void sampleAirlight(size_t pixel, uint32_t count, Sampler& sampler, Sums& sums) const {
    const glm::vec3 eye(view_.frame.camera_position), direction = view_.direction(pixel);
    const float end = view_.distance(pixel);
    for (uint32_t i = state_.samples; i < state_.samples + count; ++i) {
      sampler.startSample(i);
      const glm::dvec3 value = airlight_->sample(eye, direction, end, sampler);
      for (int c = 0; c < 3; ++c) sums[static_cast<size_t>(c)] += value[c];
    }
  }

  bool finished() const {
    if (state_.samples >= needed_) return true;
    if (!(request_.noise > 0) || state_.samples < 8 || !std::has_single_bit(state_.samples)) return false;
    if (noise_) return *noise_ <= request_.noise;
    const bool traces = tracer_ || airlight_ || reflects();
    return !traces || 2 * state_.samples >= kFewestBlack;
  }

  std::optional<double> noise() const { return noiseOf(*integrator_, request_, state_, counts_); }

  /// Whether samples start at what the camera sees.
  bool reflects() const { return request_.term != Term::media && request_.term != Term::caustic; }

  Progress progress(double secondsPerSample) const {
    double wanted = needed_;
    const double reached = noise_.value_or(0);
    if (request_.noise > 0 && reached > 0) {
      const double ratio = reached / request_.noise;
      wanted = std::clamp(state_.samples * ratio * ratio, static_cast<double>(state_.samples), wanted);
    }
    return {.fraction = state_.samples / wanted,
            .noise = reached,
            .secondsLeft = secondsPerSample * (wanted - state_.samples),
            .spp = static_cast<int>(2 * state_.samples)};
  }

  Result finish() {
    Result result;
    result.noiseRms = noise_.value_or(0);
    result.spp = static_cast<int>(2 * state_.samples);
    develop(*integrator_, view_, request_, state_, image_);
    auto& metadata = image_.metadata();
    metadata["noise_rms"] = fmt::format("{}", result.noiseRms);
    metadata["spp"] = fmt::format("{}", result.spp);
    metadata["seed"] = fmt::format("{}", request_.seed);
    metadata["term"] = name(request_.term);
    metadata["light"] = fmt::format("{}", request_.light);
    metadata["bounces"] = fmt::format("{}", request_.bounces);
    metadata["interfaces"] = fmt::format("{}", request_.interfaces);
    result.image = downsample(image_, request_.aa);
    if (request_.progress) request_.progress({1, result.noiseRms, 0, result.spp});
    std::error_code ignored;
    if (!request_.checkpoint.empty()) std::filesystem::remove(request_.checkpoint, ignored);
    return result;
  }

  const Request& request_;
  RayScene rays_;
  View view_;
  std::unique_ptr<Integrator> integrator_;
  uint32_t needed_;                    ///< samples per half
  std::vector<unsigned char> counts_;  ///< which pixels count for the noise
  Image image_;
  std::optional<Airlight> airlight_;
  std::optional<LightTracer> tracer_;
  Accumulators state_;
  std::string hash_;
  std::optional<double> noise_;  ///< at the last count of samples at which it was asked for
};

}  // namespace

int ownLights(const scene::Pose& pose) {
  const auto environment = [](const glsl::Light& light) {
    return (light.flags & glsl::light_flag_environment) != 0;
  };
  return static_cast<int>(std::find_if(pose.lights.begin(), pose.lights.end(), environment) -
                          pose.lights.begin());
}

void checkLight(const Request& r) {
  const int lights = static_cast<int>(r.pose.lights.size());
  if (r.spp < 1 || r.spp > (1 << 24))
    throw UsageError(fmt::format("reference: spp {} is not in 1 .. 2^24", r.spp));
  if (isLightFactor(r.term) && (r.light < 0 || r.light >= lights))
    throw UsageError(fmt::format("reference: {} needs one light; {} is not in 0 .. {}", name(r.term), r.light,
                                 lights - 1));
  checkBounces(r);
  checkReliefPaths(r);
  checkSubsurface(r);
  if (!acceptsInterfaces(r.term, r.interfaces))
    throw UsageError(fmt::format("reference: interfaces {} with the term {}; {}", r.interfaces, name(r.term),
                                 acceptedInterfaces(r.term)));
  if (r.light < kAllLights || r.light > lights)
    throw UsageError(fmt::format("reference: light {} is not in 0 .. {} ({}: the environment) nor {} (all)",
                                 r.light, lights, lights, kAllLights));
}

Result render(const Request& request) {
  validate(request);
  tbb::task_arena arena(request.threads > 0 ? request.threads : tbb::task_arena::automatic);
  return arena.execute([&] { return Work(request).run(); });
}

}  // namespace limn::reference
