// The building blocks of the atrium. All stand on y = 0 unless said otherwise; metres.
#pragma once

#include "assets/generator/mesh.h"

namespace limn::assets::atrium {

/// A fluted column of the given height (base, shaft with entasis, leaf capital, abacus).
Mesh flutedColumn(float height, float radius);
/// A plain, slimmer column with a ring capital.
Mesh plainColumn(float height, float radius);
/// A wall of `width` x `height` x `depth` over a semicircular opening of `radius`, with archivolts and a
/// keystone; springing at y = 0, centred on x = 0 and z = 0.
Mesh archedWall(float width, float height, float depth, float radius);
/// Rails and balusters over `width` along X.
Mesh balustrade(float width, float height, int balusters);
/// A moulding around the inside of the rectangle |x| <= halfX, |z| <= halfZ: `profile` holds (distance
/// inwards, height), from bottom to top.
Mesh cornice(std::span<const glm::vec2> profile, float halfX, float halfZ);
/// A two-tier fountain.
Mesh fountain();
/// A hanging cloth of `width` x `drop` below y = 0, folded, facing +Z.
Mesh banner(float width, float drop);

}  // namespace limn::assets::atrium
