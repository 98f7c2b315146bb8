// Small scenes for tests: white_furnace, lights (one light of every type), foliage_card (alpha-masked
// leaves).
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "assets/generator/random.h"
#include "assets/generator/shapes.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

/// A leaf on a transparent card: green inside the outline, a paler rib.
Image leafImage(int size) {
  return makeImage(size, size, [](glm::vec2 uv) {
    const float y = 1 - uv.y, x = std::abs(uv.x - 0.5f);
    const float halfWidth =
        0.42f * std::pow(std::max(std::sin(glm::pi<float>() * std::pow(y, 0.8f)), 0.0f), 0.8f);
    const float lobes = 1 - 0.12f * std::abs(std::sin(9 * glm::pi<float>() * y));
    const float vein = std::abs(std::fmod(y - 0.7f * x + 1, 0.11f) - 0.055f);
    const float pale =
        std::max(glm::smoothstep(0.012f, 0.004f, x), 0.6f * glm::smoothstep(0.01f, 0.0f, vein));
    const glm::vec3 colour = glm::mix(glm::vec3(0.16f, 0.36f, 0.07f), glm::vec3(0.3f, 0.45f, 0.12f), pale);
    return glm::vec4(colour, x < halfWidth * lobes ? 1 : 0);
  });
}

}  // namespace

Scene makeWhiteFurnace() {
  Scene scene;
  scene.add("sphere", sphere(1, 48), scene.addMaterial(lambert("white", {1, 1, 1})));
  scene.environment = makeImage(16, 8, [](glm::vec2) { return glm::vec4(1); });
  scene.addCamera("main", {0, 0, 4}, {0, 0, 0}, 40);
  scene.addCamera("close", {0, 0.9f, 1.6f}, {0, 0.3f, 0}, 40);
  return scene;
}

Scene makeLights() {
  Scene scene;
  scene.add("floor", ground(4, 4, 1), scene.addMaterial(lambert("floor", {0.6f, 0.6f, 0.6f})));
  const int grey = scene.addMaterial(lambert("grey", {0.5f, 0.5f, 0.5f}));
  const int plastic = scene.addMaterial(glossy("plastic", {0.45f, 0.12f, 0.1f}, 0.5f));
  const int metal = scene.addMaterial(glossy("metal", {0.75f, 0.6f, 0.35f}, 0.4f, 1));
  scene.add("box",
            transformed(box({0, 0.3f, 0}, {0.3f, 0.3f, 0.3f}),
                        translation({-0.9f, 0, -0.2f}) * rotation(25, {0, 1, 0})),
            grey);
  scene.add("ball", transformed(sphere(0.35f, 24), translation({0.1f, 0.35f, 0.3f})), plastic);
  scene.add(
      "ring",
      transformed(torus(0.32f, 0.1f, 48, 20), translation({1.1f, 0.42f, -0.3f}) * rotation(90, {1, 0, 0})),
      metal);

  scene.addLight("point", {.colour = {1, 0.75f, 0.5f}, .intensity = 1.2f}, {-1.6f, 1.6f, 1.2f}, {0, 0, 0});
  scene.addLight("spot",
                 {.type = Light::Type::spot,
                  .colour = {0.5f, 0.8f, 1},
                  .intensity = 5,
                  .innerConeAngle = 0.3f,
                  .outerConeAngle = 0.45f},
                 {2, 2.4f, 1.2f}, {0.7f, 0, 0});
  scene.addLight("sun", {.type = Light::Type::directional, .colour = {1, 0.95f, 0.85f}, .intensity = 0.5f},
                 {0, 3, 0}, {-1, 0, -1.2f});
  scene.nodes.back().angle = 0.05f;
  scene.addAreaLight("key", {-0.6f, 2.4f, -1.6f}, {0, 0, 0}, {0.8f, 0.5f}, 3);
  Material panel = lambert("panel", {0, 0, 0});
  panel.emissive = {0.6f, 1, 0.7f};
  panel.emissiveStrength = 5;
  scene.add("panel", quad({0.2f, 0.9f, -1.7f}, {0.5f, 0, 0}, {0, 0.3f, 0}), scene.addMaterial(panel));
  scene.addCamera("main", {0.2f, 2.1f, 4.2f}, {0.1f, 0.25f, 0}, 36);
  scene.addCamera("close", {-0.5f, 1, 2}, {-0.1f, 0.25f, 0}, 40);
  return scene;
}

Scene makeFoliageCard() {
  Scene scene;
  scene.add("floor", backdrop(4, 4, 2.5f, 4, 1), scene.addMaterial(lambert("floor", {0.55f, 0.53f, 0.5f})));
  Material leaf = lambert("leaf", {1, 1, 1});
  leaf.baseColourTexture = scene.addTexture("leaf", leafImage(256));
  leaf.doubleSided = true;
  leaf.alphaCutoff = 0.5f;
  Mesh cards;
  Random random(3);
  for (int i = 0; i < 60; ++i) {
    const float height = 0.15f + 1.3f * std::sqrt(random.uniform()),
                spread = 0.75f * std::sqrt(random.uniform());
    const float turn = random.uniform(0, 360), size = random.uniform(0.14f, 0.24f);
    append(cards, quad({0, size, 0}, {0.6f * size, 0, 0}, {0, size, 0}),
           rotation(turn, {0, 1, 0}) * translation({0, height, spread}) *
               rotation(random.uniform(20, 100), {1, 0, 0}));
  }
  scene.add("leaves", std::move(cards), scene.addMaterial(leaf));
  scene.add("stem", capsule(0.04f, 0.015f, 1.5f, 10),
            scene.addMaterial(lambert("bark", {0.2f, 0.13f, 0.08f})));
  scene.addAreaLight("key", {-2, 3.2f, 1.6f}, {0, 0.6f, 0}, {0.6f, 0.6f}, 42);
  scene.addCamera("main", {0, 1.3f, 3.6f}, {0, 0.75f, 0}, 40);
  scene.addCamera("close", {0.6f, 1.2f, 1.6f}, {0, 0.9f, 0}, 36);
  return scene;
}

}  // namespace limn::assets
