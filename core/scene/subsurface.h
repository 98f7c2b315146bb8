// What translucent materials reflect in all, for what does not look below surfaces.
#pragma once

#include "core/scene/scene.h"

namespace limn::scene {

/// Returns the share of entering diffuse light that leaves a half space again, 0 to 1, by its
/// Subsurface::absorption and its index of refraction, which counts as one of 1 to 3.
LIMN_API glm::vec3 subsurfaceAlbedo(const glm::vec3& absorption, float ior);

/// Returns the Subsurface::absorption of which that share is `albedo`.
LIMN_API glm::vec3 subsurfaceAbsorption(const glm::vec3& albedo, float ior);

}  // namespace limn::scene
