// Media whose density is known in closed form.
#pragma once

#include <functional>
#include <memory>

#include "core/scene/density_grid.h"

namespace limn::test {

/// A grid over a box whose voxels hold density(place of their centre, world).
inline scene::DensityGrid gridOf(glm::ivec3 size, glm::vec3 low, glm::vec3 high,
                                 const std::function<float(glm::vec3)>& density) {
  scene::DensityGrid grid;
  grid.size = size;
  for (int axis = 0; axis < 3; ++axis) {
    grid.worldToBox[axis][axis] = 1 / (high[axis] - low[axis]);
    grid.worldToBox[3][axis] = -low[axis] / (high[axis] - low[axis]);
  }
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        grid.values.push_back(density(glm::mix(low, high, (glm::vec3(x, y, z) + 0.5f) / glm::vec3(size))));
  return grid;
}

/// The same density everywhere in and around the bounding sphere of a scene.
inline scene::DensityGrid constantGrid(const scene::Bounds& bounds, float density) {
  const glm::vec3 half(1.01f * bounds.radius());
  return gridOf({3, 4, 5}, bounds.centre() - half, bounds.centre() + half,
                [density](glm::vec3) { return density; });
}

}  // namespace limn::test
