// A phalanx: one soldier, a hundred instances, about ten million triangles.
#include "assets/generator/random.h"
#include "assets/generator/shapes.h"
#include "assets/scenes/scenes.h"
#include "assets/scenes/soldier.h"

namespace limn::assets {

Scene makeSoldiers() {
  Scene scene;
  Material earth = lambert("earth", {1, 1, 1});
  earth.baseColourTexture = scene.addTexture("earth", plasterImage(512, {0.4f, 0.31f, 0.21f}, 0.6f));
  scene.add("floor", backdrop(40, 26, 16, 14, 5), scene.addMaterial(earth));

  Node phalanx{.name = "soldiers"};
  phalanx.mesh = scene.addMesh("soldier", soldier::build(scene));
  Random random(23);
  for (int row = 0; row < 10; ++row) {
    for (int file = 0; file < 10; ++file) {
      const glm::vec3 at(1.45f * (static_cast<float>(file) - 4.5f) + random.uniform(-0.1f, 0.1f), 0,
                         -1.75f * (static_cast<float>(row) - 4.5f) + random.uniform(-0.15f, 0.15f));
      const glm::quat turn = glm::angleAxis(glm::radians(random.uniform(-8, 8)), glm::vec3(0, 1, 0));
      phalanx.instances.push_back({at, turn, glm::vec3(random.uniform(0.95f, 1.05f))});
    }
  }
  scene.addNode(std::move(phalanx));

  scene.addAreaLight("key", {-11, 13, 12}, {0, 0.8f, 0.5f}, {3, 3}, 2100, {1, 0.93f, 0.82f}, 52);
  scene.addCamera("main", {5.2f, 5.4f, 14.2f}, {0.3f, 0.7f, 1.2f}, 40);
  scene.addCamera("close", {-0.5f, 1.75f, 11.6f}, {0.75f, 1.25f, 7.6f}, 38);
  scene.addCamera("above", {0, 17, 10}, {0, 0, 0.5f}, 50);
  return scene;
}

}  // namespace limn::assets
