// Changes scenes so that they become difficult.
#pragma once

#include "core/base/export.h"
#include "core/scene/scene.h"
#include "core/technique/stress_case.h"

namespace limn::bench {

/// Returns the scene after `change`. Changes of the camera or the picture (cameraInside, cameraNear,
/// imageWidth) leave it unchanged. Scenes without lights, floor or rectangle lights keep what the change
/// would have moved.
LIMN_API scene::Scene stressed(scene::Scene scene, StressChange change, double amount);

/// Returns the scene without its lights, under a small procedural sky: brighter above, with a sun of a few
/// texels. It is for techniques that answer only the environment's light.
LIMN_API scene::Scene litBySkyAlone(scene::Scene scene);

/// Returns the scene; where nothing in it is specular, its smallest object is made of glass. It is for
/// techniques that answer specular.
LIMN_API scene::Scene withGlass(scene::Scene scene);
/// Returns the scene with a material model, copper by Torrance and Sparrow, for every material that is not
/// specular; its own roughness stays, down to .05.
LIMN_API scene::Scene withModels(scene::Scene scene);

/// Returns the same scene in a thin medium. It is for techniques that answer media or caustics.
LIMN_API scene::Scene inFog(scene::Scene scene);

/// Returns the camera at this many radii in front of the middle of the smallest object (0: inside), looking
/// in the same direction as before.
LIMN_API scene::CameraPose cameraAtSmallest(const scene::Scene& scene, const scene::Pose& pose,
                                            scene::CameraPose camera, float radii = 0);

}  // namespace limn::bench
