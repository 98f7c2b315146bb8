// A horse at the walk, modelled as one implicit surface.
#pragma once

#include "assets/generator/mesh.h"

namespace limn::assets {

/// About `triangles` triangles, closed: 1.62 m high at the withers, facing +X, hooves on y = 0.
Mesh horse(std::size_t triangles);

}  // namespace limn::assets
