// What translucent materials reflect in all, for what does not look below surfaces.
#pragma once

#include <algorithm>

#include "core/scene/scene.h"

namespace limn::scene {

/// Returns the index of refraction that a translucent material counts with: what is known of boundaries is
/// known for 1 to 3.
inline float subsurfaceIor(float ior) {
  return std::clamp(ior, 1.f, 3.f);
}

/// Returns the share of entering diffuse light that leaves a half space again, 0 to 1, by its
/// Subsurface::absorption and the index of refraction of its material.
LIMN_API glm::vec3 subsurfaceAlbedo(const glm::vec3& absorption, float ior);

/// Returns the Subsurface::absorption of which that share is `albedo`.
LIMN_API glm::vec3 subsurfaceAbsorption(const glm::vec3& albedo, float ior);

}  // namespace limn::scene
