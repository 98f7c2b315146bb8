#include "core/scene/deformed_surface.h"

#include <cstddef>

namespace limn::scene {

void DeformedSurface::move(const Primitive& primitive, const Deformation& state) {
  if (!positions_.empty() && state.joints == state_.joints && state.morphWeights == state_.morphWeights)
    return;
  state_ = state;
  deform(primitive, state, positions_, normals_, tangents_);
  double twice = 0;
  for (size_t t = 0; t + 2 < primitive.indices.size(); t += 3) {
    const glm::dvec3 corner = positions_[primitive.indices[t]];
    twice += glm::length(glm::cross(glm::dvec3(positions_[primitive.indices[t + 1]]) - corner,
                                    glm::dvec3(positions_[primitive.indices[t + 2]]) - corner));
  }
  area_ = 0.5 * twice;
}

}  // namespace limn::scene
