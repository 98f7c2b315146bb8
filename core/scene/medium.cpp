#include "core/scene/medium.h"

#include "core/scene/density_grid.h"

namespace limn::scene {

void setMedium(glsl::FrameBlock& frame, const Medium& medium, const Bounds& bounds) {
  const float radius = bounds.radius();
  const bool present = medium.present() && radius > 0;
  frame.medium_extinction = present ? medium.sigmaA + medium.sigmaS : glm::vec3(0);
  frame.medium_scattering = present ? medium.sigmaS : glm::vec3(0);
  frame.medium_asymmetry = present ? medium.g : 0.f;
  frame.medium_to_box = mediumToBox(medium);
  frame.medium_ball = {bounds.empty() ? glm::vec3(0) : bounds.centre(), radius};
}

}  // namespace limn::scene
