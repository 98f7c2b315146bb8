// A horse turning in a Cornell box that a moving spot light lights over its walls.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "assets/scenes/cornell_room.h"
#include "assets/scenes/horse.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

constexpr float kLoop = 8;  ///< seconds
constexpr int kKeys = 96;

float keyTime(int k) {
  return kLoop * static_cast<float>(k) / kKeys;
}

/// One turn about the vertical, starting with the head towards the right and a little to the camera.
Channel turning(int node) {
  Channel channel{node, {}, {}, {}};
  for (int k = 0; k <= kKeys; ++k) {
    channel.times.push_back(keyTime(k));
    const float turn = 2 * glm::pi<float>() * static_cast<float>(k) / kKeys;
    channel.rotations.push_back(glm::angleAxis(turn - 0.5f, glm::vec3(0, 1, 0)));
  }
  return channel;
}

/// The light's beam sways from the corner of the red wall over the back to that of the green one and back,
/// twice in a loop.
Channel swaying(int node) {
  Channel channel{node, {}, {}, {}};
  for (int k = 0; k <= kKeys; ++k) {
    channel.times.push_back(keyTime(k));
    const float phase = 4 * glm::pi<float>() * static_cast<float>(k % kKeys) / kKeys + 0.9f;
    const float azimuth = 0.8f * std::cos(phase);  // from -z, positive to the left
    channel.rotations.push_back(
        facing({-std::sin(azimuth), -0.5f - 0.1f * std::cos(2 * phase), -std::cos(azimuth)}));
  }
  return channel;
}

}  // namespace

Scene makeCornellHorse() {
  Scene scene;
  addCornellRoom(scene);
  const int plaster = scene.addMaterial(lambert("plaster", {0.78f, 0.74f, 0.66f}));
  // Turned about the middle of its trunk.
  const int node = scene.add(
      "horse", transformed(horse(17000), scaling(glm::vec3(0.56f)) * translation({-0.1f, 0, 0})), plaster);
  const Light spot{.type = Light::Type::spot,
                   .colour = {1, 0.9f, 0.75f},
                   .intensity = 28,
                   .innerConeAngle = glm::radians(20.0f),
                   .outerConeAngle = glm::radians(32.0f)};
  scene.addLight("key", spot, {0, 1.9f, 0.35f}, {-1, 1.2f, 0});
  const int light = static_cast<int>(scene.nodes.size()) - 1;
  scene.animations.push_back({"turn", {turning(node), swaying(light)}});
  addCornellCameras(scene);
  return scene;
}

}  // namespace limn::assets
