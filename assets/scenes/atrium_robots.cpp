// Robots dancing in the courtyard at night, lit by a spot light that sways.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "assets/generator/simplify.h"
#include "assets/scenes/atrium.h"
#include "assets/scenes/robot.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

constexpr float kAtriumShare = 0.18f;
constexpr std::size_t kRobotTriangles = 5000;

struct Dancer {
  glm::vec2 at;  ///< x and z
  float degrees;
  int delay;  ///< keys behind the first one
};

constexpr Dancer kDancers[] = {{{-3.1f, 0.9f}, 70, 0},
                               {{-2.2f, -1.5f}, 40, 20},
                               {{-0.4f, 1.9f}, 120, 52},
                               {{2.3f, 1.3f}, -70, 36},
                               {{2.6f, -1.4f}, -40, 68}};

/// A body of few triangles, shared out among its materials as the full one's are.
int addBody(Scene& scene) {
  std::vector<Primitive> primitives = robot::buildBody(scene);
  std::size_t all = 0;
  for (const Primitive& p : primitives) all += p.mesh.triangleCount();
  for (Primitive& p : primitives)
    p.mesh = creased(simplified(welded(p.mesh), kRobotTriangles * p.mesh.triangleCount() / all), 42);
  return scene.addMesh("robot", std::move(primitives));
}

/// The same loop, begun later. The last key repeats the first.
void delay(Channel& channel, int keys) {
  const auto shift = [keys](auto& values) {
    if (values.empty()) return;
    values.pop_back();
    std::rotate(values.begin(), values.begin() + keys % static_cast<int>(values.size()), values.end());
    values.push_back(values.front());
  };
  shift(channel.rotations);
  shift(channel.translations);
}

/// Quaternions of neighbouring keys on one hemisphere.
void untwist(Channel& channel) {
  for (std::size_t k = 1; k < channel.rotations.size(); ++k)
    if (glm::dot(channel.rotations[k], channel.rotations[k - 1]) < 0)
      channel.rotations[k] = -channel.rotations[k];
}

void addDancer(Scene& scene, int mesh, const Dancer& dancer, Animation& animation) {
  const int first = robot::addRobot(scene, mesh);
  scene.addNode({.name = "place",
                 .translation = {dancer.at.x, 0, dancer.at.y},
                 .rotation = glm::angleAxis(glm::radians(dancer.degrees), glm::vec3(0, 1, 0)),
                 .children = {first}});
  for (Channel& channel : robot::buildDance(first).channels) {
    delay(channel, dancer.delay);
    untwist(channel);
    animation.channels.push_back(std::move(channel));
  }
}

/// The beam goes round over the floor once in the four seconds of the dance.
Channel circling(int node, glm::vec3 from) {
  constexpr int keys = 48;
  Channel channel{node, {}, {}, {}};
  for (int k = 0; k <= keys; ++k) {
    const float phase = 2 * glm::pi<float>() * static_cast<float>(k % keys) / keys;
    channel.times.push_back(4 * static_cast<float>(k) / keys);
    const glm::vec3 target(0.2f + 2.2f * std::cos(phase), 0, -0.2f + 1.1f * std::sin(phase));
    channel.rotations.push_back(facing(target - from));
  }
  untwist(channel);
  return channel;
}

}  // namespace

Scene makeAtriumRobots() {
  Scene scene;
  addAtrium(scene, kAtriumShare);
  const int mesh = addBody(scene);
  Animation animation{"dance", {}};
  for (const Dancer& dancer : kDancers) addDancer(scene, mesh, dancer, animation);
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
