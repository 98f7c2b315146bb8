// Samples light of the sources and of the environment that is scattered once on its way to the camera,
// shadows included.
#pragma once

#include <vector>

#include "core/reference/private/ray_scene.h"
#include "core/reference/private/sampler.h"
#include "core/reference/reference.h"
#include "core/scene/environment_light.h"

namespace limn::reference {

class Airlight {
 public:
  /// Takes the lights that the request asks for, as DirectLight has them.
  Airlight(const RayScene& rays, const Request& request);

  /// Returns whether there is anything to sample.
  bool present() const { return !lights_.empty() || environment_; }
  /// Returns one sample of the radiance that the medium sends along the ray from `eye` in `direction` (unit)
  /// up to `end` metres.
  glm::dvec3 sample(const glm::vec3& eye, const glm::vec3& direction, float end,
                    const Sampler& sampler) const;

 private:
  /// Holds the piece of a viewing ray that lies in the medium, in metres from the eye.
  struct Piece {
    glm::vec3 eye, direction;
    float from, to;
  };

  glm::dvec3 ofLight(const Piece& piece, const glsl::Light& light, const Sampler& sampler,
                     uint32_t pair) const;
  glm::dvec3 ofEnvironment(const Piece& piece, const Sampler& sampler, uint32_t pair) const;

  const RayScene& rays_;
  std::vector<glsl::Light> lights_;                       ///< none where nothing scatters
  const scene::EnvironmentLight* environment_ = nullptr;  ///< null likewise, not asked for, or dark
};

}  // namespace limn::reference
