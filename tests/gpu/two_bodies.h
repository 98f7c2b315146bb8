// A floor as two bodies, of which one lies in the dark.
#pragma once

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
