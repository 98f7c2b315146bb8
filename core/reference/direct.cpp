#include <glm/glm.hpp>

#include "core/reference/integrator.h"
#include "core/reference/light_view.h"

namespace limn::reference {
namespace {

/// Weight of a strategy of density `own` beside one of density `other` (Veach 1997, power heuristic with
/// exponent 2).
float powerHeuristic(float own, float other) {
  const float ratio = other / own;
  return 1.f / (1.f + ratio * ratio);
}

class DirectIntegrator final : public Integrator {
 public:
  DirectIntegrator(const RayScene& rays, const Request& request)
      : rays_(rays), lights_(request.pose.lights), environment_(request.scene.environment) {
    const int count = static_cast<int>(lights_.size());
    first_ = request.light == allLights ? 0 : std::min(request.light, count);
    last_ = request.light == allLights ? ownLights(request.pose) : std::min(request.light + 1, count);
    withEnvironment_ = request.light == allLights || request.light == count;
  }

  void sample(const Surface& surface, Sampler& sampler, uint32_t first, uint32_t count,
              Sums& sums) const override {
    if (surface.specular()) return;  // takes no direct light: what it reflects belongs to other terms
    for (int i = first_; i < last_; ++i) {
      const glsl::Light& light = lights_[static_cast<size_t>(i)];
      const Samples samples{sampler, 3u * static_cast<uint32_t>(i), first, count};
      if (isPunctual(light))
        addPunctual(PointView(light, surface), surface, count, sums);
      else if (light.info.x == glsl::light_rectangle || glsl::light_is_distant_rectangle(light))
        addRectangle(RectangleView(light, surface), surface, samples, sums);
      else
        addCone(ConeView(light, surface), surface, samples, sums);
    }
    const EnvironmentView environment(environment_);
    if (withEnvironment_ && !environment.dark())
      addSamples(environment, surface, {sampler, 3u * static_cast<uint32_t>(last_), first, count}, sums);
  }

  glm::dvec3 estimate(const Sums& sums, double samples) const override {
    return glm::dvec3(sums[0], sums[1], sums[2]) / samples;
  }

 private:
  /// The samples to take of one light, and the first of its pairs of random numbers.
  struct Samples {
    Sampler& sampler;
    uint32_t pair, first, count;
  };

  /// f cos, 0 below either horizon.
  static glm::vec3 reflectance(const Surface& surface, const glm::vec3& direction) {
    if (!(glm::dot(surface.values.geometric_normal, direction) > 0.f)) return glm::vec3(0);
    const float cosine = glm::dot(surface.values.normal, direction);
    return cosine > 0.f ? cosine * glsl::brdf(surface.brdf, surface.values.normal, surface.view, direction)
                        : glm::vec3(0);
  }

  static void add(const glm::vec3& value, double weight, Sums& sums) {
    for (int c = 0; c < 3; ++c) sums[static_cast<size_t>(c)] += weight * static_cast<double>(value[c]);
  }

  void addPunctual(const PointView& view, const Surface& surface, uint32_t count, Sums& sums) const {
    if (!view.above()) return;
    const glm::vec3 value = reflectance(surface, view.arrival().direction) * view.irradiance();
    if (value != glm::vec3(0) && unblocked(rays_, surface, view.arrival())) add(value, count, sums);
  }

  void addRectangle(const RectangleView& view, const Surface& surface, const Samples& samples,
                    Sums& sums) const {
    if (view.above() && !view.dark()) addSamples(view, surface, samples, sums);
  }

  void addCone(const ConeView& view, const Surface& surface, const Samples& samples, Sums& sums) const {
    if (view.above() && !view.dark()) addSamples(view, surface, samples, sums);
  }

  template <class View>
  void addSamples(const View& view, const Surface& surface, const Samples& samples, Sums& sums) const {
    for (uint32_t i = samples.first; i < samples.first + samples.count; ++i) {
      samples.sampler.startSample(i);
      addLightSample(view, surface, samples.sampler.pair(samples.pair), sums);
      const glm::vec2 lobe = samples.sampler.pair(samples.pair + 2);
      addBrdfSample(view, surface, glm::vec3(samples.sampler.pair(samples.pair + 1), lobe.x), sums);
    }
  }

  template <class View>
  void addLightSample(const View& view, const Surface& surface, glm::vec2 u, Sums& sums) const {
    const Arrival arrival = view.sample(u);
    if (!(arrival.pdf > 0.f)) return;
    const glm::vec3 value = reflectance(surface, arrival.direction) * arrival.radiance;
    if (value == glm::vec3(0)) return;
    const float brdfPdf =
        glsl::brdf_pdf(surface.brdf, surface.values.normal, surface.view, arrival.direction);
    if (unblocked(rays_, surface, arrival))
      add(value * (powerHeuristic(arrival.pdf, brdfPdf) / arrival.pdf), 1, sums);
  }

  template <class View>
  void addBrdfSample(const View& view, const Surface& surface, const glm::vec3& u, Sums& sums) const {
    const glm::vec3 direction = glsl::brdf_sample(surface.brdf, surface.values.normal, surface.view, u);
    const float pdf = glsl::brdf_pdf(surface.brdf, surface.values.normal, surface.view, direction);
    if (!(pdf > 0.f)) return;
    const Arrival arrival = view.towards(direction);
    if (!(arrival.pdf > 0.f)) return;
    const glm::vec3 value = reflectance(surface, direction) * arrival.radiance;
    if (value != glm::vec3(0) && unblocked(rays_, surface, arrival))
      add(value * (powerHeuristic(pdf, arrival.pdf) / pdf), 1, sums);
  }

  const RayScene& rays_;
  const std::vector<glsl::Light>& lights_;
  EnvironmentLight environment_;
  int first_ = 0, last_ = 0;  ///< of lights_
  bool withEnvironment_ = false;
};

}  // namespace

std::unique_ptr<Integrator> makeDirectIntegrator(const RayScene& rays, const Request& request) {
  return std::make_unique<DirectIntegrator>(rays, request);
}

}  // namespace limn::reference
