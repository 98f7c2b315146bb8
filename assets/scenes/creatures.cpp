// Small creatures, each one implicit surface of a few thousand vertices: a frog, a monster, a dragon that
// flies.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "assets/generator/implicit.h"
#include "assets/generator/shapes.h"
#include "assets/generator/simplify.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

/// A limb through points (position, radius), its segments run into each other.
float limb(glm::vec3 p, std::initializer_list<glm::vec4> joints, float blend = 0.04f) {
  float d = 1e9f;
  for (auto j = joints.begin(); j + 1 != joints.end(); ++j)
    d = smoothUnion(d, roundCone(p, glm::vec3(j[0]), glm::vec3(j[1]), j[0].w, j[1].w), blend);
  return d;
}

/// Sits facing +X, 0.4 m high.
float frog(glm::vec3 p) {
  const glm::vec3 q = mirrored(p);
  float d = smoothUnion(ellipsoid(p, {0, 0.2f, 0}, {0.26f, 0.15f, 0.19f}),
                        ellipsoid(p, {0.2f, 0.3f, 0}, {0.15f, 0.09f, 0.15f}), 0.1f);
  d = smoothUnion(d, ellipsoid(q, {0.2f, 0.38f, 0.085f}, glm::vec3(0.045f)), 0.02f);                // eyes
  d = smoothCut(d, roundCone(q, {0.35f, 0.27f, 0}, {0.22f, 0.26f, 0.16f}, 0.012f, 0.008f), 0.02f);  // mouth
  d = smoothUnion(d,
                  limb(q, {{-0.16f, 0.18f, 0.12f, 0.1f},
                           {0.02f, 0.17f, 0.27f, 0.06f},
                           {-0.2f, 0.05f, 0.25f, 0.045f},
                           {0.0f, 0.03f, 0.33f, 0.028f}}),
                  0.03f);  // hind legs
  d = smoothUnion(d,
                  limb(q, {{0.18f, 0.2f, 0.12f, 0.05f},
                           {0.2f, 0.11f, 0.2f, 0.04f},
                           {0.25f, 0.03f, 0.17f, 0.025f},
                           {0.32f, 0.02f, 0.2f, 0.018f}}),
                  0.03f);  // forelegs
  return 0.8f * d;
}

/// Stands facing +X, 1 m high: horns, claws, a tail.
float monster(glm::vec3 p) {
  const glm::vec3 q = mirrored(p);
  float d = smoothUnion(ellipsoid(p, {-0.02f, 0.45f, 0}, {0.2f, 0.26f, 0.22f}),
                        ellipsoid(p, {0.08f, 0.75f, 0}, {0.17f, 0.14f, 0.16f}), 0.12f);
  d = smoothCut(d, ellipsoid(p, {0.24f, 0.69f, 0}, {0.12f, 0.035f, 0.09f}), 0.02f);  // mouth
  d = smoothUnion(d, ellipsoid(q, {0.2f, 0.81f, 0.07f}, glm::vec3(0.04f)), 0.01f);   // eyes
  d = smoothUnion(
      d,
      limb(q, {{0.02f, 0.85f, 0.1f, 0.045f}, {-0.02f, 0.98f, 0.15f, 0.025f}, {0.04f, 1.07f, 0.16f, 0.01f}}),
      0.03f);
  d = smoothUnion(d,
                  limb(q, {{0.02f, 0.55f, 0.2f, 0.07f},
                           {0.1f, 0.42f, 0.34f, 0.055f},
                           {0.3f, 0.45f, 0.3f, 0.05f},
                           {0.36f, 0.47f, 0.26f, 0.02f}}),
                  0.05f);
  d = smoothUnion(d,
                  limb(q, {{-0.02f, 0.3f, 0.13f, 0.1f},
                           {0.04f, 0.15f, 0.17f, 0.07f},
                           {0.0f, 0.05f, 0.17f, 0.06f},
                           {0.15f, 0.03f, 0.18f, 0.03f}}),
                  0.06f);
  d = smoothUnion(d,
                  limb(p, {{-0.16f, 0.3f, 0, 0.1f},
                           {-0.36f, 0.12f, 0.04f, 0.06f},
                           {-0.5f, 0.1f, 0.12f, 0.035f},
                           {-0.56f, 0.2f, 0.16f, 0.012f}}),
                  0.06f);
  return 0.8f * d;
}

/// Flies towards +X, wings spread along Z, about the origin.
float dragon(glm::vec3 p) {
  const glm::vec3 q = mirrored(p);
  float d = limb(p,
                 {{-0.75f, 0.02f, 0, 0.015f},
                  {-0.5f, -0.04f, 0, 0.04f},
                  {-0.22f, 0, 0, 0.09f},
                  {0.1f, 0.02f, 0, 0.11f},
                  {0.3f, 0.1f, 0, 0.06f},
                  {0.44f, 0.22f, 0, 0.05f}},
                 0.08f);
  d = smoothUnion(d, ellipsoid(p, {0.53f, 0.23f, 0}, {0.11f, 0.055f, 0.05f}), 0.04f);                 // head
  d = smoothUnion(d, limb(q, {{0.47f, 0.26f, 0.03f, 0.02f}, {0.36f, 0.33f, 0.06f, 0.008f}}), 0.02f);  // horns
  d = smoothUnion(
      d,
      limb(q, {{-0.14f, -0.04f, 0.07f, 0.05f}, {-0.2f, -0.16f, 0.1f, 0.03f}, {-0.12f, -0.22f, 0.1f, 0.02f}}),
      0.04f);
  d = smoothUnion(
      d, limb(q, {{0.12f, 0.06f, 0.06f, 0.035f}, {0.2f, 0.12f, 0.35f, 0.03f}, {0.05f, 0.08f, 0.75f, 0.02f}}),
      0.03f);
  return smoothUnion(d, ellipsoid(q, {0.02f, 0.075f, 0.36f}, {0.22f, 0.022f, 0.4f}),
                     0.03f);  // membrane of the wings
}

/// Cameras look at `height` metres, from farther away the higher that is.
void addStage(Scene& scene, float height) {
  Material floor = lambert("floor", {1, 1, 1});
  floor.baseColourTexture = scene.addTexture(
      "tiles", tileImage(512, 4, {0.75f, 0.3f, 0.2f}, {0.25f, 0.45f, 0.7f}, {0.3f, 0.3f, 0.3f}));
  scene.add("floor", ground(1.4f, 1.4f, 1.4f), scene.addMaterial(floor));
  scene.addAreaLight("key", {-0.7f, 1.9f, 1.1f}, {0, 0.2f, 0}, {0.8f, 0.8f}, 14, {1, 0.97f, 0.92f});
  const glm::vec3 target(0, height, 0), away = (1 + height) * glm::vec3(1.1f, 0.55f, 1.2f);
  scene.addCamera("main", target + away, target, 34);
  scene.addCamera("close", target + 0.6f * away, target, 34);
}

}  // namespace

Scene makeFrog() {
  Scene scene;
  addStage(scene, 0.15f);
  const Mesh mesh = simplified(polygonise(frog, {-0.5f, -0.1f, -0.5f}, {0.5f, 0.5f, 0.5f}, 0.011f), 6900);
  scene.add("frog", mesh, scene.addMaterial(lambert("skin", {0.3f, 0.6f, 0.2f})));
  return scene;
}

Scene makeMonster() {
  Scene scene;
  addStage(scene, 0.45f);
  const Mesh mesh = simplified(polygonise(monster, {-0.7f, -0.1f, -0.5f}, {0.5f, 1.2f, 0.5f}, 0.018f), 6750);
  scene.add("monster", mesh, scene.addMaterial(lambert("hide", {0.7f, 0.6f, 0.45f})));
  return scene;
}

Scene makeFlyingDragon() {
  constexpr int body = 0, left = 1, right = 2;
  constexpr float loop = 2;  ///< seconds per wing beat
  Scene scene;
  addStage(scene, 0.5f);
  Mesh mesh = simplified(polygonise(dragon, {-0.9f, -0.3f, -0.9f}, {0.75f, 0.45f, 0.9f}, 0.014f), 5350);
  const glm::vec3 shoulder(0.1f, 0.06f, 0.08f);
  for (const glm::vec3& p : mesh.positions) {
    const float w = glm::smoothstep(0.04f, 0.2f, std::abs(p.z) - 0.02f);
    const auto wing = static_cast<std::uint8_t>(w > 0 ? (p.z > 0 ? left : right) : body);
    if (w == 1)
      mesh.joints.emplace_back(wing, 0, 0, 0);
    else
      mesh.joints.emplace_back(body, wing, 0, 0);
    mesh.weights.push_back(w == 1 ? glm::vec4(1, 0, 0, 0) : glm::vec4(1 - w, w, 0, 0));
  }
  const int first = scene.addNode({.name = "dragon body", .translation = {0, 0.6f, 0}});
  Skin skin{{first}, {glm::mat4(1)}};
  for (const float side : {1.0f, -1.0f}) {
    const glm::vec3 at = shoulder * glm::vec3(1, 1, side);
    const int node = scene.addNode({.name = side > 0 ? "left wing" : "right wing", .translation = at});
    scene.nodes[static_cast<std::size_t>(first)].children.push_back(node);
    skin.joints.push_back(node);
    skin.inverseBind.push_back(translation(-at));
  }
  scene.skins.push_back(skin);
  const int shape =
      scene.addMesh("dragon", {{mesh, scene.addMaterial(lambert("scales", {0.65f, 0.25f, 0.2f}))}});
  scene.addNode({.name = "dragon", .mesh = shape, .skin = 0});
  Animation flight{"flight", {{.node = first}, {.node = first + left}, {.node = first + right}}};
  constexpr int keys = 24;
  for (int k = 0; k <= keys; ++k) {
    const float time = loop * static_cast<float>(k) / keys;
    const float phase = 2 * glm::pi<float>() * static_cast<float>(k % keys) / keys;
    for (Channel& channel : flight.channels) channel.times.push_back(time);
    flight.channels[0].translations.emplace_back(0, 0.6f - 0.05f * std::sin(phase), 0);
    for (const int wing : {left, right})
      flight.channels[static_cast<std::size_t>(wing)].rotations.push_back(
          glm::angleAxis((wing == left ? -0.55f : 0.55f) * std::sin(phase), glm::vec3(1, 0, 0)));
  }
  scene.animations.push_back(flight);
  return scene;
}

}  // namespace limn::assets
