// A lamp that an animation makes none for a while, and one that stands still behind it.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "tests/support/gltf_builder.h"

namespace limn::test {

/// Adds glowing squares of 4 x 2 m that face +Z below a node that stretches: "lamp" at z = 2 turns by 45
/// degrees in a second and is skewed on the way, no rectangle and so no light. With `another`, "chosen" at z
/// = 3 follows.
inline void addSkewedLamp(GltfBuilder& b, bool another) {
  using json = GltfBuilder::json;
  const int glow = b.append("materials", {{"emissiveFactor", {1, 1, 1}}, {"doubleSided", true}});
  const int corners = b.vec3({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  const int quad = b.mesh({{"POSITION", corners}}, b.indices({0, 1, 2, 0, 2, 3}), glow);
  const int holder = b.node({{"scale", {2, 1, 1}}});
  const int lamp = b.node({{"name", "lamp"}, {"mesh", quad}, {"translation", {0, 0, 2}}});
  json children = json::array({lamp});
  if (another) children.push_back(b.node({{"name", "chosen"}, {"mesh", quad}, {"translation", {0, 0, 3}}}));
  b.root["nodes"][static_cast<size_t>(holder)]["children"] = children;
  const float angle = glm::radians(22.5f);  // half of how far it turns
  const int times = b.floats({0, 1}),
            turns = b.vec4({{0, 0, 0, 1}, {0, 0, std::sin(angle), std::cos(angle)}});
  b.append(
      "animations",
      {{"samplers", json::array({{{"input", times}, {"output", turns}}})},
       {"channels", json::array({{{"sampler", 0}, {"target", {{"node", lamp}, {"path", "rotation"}}}}})}});
}

}  // namespace limn::test
