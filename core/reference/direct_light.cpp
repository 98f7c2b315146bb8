#include "core/reference/private/direct_light.h"

#include <glm/glm.hpp>

#include "core/scene/light_texture.h"

namespace limn::reference {
namespace {

/// One light at one surface.
struct Estimate {
  const RayScene& rays;
  const Surface& surface;
  const SampleRange& samples;
  uint32_t pair;  ///< the light's first
  Sums& sums;
  const RayMedium& medium;
  glm::vec3 tint{1};  ///< of the light's texture

  void addPunctual(const PointView& view) const {
    if (!view.above()) return;
    const Arrival& arrival = view.arrival();
    const glm::vec3 value = surface.reflectance(arrival.direction) * view.irradiance();
    if (value != glm::vec3(0) && arrives(arrival)) add(value * through(arrival), samples.count);
  }

  /// What a smooth coat mirrors of the light from far away.
  void addMirrored(const EnvironmentView& view) const {
    const glm::vec3 share = surface.mirrored();
    if (share == glm::vec3(0)) return;
    const Arrival arrival = view.towards(surface.mirrorDirection());
    const glm::vec3 value = share * arrival.radiance;
    if (value != glm::vec3(0) && arrives(arrival)) add(value * through(arrival), samples.count);
  }

  /// A light of which the surface may not see anything.
  template <class View>
  void addExtended(const View& view) const {
    if (view.above() && !view.dark()) addSamples(view);
  }

  template <class View>
  void addSamples(const View& view) const {
    for (uint32_t i = samples.first; i < samples.first + samples.count; ++i) {
      samples.sampler.startSample(i);
      addLightSample(view, samples.sampler.pair(pair));
      const glm::vec2 lobe = samples.sampler.pair(pair + 2);
      addBrdfSample(view, glm::vec3(samples.sampler.pair(pair + 1), lobe.x));
    }
  }

 private:
  /// What the light's texture and the medium leave of what arrives. In smoke this takes longer than a ray.
  glm::vec3 through(const Arrival& arrival) const {
    return tint * (arrival.finite ? medium.transmittanceBetween(surface.position, arrival.target)
                                  : medium.transmittanceToInfinity(surface.position, arrival.direction));
  }

  /// W V of one direction.
  bool arrives(const Arrival& arrival) const {
    return surface.relief.lit(arrival.direction) && unblocked(rays, surface, arrival);
  }

  void add(const glm::vec3& value, double weight) const {
    for (int c = 0; c < 3; ++c) sums[static_cast<size_t>(c)] += weight * static_cast<double>(value[c]);
  }

  template <class View>
  void addLightSample(const View& view, glm::vec2 u) const {
    const Arrival arrival = view.sample(u);
    if (!(arrival.pdf > 0.f)) return;
    const glm::vec3 value = surface.reflectance(arrival.direction) * arrival.radiance;
    if (value == glm::vec3(0) || !arrives(arrival)) return;
    const float brdfPdf = surface.pdf(arrival.direction);
    add(value * through(arrival) * (powerHeuristic(arrival.pdf, brdfPdf) / arrival.pdf), 1);
  }

  template <class View>
  void addBrdfSample(const View& view, const glm::vec3& u) const {
    const glm::vec3 direction = surface.sample(u);
    const float pdf = surface.pdf(direction);
    if (!(pdf > 0.f)) return;
    const Arrival arrival = view.towards(direction);
    if (!(arrival.pdf > 0.f)) return;
    const glm::vec3 value = surface.reflectance(direction) * arrival.radiance;
    if (value != glm::vec3(0) && arrives(arrival))
      add(value * through(arrival) * (powerHeuristic(pdf, arrival.pdf) / pdf), 1);
  }
};

}  // namespace

double raysOfSample(const Request& request) {
  // Factors of a light take one ray a sample, however many lights there are.
  const int lights = isLightFactor(request.term) ? 0 : askedLights(request).count();
  return (1.0 + lights) * (1.0 + request.bounces);
}

DirectLight::DirectLight(const RayScene& rays, const Request& request)
    : rays_(rays), lights_(request.pose.lights), asked_(askedLights(request)) {
  if (asked_.environment && rays.environment().present()) environment_ = &rays.environment();
}

void DirectLight::add(const Surface& surface, const SampleRange& samples, Sums& sums) const {
  for (int i = asked_.first; i < asked_.last; ++i) {
    const glsl::Light& light = lights_[static_cast<size_t>(i)];
    const glm::vec3 tint = scene::lightTextureAt(rays_.scene(), light, surface.position);
    if (tint == glm::vec3(0)) continue;
    const Estimate estimate{.rays = rays_,
                            .surface = surface,
                            .samples = samples,
                            .pair = samples.pair + 3u * static_cast<uint32_t>(i),
                            .sums = sums,
                            .medium = rays_.medium(),
                            .tint = tint};
    if (isPunctual(light))
      estimate.addPunctual(PointView(light, surface));
    else if (light.type == glsl::light_rectangle || glsl::light_is_distant_rectangle(light))
      estimate.addExtended(RectangleView(light, surface));
    else
      estimate.addExtended(ConeView(light, surface));
  }
  if (!environment_) return;
  const EnvironmentView environment(*environment_);
  const Estimate estimate{
      rays_, surface, samples, samples.pair + 3u * static_cast<uint32_t>(asked_.last), sums, rays_.medium()};
  estimate.addSamples(environment);
  estimate.addMirrored(environment);
}

}  // namespace limn::reference
