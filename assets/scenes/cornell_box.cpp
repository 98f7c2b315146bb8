// The Cornell box, 2 m a side, Lambertian, lit by one visible emissive rectangle.
#include "assets/generator/shapes.h"
#include "assets/scenes/cornell_room.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

/// A block of the given footprint, turned about the vertical.
Mesh block(glm::vec3 halfSize, float degrees, glm::vec2 at) {
  return transformed(box({0, halfSize.y, 0}, halfSize),
                     translation({at.x, 0, at.y}) * rotation(degrees, {0, 1, 0}));
}

}  // namespace

int addCornellRoom(Scene& scene) {
  const int white = scene.addMaterial(lambert("white", {0.73f, 0.72f, 0.68f}));
  const int red = scene.addMaterial(lambert("red", {0.6f, 0.06f, 0.045f}));
  const int green = scene.addMaterial(lambert("green", {0.12f, 0.45f, 0.09f}));
  Mesh room = quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1});
  append(room, quad({0, 2, 0}, {1, 0, 0}, {0, 0, 1}));
  append(room, quad({0, 1, -1}, {1, 0, 0}, {0, 1, 0}));
  scene.add("room", std::move(room), white);
  scene.add("left_wall", quad({-1, 1, 0}, {0, 0, -1}, {0, 1, 0}), red);
  scene.add("right_wall", quad({1, 1, 0}, {0, 0, 1}, {0, 1, 0}), green);
  return white;
}

void addCornellCameras(Scene& scene) {
  // A little off the axis: on it, edges of the walls pass exactly through pixel centres, where coverage is a
  // tie.
  scene.addCamera("main", {0.0043f, 1.0031f, 3.9f}, {0, 1, 0}, 39);
  scene.addCamera("close", {0.55f, 0.9f, 1.6f}, {0, 0.35f, -0.1f}, 45);
}

Scene makeCornellBox() {
  Scene scene;
  const int white = addCornellRoom(scene);
  Material lamp = lambert("lamp", {0, 0, 0});
  lamp.emissive = {1, 0.8f, 0.55f};
  lamp.emissiveStrength = 24;
  scene.add("tall_block", block({0.3f, 0.6f, 0.3f}, 17, {-0.34f, -0.3f}), white);
  scene.add("short_block", block({0.3f, 0.3f, 0.3f}, -17, {0.33f, 0.35f}), white);
  scene.add("key", quad({0, 1.98f, 0}, {0.24f, 0, 0}, {0, 0, 0.19f}), scene.addMaterial(lamp));
  addCornellCameras(scene);
  return scene;
}

}  // namespace limn::assets
