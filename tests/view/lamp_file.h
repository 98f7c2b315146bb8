// A scene to be opened: a square that shines.
#pragma once

#include <cstddef>
#include <vector>

#include "tests/support/gltf_builder.h"

namespace limn::app {

/// Returns the file of a lamp of a mesh, seen from above.
inline std::vector<std::byte> lampFile(const char* name = "lamp") {
  test::GltfBuilder b;
  const int material = b.append("materials", {{"emissiveFactor", {1, 1, 1}}, {"doubleSided", true}});
  const int corners = b.vec3({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  const int mesh = b.mesh({{"POSITION", corners}}, b.indices({0, 1, 2, 0, 2, 3}), material);
  b.node({{"name", name}, {"mesh", mesh}});
  return b.glb();
}

}  // namespace limn::app
