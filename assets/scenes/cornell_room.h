// The room that several scenes share: a Cornell box without its blocks and lamp.
#pragma once

#include "assets/generator/scene.h"

namespace limn::assets {

/// Room of 2 m a side, [-1, 1] x [0, 2] x [-1, 1], open towards +z; left wall red, right wall green. Returns
/// its white material.
int addCornellRoom(Scene& scene);

/// Cameras "main" and "close" before the open side.
void addCornellCameras(Scene& scene);

}  // namespace limn::assets
