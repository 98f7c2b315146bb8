// The robot's skeleton, shared by its body and its dance.
#pragma once

#include <array>
#include <string_view>

#include "assets/generator/scene.h"

namespace limn::assets::robot {

enum Joint {
  hips,
  spine,
  chest,
  neck,
  head,
  leftClavicle,
  leftUpperArm,
  leftForearm,
  leftHand,
  rightClavicle,
  rightUpperArm,
  rightForearm,
  rightHand,
  leftThigh,
  leftShin,
  leftFoot,
  leftToes,
  rightThigh,
  rightShin,
  rightFoot,
  rightToes,
  leftEar,
  rightEar,
  jointCount
};

struct JointInfo {
  std::string_view name;
  int parent;
  glm::vec3 position;  ///< bind pose, model space: arms stretched along X, facing +Z
};

extern const std::array<JointInfo, jointCount> kSkeleton;

/// The skinned mesh, one primitive per material. Adds its materials to `scene`.
std::vector<Primitive> buildBody(Scene& scene);

/// The same body of few triangles, shared out among its materials as the full one's are.
std::vector<Primitive> buildBody(Scene& scene, std::size_t triangles);

constexpr float kLoop = 4;  ///< seconds of the dance; eight beats of half a second

/// The dance, which loops. `firstNode` is the node of joint 0; joint i is node firstNode + i.
Animation buildDance(int firstNode);

/// A skeleton at rest, and the node "robot" that shows `mesh` on it. Returns the node of joint 0, which has
/// no parent.
int addRobot(Scene& scene, int mesh);

struct Dancer {
  glm::vec2 at;  ///< x and z
  float degrees;
  int delay;      ///< keys behind the first one
  int loops = 1;  ///< of the dance in its channels, one after another
};

/// A robot that shows `mesh`, whose channels are added to `animation`. Returns the node that places it.
int addDancer(Scene& scene, int mesh, const Dancer& dancer, Animation& animation);

/// Quaternions of neighbouring keys on one hemisphere.
void untwist(Channel& channel);

}  // namespace limn::assets::robot
