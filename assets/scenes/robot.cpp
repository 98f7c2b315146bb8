// A robot that dances: skeleton, inverse kinematics for feet that stay on the floor, and the scene around it.
#include "assets/scenes/robot.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "assets/generator/shapes.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace robot {
namespace {

constexpr int kKeys = 96;

glm::quat turn(float radians, glm::vec3 axis) {
  return glm::angleAxis(radians, axis);
}
const glm::vec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

struct Pose {
  glm::vec3 hipsPosition;
  std::array<glm::quat, jointCount> rotation;
};

/// The rotation that takes -Y to `down`, with the knee's axis across `forward`.
glm::quat legRotation(glm::vec3 down, glm::vec3 forward) {
  const glm::vec3 y = -glm::normalize(down), x = glm::normalize(glm::cross(y, forward));
  return glm::quat_cast(glm::mat3(x, y, glm::cross(x, y)));
}

/// Two-bone inverse kinematics: puts the ankle at `ankle`, the knee bends towards `forward`.
void poseLeg(Pose& pose, bool left, glm::vec3 ankle, glm::quat footRotation, float toeLift) {
  const Joint thigh = left ? leftThigh : rightThigh, shin = left ? leftShin : rightShin;
  const Joint foot = left ? leftFoot : rightFoot, toes = left ? leftToes : rightToes;
  const glm::quat base = pose.rotation[hips];
  const glm::vec3 hip = pose.hipsPosition + base * (kSkeleton[thigh].position - kSkeleton[hips].position);
  const float upper = glm::distance(kSkeleton[thigh].position, kSkeleton[shin].position);
  const float lower = glm::distance(kSkeleton[shin].position, kSkeleton[foot].position);
  const glm::vec3 toAnkle = ankle - hip;
  const float reach = std::min(glm::length(toAnkle), 0.998f * (upper + lower));
  const glm::vec3 line = glm::normalize(toAnkle);
  const glm::vec3 forward = footRotation * kZ;
  const glm::vec3 bend = glm::normalize(forward - line * glm::dot(line, forward));
  const float along = (upper * upper - lower * lower + reach * reach) / (2 * reach);
  const glm::vec3 knee = hip + along * line + std::sqrt(std::max(upper * upper - along * along, 0.0f)) * bend;
  const glm::quat thighWorld = legRotation(knee - hip, bend),
                  shinWorld = legRotation(hip + reach * line - knee, bend);
  pose.rotation[thigh] = glm::inverse(base) * thighWorld;
  pose.rotation[shin] = glm::inverse(thighWorld) * shinWorld;
  pose.rotation[foot] = glm::inverse(shinWorld) * footRotation;
  pose.rotation[toes] = turn(-toeLift, kX);
}

/// `raise`: elevation above the horizontal, `swing`: forward, `elbow`: bend, all radians.
void poseArm(Pose& pose, bool left, float raise, float swing, float elbow, float twist) {
  const float side = left ? 1.0f : -1.0f;
  pose.rotation[left ? leftClavicle : rightClavicle] = turn(0.25f * side * raise, kZ);
  pose.rotation[left ? leftUpperArm : rightUpperArm] =
      turn(-side * swing, kY) * turn(0.75f * side * raise, kZ) * turn(twist, kX);
  pose.rotation[left ? leftForearm : rightForearm] = turn(-side * elbow, kY);
  pose.rotation[left ? leftHand : rightHand] = turn(0.35f * side * std::sin(2 * elbow), kZ);
}

/// The choreography: sway over four beats, bounce on each, arms in a wave, a kick to the free side.
Pose danceAt(float time) {
  const float p = 2 * glm::pi<float>() * time / kLoop, sway = std::sin(2 * p), beat = std::cos(8 * p);
  Pose pose;
  pose.rotation.fill(glm::quat(1, 0, 0, 0));
  pose.hipsPosition = {0.085f * sway, 0.852f - 0.028f * beat, 0.02f * std::sin(4 * p)};
  pose.rotation[hips] = turn(0.3f * sway, kY) * turn(-0.09f * sway, kZ) * turn(0.05f, kX);
  pose.rotation[spine] = turn(-0.18f * sway, kY) * turn(0.13f * sway, kZ) * turn(0.05f * beat, kX);
  pose.rotation[chest] = turn(-0.3f * sway, kY) * turn(0.12f * sway + 0.05f * std::sin(4 * p), kZ);
  pose.rotation[neck] = turn(0.1f * std::sin(p), kY) * turn(-0.08f * sway, kZ);
  pose.rotation[head] = turn(0.3f * std::sin(p), kY) * turn(0.1f * beat, kX) * turn(-0.14f * sway, kZ);
  pose.rotation[leftEar] = turn(0.25f * std::sin(8 * p), kX);
  pose.rotation[rightEar] = turn(0.25f * std::sin(8 * p + 0.6f), kX);
  poseArm(pose, true, -0.25f + 0.95f * std::sin(2 * p + 0.4f), 0.35f + 0.25f * std::cos(4 * p),
          0.95f + 0.55f * std::sin(4 * p), -0.9f);
  poseArm(pose, false, -0.25f - 0.95f * std::sin(2 * p + 0.4f), 0.35f - 0.25f * std::cos(4 * p),
          0.95f - 0.55f * std::sin(4 * p), -0.9f);
  for (const float side : {1.0f, -1.0f}) {
    const float lift = glm::smoothstep(0.25f, 0.95f, -side * sway);
    const glm::vec3 ankle(side * (0.17f + 0.1f * lift), 0.1f + 0.13f * lift, 0.1f * lift);
    poseLeg(pose, side > 0, ankle, turn(side * 0.3f, kY) * turn(0.35f * lift, kX), 0.3f * lift);
  }
  return pose;
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

/// The loop several times.
void repeat(Channel& channel, int loops) {
  const auto again = [](auto& values, std::size_t keys, auto&& moved) {
    if (values.empty()) return;
    for (std::size_t k = 1; k < keys; ++k) values.push_back(moved(values[k]));
  };
  const std::size_t keys = channel.times.size();
  const auto same = [](const auto& value) { return value; };
  for (int loop = 1; loop < loops; ++loop) {
    again(channel.times, keys, [=](float time) { return time + kLoop * static_cast<float>(loop); });
    again(channel.rotations, keys, same);
    again(channel.translations, keys, same);
  }
}

}  // namespace

Animation buildDance(int firstNode) {
  Animation animation{"dance", {}};
  std::vector<float> times;
  for (int k = 0; k <= kKeys; ++k) times.push_back(kLoop * static_cast<float>(k) / kKeys);
  for (int joint = 0; joint < jointCount; ++joint) {
    Channel channel{firstNode + joint, times, {}, {}};
    for (int k = 0; k <= kKeys; ++k) {
      // The last key repeats the first one exactly; quaternions keep to one hemisphere.
      glm::quat q = glm::normalize(
          danceAt(times[static_cast<std::size_t>(k % kKeys)]).rotation[static_cast<std::size_t>(joint)]);
      if (k > 0 && glm::dot(q, channel.rotations.back()) < 0) q = -q;
      channel.rotations.push_back(q);
    }
    animation.channels.push_back(std::move(channel));
  }
  Channel move{firstNode, times, {}, {}};
  for (int k = 0; k <= kKeys; ++k)
    move.translations.push_back(danceAt(times[static_cast<std::size_t>(k % kKeys)]).hipsPosition);
  animation.channels.push_back(std::move(move));
  return animation;
}

int addRobot(Scene& scene, int mesh) {
  const int first = static_cast<int>(scene.nodes.size());
  Skin skin;
  for (const JointInfo& joint : kSkeleton) {
    const glm::vec3 parent =
        joint.parent < 0 ? glm::vec3(0) : kSkeleton[static_cast<std::size_t>(joint.parent)].position;
    const int node = scene.addNode({.name = std::string(joint.name), .translation = joint.position - parent});
    if (joint.parent >= 0)
      scene.nodes[static_cast<std::size_t>(first + joint.parent)].children.push_back(node);
    skin.joints.push_back(node);
    skin.inverseBind.push_back(translation(-joint.position));
  }
  scene.skins.push_back(std::move(skin));
  scene.addNode({.name = "robot", .mesh = mesh, .skin = static_cast<int>(scene.skins.size()) - 1});
  return first;
}

void untwist(Channel& channel) {
  for (std::size_t k = 1; k < channel.rotations.size(); ++k)
    if (glm::dot(channel.rotations[k], channel.rotations[k - 1]) < 0)
      channel.rotations[k] = -channel.rotations[k];
}

int addDancer(Scene& scene, int mesh, const Dancer& dancer, Animation& animation) {
  const int first = addRobot(scene, mesh);
  const int place = scene.addNode({.name = "place",
                                   .translation = {dancer.at.x, 0, dancer.at.y},
                                   .rotation = turn(glm::radians(dancer.degrees), kY),
                                   .children = {first}});
  for (Channel& channel : buildDance(first).channels) {
    delay(channel, dancer.delay);
    repeat(channel, dancer.loops);
    untwist(channel);
    animation.channels.push_back(std::move(channel));
  }
  return place;
}

}  // namespace robot

Scene makeRobot() {
  using namespace robot;
  Scene scene;
  Material floor = glossy("floor", {1, 1, 1}, 0.75f);
  floor.baseColourTexture = scene.addTexture(
      "tiles", tileImage(512, 4, {0.5f, 0.52f, 0.55f}, {0.3f, 0.34f, 0.4f}, {0.16f, 0.17f, 0.18f}));
  floor.normalTexture = scene.addTexture("tiles_normal", tileNormalImage(512, 4), true);
  Mesh stage = backdrop(9, 3.5f, 2.4f, 4, 1.6f);
  computeTangents(stage);
  scene.add("floor", std::move(stage), scene.addMaterial(floor));

  const int first = addRobot(scene, scene.addMesh("robot", buildBody(scene)));
  scene.animations.push_back(buildDance(first));

  scene.addAreaLight("key", {-2.0f, 3.4f, 2.2f}, {0, 0.9f, 0}, {0.8f, 0.8f}, 48, {1, 0.96f, 0.9f}, 52);
  scene.addCamera("main", {0.8f, 1.35f, 4.1f}, {0, 0.88f, 0}, 34);
  scene.addCamera("close", {0.5f, 1.6f, 1.7f}, {0, 1.4f, 0}, 36);
  scene.addCamera("low", {-1.6f, 0.35f, 2.6f}, {0, 0.85f, 0}, 40);
  return scene;
}

}  // namespace limn::assets
