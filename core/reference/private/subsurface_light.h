// Computes light that entered a translucent body and leaves it again.
#pragma once

#include <functional>
#include <glm/glm.hpp>

#include "core/question/subsurface_model.h"
#include "core/reference/private/ray_scene.h"
#include "core/reference/private/sampler.h"
#include "core/reference/private/surface.h"

namespace limn::reference {

class SubsurfaceLight {
 public:
  /// Returns one sample of the irradiance that enters a surface, W/m^2. Entries of one sample are counted
  /// from 0, so that each has random numbers of its own.
  using Entering = std::function<glm::dvec3(const Surface& surface, uint32_t entry)>;

  SubsurfaceLight(const RayScene& rays, SubsurfaceModel model) : rays_(rays), model_(model) {}

  /// Returns one sample of the radiance that leaves the translucent surface along its view, W/(sr m^2).
  glm::dvec3 sample(const Surface& surface, const Sampler& sampler, const Entering& entering) const;

 private:
  glm::dvec3 localLight(const Surface& surface, const Entering& entering) const;
  glm::dvec3 probedLight(const Surface& surface, const Sampler& sampler, const Entering& entering) const;
  glm::dvec3 walkedLight(const Surface& surface, const Sampler& sampler, const Entering& entering) const;

  const RayScene& rays_;
  SubsurfaceModel model_;
};

}  // namespace limn::reference
