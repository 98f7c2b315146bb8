#include "core/scene/medium.h"

#include "core/scene/density_grid.h"

namespace limn::scene {

void setMedium(glsl::FrameBlock& frame, const Medium& medium, const Bounds& bounds) {
  const float radius = bounds.radius();
  const bool present = medium.present() && radius > 0;
  frame.medium_extinction = present ? glm::vec4(medium.sigmaA + medium.sigmaS, 1) : glm::vec4(0);
  frame.medium_scattering = present ? glm::vec4(medium.sigmaS, medium.g) : glm::vec4(0);
  frame.medium_to_box = mediumToBox(medium);
  frame.medium_ball = glm::vec4(bounds.empty() ? glm::vec3(0) : bounds.centre(), radius);
}

}  // namespace limn::scene
