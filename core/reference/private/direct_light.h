// Computes direct light at any vertex of a path: what arrives from the lights and the environment and is
// reflected.
#pragma once

#include <vector>

#include "core/reference/private/integrator.h"
#include "core/reference/private/medium_view.h"
#include "core/scene/environment_light.h"

namespace limn::reference {

/// Holds the samples to take of one surface, and the first of their pairs of random numbers.
struct SampleRange {
  Sampler& sampler;
  uint32_t pair, first, count;
};

/// Computes direct light by next-event estimation with one light sample and one BRDF sample per light,
/// weighted by the power heuristic (Veach 1997, section 9.2.4); punctual lights are evaluated once. Where the
/// surface has a height map, light arrives only past its bumps (ReliefPlace::lit).
class DirectLight {
 public:
  /// Takes the lights that the request asks for.
  DirectLight(const RayScene& rays, const Request& request);

  /// Returns how many pairs of random numbers a surface takes.
  uint32_t pairs() const { return 3u * static_cast<uint32_t>(last_ + 1); }

  /// Adds the samples' radiance (R, G, B) that `surface` reflects along its view direction.
  void add(const Surface& surface, const SampleRange& samples, Sums& sums) const;

 private:
  const RayScene& rays_;
  const std::vector<glsl::Light>& lights_;
  scene::EnvironmentLight environment_;
  int first_ = 0, last_ = 0;  ///< of lights_
  bool withEnvironment_ = false;
};

}  // namespace limn::reference
