// The courtyard that several scenes share.
#pragma once

#include "assets/generator/scene.h"

namespace limn::assets {

/// The courtyard without lights and cameras: |x| < 6 and |z| < 3 is open to the sky, a gallery runs around
/// it. Every carved part is simplified to `share` of its triangles; 1: as made.
void addAtrium(Scene& scene, float share);

}  // namespace limn::assets
