// Path tracing from the camera: direct light at every surface that a path meets.
#include <algorithm>
#include <glm/glm.hpp>

#include "core/reference/private/direct_light.h"
#include "core/reference/private/specular_paths.h"
#include "core/reference/private/subsurface_light.h"

namespace limn::reference {
namespace {

/// From this bounce on a path goes on with a probability alone (Arvo and Kirk 1990, Russian roulette).
constexpr int kFirstRoulette = 4;

/// Random numbers of what enters translucent surfaces lie behind those of all other estimators of a pixel.
constexpr uint32_t kFirstEntryPair = 1u << 31;

/// A path from the camera, as far as it has got.
struct Path {
  Surface surface;
  glm::dvec3 throughput{1};
  bool metBump = false;  ///< a segment ended on the height map that it started from
};

class PathIntegrator final : public Integrator {
 public:
  PathIntegrator(const RayScene& rays, const Request& request)
      : rays_(rays),
        light_(rays, request),
        withDirect_(request.term != Term::indirect),
        withSubsurface_(contains(kSubsurfaceTerms, request.term)),
        subsurfaceAlone_(request.term == Term::subsurface),
        specularAlone_(request.term == Term::specular),
        reliefPaths_(request.reliefPaths),
        bounces_(request.bounces),
        subsurface_(rays, request.subsurface) {
    if (request.interfaces != 0) specular_.emplace(rays, request.interfaces);
  }

  void sample(const Surface& surface, Sampler& sampler, uint32_t first, uint32_t count,
              Sums& sums) const override {
    if (surface.specular())
      addSeenIn(surface, sampler, first, count, sums);
    else if (!specularAlone_)
      addReflected(surface, sampler, first, count, sums);
  }

  glm::dvec3 estimate(const Sums& sums, double samples) const override {
    return glm::dvec3(sums[0], sums[1], sums[2]) / samples;
  }

 private:
  void addReflected(const Surface& surface, Sampler& sampler, uint32_t first, uint32_t count,
                    Sums& sums) const {
    if (surface.translucent()) {
      if (!subsurfaceAlone_) addReflectedAtBoundary(surface.reflecting(), sampler, first, count, sums);
      if (withSubsurface_) addLightFromBelow(surface, sampler, first, count, sums);
    } else if (!subsurfaceAlone_) {
      addReflectedAtBoundary(surface, sampler, first, count, sums);
    }
  }

  void addReflectedAtBoundary(const Surface& surface, Sampler& sampler, uint32_t first, uint32_t count,
                              Sums& sums) const {
    if (withDirect_) light_.add(surface, {sampler, 0, first, count}, sums);
    if (bounces_ == 0) return;
    for (uint32_t i = first; i < first + count; ++i) follow(surface, {sampler, 0, i, 1}, sums);
  }

  void addLightFromBelow(const Surface& surface, Sampler& sampler, uint32_t first, uint32_t count,
                         Sums& sums) const {
    for (uint32_t i = first; i < first + count; ++i) {
      sampler.startSample(i);
      const glm::dvec3 value =
          subsurface_.sample(surface, sampler, [&](const Surface& place, uint32_t entry) {
            return entering(place, {sampler, kFirstEntryPair + entry * pairsOfPath(), i, 1});
          });
      for (int c = 0; c < 3; ++c) sums[static_cast<size_t>(c)] += value[c];
    }
  }

  /// The irradiance that enters, direct and over other surfaces, in one sample.
  glm::dvec3 entering(const Surface& place, const SampleRange& sample) const {
    Sums light{};
    light_.add(place, sample, light);
    if (bounces_ > 0) follow(place, sample, light);
    sample.sampler.startSample(sample.first);
    return static_cast<double>(glsl::pi) * glm::dvec3(light[0], light[1], light[2]);
  }

  /// Pairs of random numbers of a surface's direct light and of one path from it.
  uint32_t pairsOfPath() const {
    return light_.pairs() + static_cast<uint32_t>(bounces_) * (2 + light_.pairs());
  }

  /// A specular surface takes no light itself: it shows that of others.
  void addSeenIn(const Surface& surface, Sampler& sampler, uint32_t first, uint32_t count, Sums& sums) const {
    if (!specular_) return;
    if (!specular_->many()) {
      for (const SpecularEnd& end : specular_->imageSpace(surface)) addEnd(end, sampler, first, count, sums);
      return;
    }
    for (uint32_t i = first; i < first + count; ++i) {
      sampler.startSample(i);
      addEnd(specular_->sample(surface, sampler), sampler, i, 1, sums);
    }
  }

  void addEnd(const SpecularEnd& end, Sampler& sampler, uint32_t first, uint32_t count, Sums& sums) const {
    if (end.throughput == glm::dvec3(0)) return;
    const glm::dvec3 own(end.surface ? end.surface->values.emission : end.background);
    Sums light{own.x * count, own.y * count, own.z * count, 0};
    if (end.surface) addReflected(*end.surface, sampler, first, count, light);
    for (int c = 0; c < 3; ++c)
      sums[static_cast<size_t>(c)] += end.throughput[c] * light[static_cast<size_t>(c)];
  }

  /// One path, with the random numbers behind those of direct light. The random numbers of a bounce do not
  /// depend on how many there may be: one bounce more adds its own light and changes nothing else.
  void follow(const Surface& surface, const SampleRange& sample, Sums& sums) const {
    Path path{.surface = surface};
    Sampler& sampler = sample.sampler;
    uint32_t pair = sample.pair + light_.pairs();
    for (int bounce = 1; bounce <= bounces_; ++bounce) {
      sampler.startSample(sample.first);
      const glm::vec2 lobe = sampler.pair(pair + 1);
      if (!step(path, glm::vec3(sampler.pair(pair), lobe.x))) return;
      if (bounce >= kFirstRoulette && !survives(lobe.y, path.throughput)) return;
      if (reliefPaths_ != ReliefPaths::relief || path.metBump)
        addLightAtEnd(path, {sampler, pair + 2, sample.first, 1}, sums);
      pair += 2 + light_.pairs();
    }
  }

  void addLightAtEnd(const Path& path, const SampleRange& samples, Sums& sums) const {
    Sums reflected{};
    light_.add(path.surface, samples, reflected);
    for (int c = 0; c < 3; ++c)
      sums[static_cast<size_t>(c)] += path.throughput[c] * reflected[static_cast<size_t>(c)];
  }

  /// On to the next surface, or to another bump of the same one, in a direction of the BRDF's density; false:
  /// nothing comes from there.
  bool step(Path& path, const glm::vec3& u) const {
    const Surface& surface = path.surface;
    const glm::vec3 direction = surface.sample(u);
    const float pdf = surface.pdf(direction);
    if (!(pdf > 0.f)) return false;
    const std::optional<glm::dvec2> bump = surface.relief.bumpAlong(direction);
    const glm::vec3 reflectance =
        bump ? surface.reflectanceFromBump(direction) : surface.reflectance(direction);
    path.throughput *= glm::dvec3(reflectance) / static_cast<double>(pdf);
    if (path.throughput == glm::dvec3(0)) return false;
    if (!bump) return stepToSurface(path, direction);
    if (reliefPaths_ == ReliefPaths::others) return false;
    path.surface = surfaceAtBump(rays_, surface, *bump, direction);
    path.metBump = true;
    return true;
  }

  bool stepToSurface(Path& path, const glm::vec3& direction) const {
    const Surface& surface = path.surface;
    Hit hit;
    if (!surface.relief.abovePlane(direction) || !rays_.nearest(surface.rayOrigin(direction), direction, hit))
      return false;
    const std::optional<Surface> met = surfaceAlong(rays_, hit, direction);
    if (!met || met->specular()) return false;
    path.surface = *met;
    return true;
  }

  /// Ends paths that carry little; those that go on carry the others' share.
  static bool survives(float u, glm::dvec3& throughput) {
    const double probability = std::min(std::max({throughput.x, throughput.y, throughput.z}), 1.0);
    if (static_cast<double>(u) >= probability) return false;
    throughput /= probability;
    return true;
  }

  const RayScene& rays_;
  DirectLight light_;
  std::optional<SpecularPaths> specular_;
  bool withDirect_, withSubsurface_, subsurfaceAlone_, specularAlone_;
  ReliefPaths reliefPaths_;
  int bounces_;
  SubsurfaceLight subsurface_;
};

}  // namespace

std::unique_ptr<Integrator> makePathIntegrator(const RayScene& rays, const Request& request) {
  return std::make_unique<PathIntegrator>(rays, request);
}

}  // namespace limn::reference
