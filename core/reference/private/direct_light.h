// Computes direct light at any vertex of a path: what arrives from the lights and the environment and is
// reflected.
#pragma once

#include <vector>

#include "core/reference/private/integrator.h"
#include "core/reference/private/light_view.h"
#include "core/scene/environment_light.h"

namespace limn::reference {

/// Holds the samples to take of one surface, and the first of their pairs of random numbers.
struct SampleRange {
  Sampler& sampler;
  uint32_t pair, first, count;
};

/// Returns about how many rays a sample of the request's term takes, by which the sizes of passes go.
double raysOfSample(const Request& request);

/// Computes direct light by next-event estimation with one light sample and one BRDF sample per light,
/// weighted by the power heuristic (Veach 1997, section 9.2.4); punctual lights are evaluated once. Where the
/// surface has a height map, light arrives only past its bumps (ReliefPlace::lit).
class DirectLight {
 public:
  /// Takes the lights that the request asks for.
  DirectLight(const RayScene& rays, const Request& request);

  /// Returns how many pairs of random numbers a surface takes.
  uint32_t pairs() const { return 3u * static_cast<uint32_t>(asked_.last + 1); }

  /// Adds the samples' radiance (R, G, B) that `surface` reflects along its view direction.
  void add(const Surface& surface, const SampleRange& samples, Sums& sums) const;

 private:
  const RayScene& rays_;
  const std::vector<glsl::Light>& lights_;
  AskedLights asked_;
  const scene::EnvironmentLight* environment_ = nullptr;  ///< null: not asked for, or dark
};

}  // namespace limn::reference
