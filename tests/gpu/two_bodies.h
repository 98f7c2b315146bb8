// A floor as two bodies, of which one may lie in the dark or be of another material.
#pragma once

#include <functional>
#include <vector>

#include "tests/gpu/bump_floor.h"

namespace limn {

class TwoBodiesTest : public BumpFloorTest {
 protected:
  /// The floor of 2 m x 2 m, twice: two bodies that meet at x = 0.
  static scene::Scene halves(scene::Scene scene) {
    scene.nodes.push_back(scene.nodes[0]);
    scene.nodes[0].transform.translation = {-1, 0, 0};
    scene.nodes.back().transform.translation = {1, 0, 0};
    return scene;
  }

  /// Expects each of two bodies to be beside one of another material to the bit what it is beside one of its
  /// own. `dark`: a scene whose first material is translucent, with a shadow across both; `below`
  /// draws it. Bodies have that material, one whose light gets 1/40 as far, and one whose albedo varies.
  static void expectBodiesAreTheSameBesideOthers(const scene::Scene& dark,
                                                 const std::function<Image(const scene::Scene&)>& below) {
    constexpr size_t kKinds = 3;
    const auto beside = [&](size_t left, size_t right) {
      scene::Scene scene = halves(dark);
      const auto show = [&](scene::Node& node, size_t kind) {
        scene::Material matter = scene.materials[0];
        if (kind == 1) matter.subsurface->extinction *= 40;
        matter.subsurface->albedoFromBaseColour = kind == 2;
        scene::Primitive plane = test::floorPrimitive(1, test::addMaterial(scene, matter));
        if (kind == 2) plane.colours.assign(plane.positions.size(), glm::vec4(glm::vec3(0.75f), 1));
        node.mesh = test::addMesh(scene, plane);
      };
      show(scene.nodes[0], left);
      show(scene.nodes.back(), right);
      // One more under the floor, so that programs are the same, which another one may round otherwise.
      scene::Node& hidden = scene.nodes.emplace_back();
      hidden.transform = {.translation = {0, -1, 0}};
      show(hidden, 2);
      return below(scene);
    };
    const auto half = [](const Image& picture, float side) {
      std::vector<float> values;
      forEachPoint(picture, [&](float value, const glm::vec3& p) {
        if (side * p.x > 0.02f) values.push_back(value);
      });
      return values;
    };
    std::vector<Image> alike;
    for (size_t kind = 0; kind < kKinds; ++kind) alike.push_back(beside(kind, kind));
    for (size_t left = 0; left < kKinds; ++left) {
      const size_t right = (left + 1) % kKinds;
      const Image mixed = beside(left, right);
      EXPECT_EQ(half(mixed, -1), half(alike[left], -1)) << left;
      EXPECT_EQ(half(mixed, 1), half(alike[right], 1)) << right;
    }
  }

  /// The sum over the pixels of the body at x < 0.
  static double inTheDark(const Image& picture) {
    double sum = 0;
    forEachPoint(picture, [&](float value, const glm::vec3& p) {
      if (p.x < -0.02f) sum += static_cast<double>(value);
    });
    return sum;
  }
};

}  // namespace limn
