// Declares one estimator per term: what the samples of a pixel add up to.
#pragma once

#include <array>
#include <memory>

#include "core/reference/private/sampler.h"
#include "core/reference/private/surface.h"
#include "core/reference/reference.h"

namespace limn::reference {

/// Holds what one pixel has gathered over the samples of one half; the integrator defines the meaning.
using Sums = std::array<double, 4>;

class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Adds samples first .. first + count - 1 to `sums`. Called from several threads.
  virtual void sample(const Surface& surface, Sampler& sampler, uint32_t first, uint32_t count,
                      Sums& sums) const = 0;
  /// Returns R, G, B of `sums`, gathered over `samples` samples.
  virtual glm::dvec3 estimate(const Sums& sums, double samples) const = 0;
};

/// Makes the integrator of reflected light: direct (unless the term is indirect), and what came to the seen
/// surface over 1 to Request::bounces others; sums: R, G, B. It traces paths with next-event estimation
/// (DirectLight) at every surface, directions chosen with the BRDF's density, and Russian roulette from the
/// fourth bounce on. Translucent surfaces that are seen reflect at their boundary alone and show, in the
/// terms that hold it, what entered them (SubsurfaceLight); those met further on show their local limit.
/// Specular surfaces and backs of single-sided ones end a path; specular surfaces that the camera sees show,
/// with Request::interfaces, the light of others (SpecularPaths).
std::unique_ptr<Integrator> makePathIntegrator(const RayScene& rays, const Request& request);

/// Returns whether the term is a factor of one light: V (visibility) or W (relief).
constexpr bool isLightFactor(Term term) {
  return term == Term::visibility || term == Term::relief;
}

/// Makes the integrator of V or of W of one light, as the request's term says; sums: samples that arrive,
/// samples above the geometric tangent plane, and both weighted by irradiance. Neither factor holds the
/// other one.
std::unique_ptr<Integrator> makeLightFactorIntegrator(const RayScene& rays, const Request& request);

}  // namespace limn::reference
