// Samples light of the sources that is scattered once on its way to the camera, shadows included.
#pragma once

#include <vector>

#include "core/reference/private/medium_view.h"
#include "core/reference/private/ray_scene.h"
#include "core/reference/private/sampler.h"

namespace limn::reference {

class Airlight {
 public:
  Airlight(const RayScene& rays, const Request& request);

  /// Returns whether there is anything to sample.
  bool present() const { return !lights_.empty() && rays_.medium().medium().scattering != glm::vec3(0); }
  /// Returns one sample of the radiance that the medium sends along the ray from `eye` in `direction` (unit)
  /// up to `end` metres. Distances are sampled evenly in the angle from the light (Kulla and Fajardo 2012).
  glm::dvec3 sample(const glm::vec3& eye, const glm::vec3& direction, float end,
                    const Sampler& sampler) const;

 private:
  const RayScene& rays_;
  std::vector<glsl::Light> lights_;
};

}  // namespace limn::reference
