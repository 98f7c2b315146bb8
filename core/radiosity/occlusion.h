// Declares what light transport between surface elements asks of a scene: whether a line is free, and what a
// medium leaves of light along it.
#pragma once

#include <glm/glm.hpp>
#include <memory>

#include "core/base/export.h"
#include "core/radiosity/forest.h"
#include "core/scene/scene.h"

namespace limn::radiosity {

/// Answers what keeps light from passing along lines; world space. Queries may be made by many threads at
/// once.
class LIMN_API Occlusion {
 public:
  virtual ~Occlusion() = default;
  /// Returns whether anything lies on origin + t * direction, 0 < t < end.
  virtual bool blocked(const glm::vec3& origin, const glm::vec3& direction, float end) const = 0;
  /// Returns the transmittance of the medium over 0 < t < end, `direction` being a unit vector; 1 where there
  /// is no medium.
  virtual glm::vec3 transmittance(const glm::vec3& /*origin*/, const glm::vec3& /*direction*/,
                                  float /*end*/) const {
    return glm::vec3(1);
  }
};

/// Returns the occlusion of a posed scene as the path tracer's shadow rays see it: triangles without their
/// cut-out texels, and the medium. The scene and the pose's geometry must outlive the result. Defined in
/// core/reference, which has the rays. Throws Error where memory ends.
LIMN_API std::unique_ptr<Occlusion> sceneOcclusion(const scene::Scene& scene, const scene::Pose& pose);

/// Returns how far from surfaces rays begin and end to be clear of them despite rounding, in the units of the
/// elements.
inline float rayClearance(const ElementSpace& space) {
  return 0x1p-16f * (1 + glm::length(space.centre()) / space.radius());
}

}  // namespace limn::radiosity
