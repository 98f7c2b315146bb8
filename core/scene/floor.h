// Declares the floor that receives the shadows of scenes that have none.
#pragma once

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::scene {

/// Gives the scene a horizontal square, a node "floor", whose middle lies just below the middle of `bounds`
/// and whose sides are a multiple of its radius: diffuse, of reflectance 0.5. Nothing happens to empty
/// bounds.
LIMN_API void addFloor(Scene& scene, const Bounds& bounds);

}  // namespace limn::scene
