// One hoplite: bronze helmet, cuirass and greaves, leather strips, a round shield and a spear.
#pragma once

#include "assets/generator/scene.h"

namespace limn::assets::soldier {

/// About 100k triangles, facing +Z, feet on y = 0, 1.8 m tall. Adds its materials to `scene`.
std::vector<Primitive> build(Scene& scene);

}  // namespace limn::assets::soldier
