// Robots dancing in the courtyard at night, lit by a spot light that sways.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "assets/scenes/atrium.h"
#include "assets/scenes/robot.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

constexpr float kAtriumShare = 0.18f;
constexpr std::size_t kRobotTriangles = 5000;

constexpr robot::Dancer kDancers[] = {{{-3.1f, 0.9f}, 70, 0},
                                      {{-2.2f, -1.5f}, 40, 20},
                                      {{-0.4f, 1.9f}, 120, 52},
                                      {{2.3f, 1.3f}, -70, 36},
                                      {{2.6f, -1.4f}, -40, 68}};

/// The beam goes round over the floor once in the four seconds of the dance.
Channel circling(int node, glm::vec3 from) {
  constexpr int keys = 48;
  Channel channel{node, {}, {}, {}};
  for (int k = 0; k <= keys; ++k) {
    const float phase = 2 * glm::pi<float>() * static_cast<float>(k % keys) / keys;
    channel.times.push_back(robot::kLoop * static_cast<float>(k) / keys);
    const glm::vec3 target(0.2f + 2.2f * std::cos(phase), 0, -0.2f + 1.1f * std::sin(phase));
    channel.rotations.push_back(facing(target - from));
  }
  robot::untwist(channel);
  return channel;
}

}  // namespace

Scene makeAtriumRobots() {
  Scene scene;
  addAtrium(scene, kAtriumShare);
  const int mesh = scene.addMesh("robot", robot::buildBody(scene, kRobotTriangles));
  Animation animation{"dance", {}};
  for (const robot::Dancer& dancer : kDancers) robot::addDancer(scene, mesh, dancer, animation);
  const Light spot{.type = Light::Type::spot,
                   .colour = {1, 0.88f, 0.7f},
                   .intensity = 420,
                   .innerConeAngle = glm::radians(16.0f),
                   .outerConeAngle = glm::radians(27.0f)};
  const glm::vec3 from(-4.6f, 7.4f, 2.0f);
  scene.addLight("key", spot, from, {2, 0, 0});
  animation.channels.push_back(circling(static_cast<int>(scene.nodes.size()) - 1, from));
  scene.animations.push_back(std::move(animation));
  scene.addCamera("main", {-5.5f, 2.3f, 2.2f}, {0.7f, 1.25f, -0.6f}, 55);
  scene.addCamera("close", {-4.6f, 1.7f, -0.9f}, {-2.2f, 1.1f, 0.2f}, 50);
  scene.addCamera("upper", {-7.5f, 6.3f, 0.3f}, {2, 1.6f, -0.7f}, 58);
  return scene;
}

}  // namespace limn::assets
