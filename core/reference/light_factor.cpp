// What keeps the light of one lamp from what the camera sees: V, other surfaces, or W, bumps of its own.
#include <glm/glm.hpp>

#include "core/reference/private/integrator.h"
#include "core/reference/private/light_view.h"

namespace limn::reference {
namespace {

class LightFactorIntegrator final : public Integrator {
 public:
  LightFactorIntegrator(const RayScene& rays, const Request& request)
      : rays_(rays),
        light_(request.pose.lights[static_cast<size_t>(request.light)]),
        relief_(request.term == Term::relief) {}

  void sample(const Surface& surface, Sampler& sampler, uint32_t first, uint32_t count,
              Sums& sums) const override {
    if (isPunctual(light_)) {
      const PointView view(light_, surface);
      if (!view.above()) return;
      const double visible = passes(surface, view.arrival()) ? count : 0;
      for (size_t i = 0; i < sums.size(); ++i) sums[i] += i % 2 == 0 ? visible : count;
    } else if (light_.type == glsl::light_rectangle || glsl::light_is_distant_rectangle(light_)) {
      addSamples(RectangleView(light_, surface), surface, sampler, first, count, sums);
    } else {
      addSamples(ConeView(light_, surface), surface, sampler, first, count, sums);
    }
  }

  glm::dvec3 estimate(const Sums& sums, double) const override {
    return glm::dvec3(sums[1] > 0 ? sums[0] / sums[1] : 1.0);
  }

 private:
  bool passes(const Surface& surface, const Arrival& arrival) const {
    return relief_ ? surface.relief.lit(arrival.direction) : unblocked(rays_, surface, arrival);
  }

  template <class View>
  void addSamples(const View& view, const Surface& surface, Sampler& sampler, uint32_t first, uint32_t count,
                  Sums& sums) const {
    if (!view.above()) return;
    for (uint32_t i = first; i < first + count; ++i) {
      sampler.startSample(i);
      const Arrival arrival = view.sample(sampler.pair(0));
      if (!(glm::dot(arrival.direction, surface.values.geometric_normal) > 0.f)) continue;
      sums[1] += 1;
      sums[3] += arrival.irradianceWeight;
      if (!passes(surface, arrival)) continue;
      sums[0] += 1;
      sums[2] += arrival.irradianceWeight;
    }
  }

  const RayScene& rays_;
  const glsl::Light light_;
  bool relief_;
};

}  // namespace

std::unique_ptr<Integrator> makeLightFactorIntegrator(const RayScene& rays, const Request& request) {
  return std::make_unique<LightFactorIntegrator>(rays, request);
}

}  // namespace limn::reference
