#include "core/reference/camera_radiance.h"

namespace limn::reference {

glm::vec3 cameraRadiance(const Surface& surface, const EnvironmentLight&) {
  return surface.values.emission;
}

}  // namespace limn::reference
