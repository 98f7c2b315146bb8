// Melting balls in a Cornell box, another topology in every frame; a spot light shines up at the ceiling past
// them.
#include "assets/scenes/cornell_room.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {

Scene makeMetaballs() {
  Scene scene;
  addCornellRoom(scene);
  const int wax = scene.addMaterial(glossy("wax", {0.8f, 0.76f, 0.7f}, 0.55f));
  scene.addNode(
      {.name = "metaballs",
       .translation = {0, 0.9f, -0.05f},
       .metaballs = Metaballs{.count = 9, .resolution = 21, .radius = 0.27f, .seed = 5, .material = wax},
       .scale = glm::vec3(0.85f)});
  const Light spot{.type = Light::Type::spot,
                   .colour = {1, 0.9f, 0.75f},
                   .intensity = 34,
                   .innerConeAngle = glm::radians(14.0f),
                   .outerConeAngle = glm::radians(24.0f)};
  scene.addLight("key", spot, {-0.93f, 0.1f, 0.93f}, {-0.6f, 2, 0.55f});
  addCornellCameras(scene);
  return scene;
}

}  // namespace limn::assets
