// Computes what the camera receives from a surface besides reflected light of the light sources: emission,
// and the environment seen in specular surfaces.
#pragma once

#include "core/reference/private/ray_scene.h"
#include "core/reference/private/surface.h"
#include "core/scene/environment_light.h"

namespace limn::reference {

/// Returns the radiance towards the camera of a surface of that draw, W/(sr m^2).
glm::vec3 cameraRadiance(const Surface& surface, const Draw& draw,
                         const scene::EnvironmentLight& environment);

}  // namespace limn::reference
