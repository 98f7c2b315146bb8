// A lamp within a ball, whose light has the same way through a medium everywhere.
#pragma once

#include <algorithm>
#include <utility>

#include "tests/support/density_grids.h"
#include "tests/support/scene_nodes.h"

namespace limn::test {

/// A ball of radius 1 m that faces its middle, where a lamp is and the camera of foggyBallCamera(): all light
/// goes 1 m to the wall, and 1 m from there to the eye, less 0.4 % where triangles cut the ball.
inline scene::Scene foggyBall() {
  scene::Scene scene;
  scene::Primitive ball = spherePrimitive(1, addMaterial(scene, lambertian(0.5f)), 24);
  for (glm::vec3& normal : ball.normals) normal = -normal;
  std::ranges::reverse(ball.indices);
  show(scene, std::move(ball));
  shine(scene, lamp(glsl::light_point, 10), {0, 0, 0});
  return scene;
}

inline scene::CameraPose foggyBallCamera() {
  return scene::lookAt({0, 0, 0}, {0, 0, -1}, 0.8f);
}

/// Fills the ball with a medium of the extinction 1 per metre, as a grid or without.
inline void fillWithFog(scene::Scene& scene, bool grid) {
  scene.medium.sigmaA = glm::vec3(grid ? 0.2f : 0.4f);
  scene.medium.sigmaS = glm::vec3(grid ? 0.3f : 0.6f);
  if (grid) scene::setGrid(scene.medium, constantGrid(scene::evaluate(scene, 0).bounds, 2));
}

}  // namespace limn::test
