// Declares the lights of scenes that have none.
#pragma once

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::scene {

/// Adds two lights that belong to the viewer: "key", a directional light from above the camera's left
/// shoulder (angular diameter 0.03 rad), and "headlight", a point light at the camera. A white Lambertian
/// surface that faces the key light reflects a radiance of 0.7 from it; one at the centre of `bounds` that
/// faces the camera reflects 0.15 from the headlight. Adds nothing when `bounds` is empty.
LIMN_API void addDefaultLights(Scene& scene, const CameraPose& camera, const Bounds& bounds);

}  // namespace limn::scene
