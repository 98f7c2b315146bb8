// The robot's body: rigid shells, and ribbed rubber sleeves whose weights blend across the joints.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "assets/generator/shapes.h"
#include "assets/generator/simplify.h"
#include "assets/scenes/robot.h"

namespace limn::assets::robot {
namespace {

using Profile = std::vector<glm::vec2>;

float signedPower(float x, float e) {
  return std::copysign(std::pow(std::abs(x), e), x);
}

/// A box-like ellipsoid; exponents below 1 make it squarer. `taper` widens the top.
Mesh superellipsoid(glm::vec3 radii, float squareVertical, float squareHorizontal, float taper = 0,
                    int rings = 28) {
  return surface(2 * rings, rings, [=](glm::vec2 uv) {
    const float a = 2 * glm::pi<float>() * uv.x, b = glm::pi<float>() * (uv.y - 0.5f);
    const float c = std::pow(std::max(std::cos(b), 0.0f), squareVertical),
                y = signedPower(std::sin(b), squareVertical);
    const float wide = 1 + taper * y;
    return glm::vec3(radii.x * wide * c * signedPower(std::cos(a), squareHorizontal), radii.y * y,
                     -radii.z * wide * c * signedPower(std::sin(a), squareHorizontal));
  });
}

/// A closed, ribbed sleeve from height 0 to `length` with `ribs` ribs of `depth`.
Mesh sleeve(float bottom, float top, float length, int ribs, float depth) {
  Profile profile = {{0, 0}};  // closed at both ends
  const int steps = ribs * 6;
  for (int i = 0; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    const float rib = 0.5f - 0.5f * std::cos(2 * glm::pi<float>() * t * static_cast<float>(ribs));
    profile.emplace_back(glm::mix(bottom, top, t) + depth * (rib - 0.5f), t * length);
  }
  profile.emplace_back(0, length);
  return lathe(profile, 32, 80);
}

class Body {
 public:
  enum Part { shell, rubber, accent, visor, eyes, partCount };

  std::array<Mesh, partCount> parts;

  void rigid(Part part, Mesh mesh, const glm::mat4& at, Joint joint) {
    mesh = transformed(mesh, at);
    bindToJoint(mesh, joint);
    append(parts[part], mesh);
  }

  /// Weights go from `first` to `second` along the line from `from` to `to`.
  void blended(Part part, Mesh mesh, const glm::mat4& at, Joint first, Joint second, glm::vec3 from,
               glm::vec3 to) {
    mesh = transformed(mesh, at);
    const glm::vec3 axis = to - from;
    bindToJoints(mesh, first, second, [&](glm::vec3 p) {
      return glm::smoothstep(0.0f, 1.0f, glm::dot(p - from, axis) / glm::dot(axis, axis));
    });
    append(parts[part], mesh);
  }
};

void buildTrunk(Body& body) {
  body.rigid(Body::shell, superellipsoid({0.165f, 0.095f, 0.125f}, 0.8f, 0.75f, 0.12f),
             translation({0, 0.925f, 0}), hips);
  body.rigid(Body::accent, torus(0.132f, 0.014f, 64, 16),
             translation({0, 1.0f, 0}) * scaling({1.05f, 1, 0.8f}), hips);
  // The waist bends twice: hips to spine, spine to chest.
  const glm::mat4 flat = scaling({1.1f, 1, 0.82f});
  body.blended(Body::rubber, sleeve(0.115f, 0.11f, 0.09f, 4, 0.016f), translation({0, 0.985f, 0}) * flat,
               hips, spine, {0, 0.985f, 0}, {0, 1.075f, 0});
  body.blended(Body::rubber, sleeve(0.11f, 0.125f, 0.09f, 4, 0.016f), translation({0, 1.075f, 0}) * flat,
               spine, chest, {0, 1.075f, 0}, {0, 1.165f, 0});
  body.rigid(Body::shell, superellipsoid({0.2f, 0.18f, 0.145f}, 0.7f, 0.75f, 0.2f, 40),
             translation({0, 1.31f, 0}), chest);
  body.rigid(Body::accent, torus(0.066f, 0.012f, 64, 16),
             translation({0, 1.33f, 0.152f}) * rotation(84, {1, 0, 0}), chest);
  body.rigid(Body::visor, superellipsoid({0.06f, 0.02f, 0.06f}, 1, 1),
             translation({0, 1.33f, 0.148f}) * rotation(84, {1, 0, 0}), chest);
  for (int i = 0; i < 3; ++i) {
    body.rigid(
        Body::eyes, roundedBox({0.028f - 0.006f * static_cast<float>(i), 0.005f, 0.006f}, 0.0045f, 3),
        translation({0, 1.355f - 0.024f * static_cast<float>(i), 0.17f + 0.002f * static_cast<float>(i)}),
        chest);
  }
  // Back pack with two vents.
  body.rigid(Body::shell, roundedBox({0.11f, 0.12f, 0.05f}, 0.04f, 8), translation({0, 1.31f, -0.15f}),
             chest);
  for (const float x : {-0.05f, 0.05f})
    body.rigid(Body::rubber, sleeve(0.03f, 0.026f, 0.06f, 3, 0.008f), translation({x, 1.41f, -0.16f}), chest);
}

void buildHead(Body& body) {
  body.blended(Body::rubber, sleeve(0.062f, 0.055f, 0.1f, 5, 0.012f), translation({0, 1.465f, 0}), chest,
               neck, {0, 1.465f, 0}, {0, 1.52f, 0});
  body.rigid(Body::accent, torus(0.068f, 0.012f, 48, 14), translation({0, 1.478f, 0}), chest);
  body.rigid(Body::shell, superellipsoid({0.168f, 0.128f, 0.14f}, 0.75f, 0.8f, 0, 40),
             translation({0, 1.665f, 0}), head);
  body.rigid(Body::visor, superellipsoid({0.138f, 0.085f, 0.06f}, 0.6f, 0.75f, 0, 36),
             translation({0, 1.66f, 0.093f}), head);
  for (const float side : {-1.0f, 1.0f}) {
    const Joint ear = side > 0 ? leftEar : rightEar;
    body.rigid(Body::eyes, superellipsoid({0.026f, 0.034f, 0.012f}, 1, 1, 0, 16),
               translation({side * 0.055f, 1.668f, 0.147f}), head);
    const Profile disc = {{0, 0},           {0.056f, 0},      {0.062f, 0.008f},
                          {0.056f, 0.024f}, {0.04f, 0.028f},  {0.034f, 0.02f},
                          {0.022f, 0.02f},  {0.016f, 0.034f}, {0, 0.036f}};
    body.rigid(Body::accent, lathe(disc, 40),
               translation({side * 0.158f, 1.66f, 0}) * rotation(-90 * side, {0, 0, 1}), head);
    const glm::vec3 rod[] = {
        {side * 0.175f, 1.68f, 0}, {side * 0.19f, 1.76f, -0.005f}, {side * 0.205f, 1.85f, -0.02f}};
    const float radii[] = {0.008f, 0.006f, 0.005f};
    body.rigid(Body::rubber,
               tube(spline(std::span<const glm::vec3>(rod), 6), std::vector<float>(13, radii[1]), 14),
               glm::mat4(1), ear);
    body.rigid(Body::accent, sphere(0.017f, 14), translation({side * 0.206f, 1.857f, -0.021f}), ear);
  }
  body.rigid(Body::accent, torus(0.1f, 0.012f, 48, 12),
             translation({0, 1.79f, -0.005f}) * scaling({0.6f, 0.6f, 1}), head);
}

void buildFingers(Body& body, const glm::mat4& wrist, Joint hand) {
  body.rigid(Body::shell, superellipsoid({0.04f, 0.05f, 0.026f}, 0.8f, 0.8f, 0.1f, 16),
             wrist * translation({0, 0.055f, 0}), hand);
  for (int i = 0; i < 3; ++i) {
    const float x = 0.026f * static_cast<float>(i - 1);
    const glm::mat4 root = wrist * translation({x, 0.095f, 0}) *
                           rotation(-12.0f * static_cast<float>(i - 1), {0, 0, 1}) * rotation(12, {1, 0, 0});
    body.rigid(Body::rubber, capsule(0.0135f, 0.0125f, 0.04f, 9), root, hand);
    body.rigid(Body::shell, capsule(0.0145f, 0.011f, 0.035f, 9),
               root * translation({0, 0.042f, 0}) * rotation(18, {1, 0, 0}), hand);
  }
  const glm::mat4 thumb =
      wrist * translation({0.035f, 0.045f, 0.012f}) * rotation(-48, {0, 0, 1}) * rotation(20, {1, 0, 0});
  body.rigid(Body::rubber, capsule(0.0145f, 0.0135f, 0.035f, 9), thumb, hand);
  body.rigid(Body::shell, capsule(0.015f, 0.0115f, 0.03f, 9),
             thumb * translation({0, 0.038f, 0}) * rotation(20, {0, 0, 1}), hand);
}

void buildArm(Body& body, float side) {
  const bool left = side > 0;
  const Joint clavicle = left ? leftClavicle : rightClavicle, upper = left ? leftUpperArm : rightUpperArm;
  const Joint fore = left ? leftForearm : rightForearm, hand = left ? leftHand : rightHand;
  // Shapes are made along +Y and laid along the arm.
  const auto along = [&](float x) {
    return translation({side * x, 1.4f, 0}) * rotation(-90 * side, {0, 0, 1});
  };
  const auto at = [&](float x) { return glm::vec3(side * x, 1.4f, 0); };
  body.blended(Body::rubber, sleeve(0.07f, 0.062f, 0.1f, 4, 0.014f), along(0.17f), clavicle, upper, at(0.19f),
               at(0.26f));
  const Profile pad = {{0.0f, 0.068f},   {0.03f, 0.068f},  {0.062f, 0.05f}, {0.078f, 0.02f},
                       {0.08f, -0.012f}, {0.074f, -0.02f}, {0.07f, -0.012f}};
  Profile padUp(pad.rbegin(), pad.rend());
  body.rigid(Body::shell, lathe(spline(std::span<const glm::vec2>(padUp), 5), 48), along(0.255f), upper);
  const Profile upperArm = {{0.036f, 0},      {0.05f, 0.004f}, {0.054f, 0.02f},  {0.054f, 0.06f},
                            {0.05f, 0.064f},  {0.05f, 0.07f},  {0.054f, 0.074f}, {0.05f, 0.13f},
                            {0.046f, 0.136f}, {0.036f, 0.138f}};
  body.rigid(Body::shell, lathe(upperArm, 48), along(0.315f), upper);
  body.blended(Body::rubber, sleeve(0.043f, 0.043f, 0.16f, 9, 0.011f), along(0.445f), upper, fore, at(0.475f),
               at(0.585f));
  const Profile forearm = {{0.036f, 0},      {0.048f, 0.003f}, {0.053f, 0.015f}, {0.064f, 0.075f},
                           {0.066f, 0.12f},  {0.061f, 0.126f}, {0.061f, 0.134f}, {0.067f, 0.14f},
                           {0.066f, 0.175f}, {0.058f, 0.182f}, {0.045f, 0.176f}, {0.03f, 0.155f}};
  body.rigid(Body::shell, lathe(forearm, 48), along(0.595f), fore);
  body.rigid(Body::accent, torus(0.0615f, 0.008f, 48, 12), along(0.725f), fore);
  body.blended(Body::rubber, sleeve(0.032f, 0.03f, 0.06f, 4, 0.008f), along(0.755f), fore, hand, at(0.765f),
               at(0.805f));
  buildFingers(body, along(0.8f) * rotation(90 * side, {0, 1, 0}), hand);
}

void buildLeg(Body& body, float side) {
  const bool left = side > 0;
  const Joint thigh = left ? leftThigh : rightThigh, shin = left ? leftShin : rightShin;
  const Joint foot = left ? leftFoot : rightFoot, toes = left ? leftToes : rightToes;
  const float x = side * 0.115f;
  const auto up = [&](float y) { return translation({x, y, 0}); };
  body.blended(Body::rubber, sleeve(0.066f, 0.074f, 0.12f, 5, 0.014f), up(0.8f), thigh, hips, {x, 0.82f, 0},
               {x, 0.9f, 0});
  const Profile thighShell = {{0.05f, 0.575f},  {0.062f, 0.572f}, {0.068f, 0.585f}, {0.078f, 0.69f},
                              {0.073f, 0.696f}, {0.073f, 0.705f}, {0.079f, 0.711f}, {0.082f, 0.79f},
                              {0.074f, 0.812f}, {0.055f, 0.815f}};
  body.rigid(Body::shell, lathe(thighShell, 48), translation({x, 0, 0}), thigh);
  body.blended(Body::rubber, sleeve(0.054f, 0.056f, 0.18f, 9, 0.013f), up(0.41f), shin, thigh, {x, 0.44f, 0},
               {x, 0.56f, 0});
  body.blended(Body::accent, superellipsoid({0.048f, 0.06f, 0.03f}, 0.8f, 0.9f, 0, 18),
               translation({x, 0.505f, 0.052f}), shin, thigh, {x, 0.44f, 0}, {x, 0.57f, 0});
  const Profile boot = {{0.06f, 0.09f},   {0.088f, 0.092f}, {0.096f, 0.11f},  {0.09f, 0.2f},
                        {0.084f, 0.206f}, {0.084f, 0.216f}, {0.089f, 0.222f}, {0.078f, 0.36f},
                        {0.072f, 0.42f},  {0.062f, 0.432f}, {0.05f, 0.43f}};
  body.rigid(Body::shell, lathe(boot, 56), translation({x, 0, 0}), shin);
  body.rigid(Body::accent, torus(0.085f, 0.009f, 56, 12), up(0.211f), shin);
  body.blended(Body::rubber, sleeve(0.058f, 0.062f, 0.08f, 4, 0.01f), up(0.055f), foot, shin, {x, 0.08f, 0},
               {x, 0.12f, 0});
  // One shoe, bending where the toes begin.
  body.blended(Body::shell, superellipsoid({0.08f, 0.06f, 0.15f}, 0.7f, 0.85f, -0.08f, 32),
               translation({x, 0.058f, 0.05f}), foot, toes, {x, 0, 0.08f}, {x, 0, 0.15f});
  body.blended(Body::rubber, superellipsoid({0.085f, 0.018f, 0.156f}, 0.5f, 0.85f, 0, 28),
               translation({x, 0.018f, 0.05f}), foot, toes, {x, 0, 0.08f}, {x, 0, 0.15f});
}

}  // namespace

const std::array<JointInfo, jointCount> kSkeleton = {{
    {"hips", -1, {0, 0.92f, 0}},
    {"spine", hips, {0, 1.03f, 0}},
    {"chest", spine, {0, 1.12f, 0}},
    {"neck", chest, {0, 1.48f, 0}},
    {"head", neck, {0, 1.55f, 0}},
    {"left_clavicle", chest, {0.1f, 1.4f, 0}},
    {"left_upper_arm", leftClavicle, {0.23f, 1.4f, 0}},
    {"left_forearm", leftUpperArm, {0.53f, 1.4f, 0}},
    {"left_hand", leftForearm, {0.785f, 1.4f, 0}},
    {"right_clavicle", chest, {-0.1f, 1.4f, 0}},
    {"right_upper_arm", rightClavicle, {-0.23f, 1.4f, 0}},
    {"right_forearm", rightUpperArm, {-0.53f, 1.4f, 0}},
    {"right_hand", rightForearm, {-0.785f, 1.4f, 0}},
    {"left_thigh", hips, {0.115f, 0.87f, 0}},
    {"left_shin", leftThigh, {0.115f, 0.5f, 0}},
    {"left_foot", leftShin, {0.115f, 0.1f, 0}},
    {"left_toes", leftFoot, {0.115f, 0.03f, 0.11f}},
    {"right_thigh", hips, {-0.115f, 0.87f, 0}},
    {"right_shin", rightThigh, {-0.115f, 0.5f, 0}},
    {"right_foot", rightShin, {-0.115f, 0.1f, 0}},
    {"right_toes", rightFoot, {-0.115f, 0.03f, 0.11f}},
    {"left_ear", head, {0.175f, 1.68f, 0}},
    {"right_ear", head, {-0.175f, 1.68f, 0}},
}};

std::vector<Primitive> buildBody(Scene& scene) {
  Body body;
  buildTrunk(body);
  buildHead(body);
  for (const float side : {1.0f, -1.0f}) {
    buildArm(body, side);
    buildLeg(body, side);
  }
  const Material materials[Body::partCount] = {
      glossy("shell", {0.74f, 0.73f, 0.7f}, 0.45f), glossy("rubber", {0.06f, 0.06f, 0.065f}, 0.85f),
      glossy("accent", {0.75f, 0.24f, 0.05f}, 0.5f), glossy("visor", {0.015f, 0.02f, 0.03f}, 0.4f),
      lambert("eyes", {0.35f, 0.85f, 0.9f})};
  std::vector<Primitive> primitives;
  for (std::size_t i = 0; i < body.parts.size(); ++i)
    primitives.push_back({std::move(body.parts[i]), scene.addMaterial(materials[i])});
  return primitives;
}

std::vector<Primitive> buildBody(Scene& scene, std::size_t triangles) {
  std::vector<Primitive> primitives = buildBody(scene);
  std::size_t all = 0;
  for (const Primitive& p : primitives) all += p.mesh.triangleCount();
  for (Primitive& p : primitives)
    p.mesh = creased(simplified(welded(p.mesh), triangles * p.mesh.triangleCount() / all), 42);
  return primitives;
}

}  // namespace limn::assets::robot
