// Scenes made difficult.
#pragma once

#include "core/base/export.h"
#include "core/scene/scene.h"
#include "core/technique/stress_case.h"

namespace limn::bench {

/// The scene after `change`. Changes of the camera or the picture (cameraInside, cameraNear, imageWidth)
/// leave it as it is. Scenes without lights, floor or rectangle lights keep what the change would have moved.
LIMN_API scene::Scene stressed(scene::Scene scene, StressChange change, double amount);

/// The scene without its lights, under a small procedural sky: brighter above, with a sun of a few texels.
/// For techniques that answer the environment's light and no other.
LIMN_API scene::Scene litBySkyAlone(scene::Scene scene);

/// The scene, its smallest object of glass where nothing is specular: for techniques that answer specular.
LIMN_API scene::Scene withGlass(scene::Scene scene);

/// The same in a thin medium: for techniques that answer media or caustics.
LIMN_API scene::Scene inFog(scene::Scene scene);

/// The camera so many radii before the middle of the smallest object (0: inside), looking as before.
LIMN_API scene::CameraPose cameraAtSmallest(const scene::Scene& scene, const scene::Pose& pose,
                                            scene::CameraPose camera, float radii = 0);

}  // namespace limn::bench
