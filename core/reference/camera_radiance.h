// What the camera gets from a surface besides reflected light of the light sources: emission, and the
// environment seen in specular surfaces.
#pragma once

#include "core/reference/environment.h"
#include "core/reference/surface.h"

namespace limn::reference {

/// Radiance towards the camera, W/(sr m^2).
glm::vec3 cameraRadiance(const Surface& surface, const scene::Material& material,
                         const EnvironmentLight& environment);

}  // namespace limn::reference
