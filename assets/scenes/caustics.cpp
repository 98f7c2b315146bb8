// Scenes in which metal and glass send light into a thin fog: all of it scattered only once; and one to look
// through.
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <string>

#include "assets/generator/shapes.h"
#include "assets/scenes/rose_window.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

constexpr float kWholeTurn = 2 * glm::pi<float>();

/// A full turn about `axis` in `seconds`.
Animation turning(int node, glm::vec3 axis, float seconds) {
  Animation animation{"turn", {{.node = node, .times = {}, .rotations = {}, .translations = {}}}};
  constexpr int parts = 8;
  for (int i = 0; i <= parts; ++i) {
    const float share = static_cast<float>(i) / parts;
    animation.channels[0].times.push_back(share * seconds);
    animation.channels[0].rotations.push_back(glm::angleAxis(share * kWholeTurn, axis));
  }
  return animation;
}

Light spot(float intensity, float outerDegrees) {
  return {.type = Light::Type::spot,
          .intensity = intensity,
          .innerConeAngle = glm::radians(0.8f * outerDegrees),
          .outerConeAngle = glm::radians(outerDegrees)};
}

void addFloor(Scene& scene, float half) {
  scene.add("floor", ground(half, half, 1), scene.addMaterial(lambert("floor", {0.5f, 0.48f, 0.45f})));
}

void addFacet(Mesh& mesh, std::initializer_list<glm::vec3> corners) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const glm::vec3* p = corners.begin();
  const glm::vec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
  for (const glm::vec3& corner : corners) {
    mesh.positions.push_back(corner);
    mesh.normals.push_back(normal);
    mesh.uvs.emplace_back(0);
  }
  for (std::uint32_t i = 2; i < corners.size(); ++i)
    mesh.indices.insert(mesh.indices.end(), {first, first + i - 1, first + i});
}

/// A table cut of `sides` sides about the Y axis: table, crown, girdle, pavilion; girdle radius 1.
Mesh gemstone(int sides) {
  Mesh mesh;
  const auto at = [&](float radius, float height, int i) {
    const float angle = kWholeTurn * static_cast<float>(i % sides) / static_cast<float>(sides);
    return glm::vec3(radius * std::sin(angle), height, radius * std::cos(angle));
  };
  constexpr float table = 0.56f, top = 0.34f, girdle = 0.03f, depth = -0.86f;
  for (int i = 0; i < sides; ++i) {
    addFacet(mesh, {at(0, top, 0), at(table, top, i), at(table, top, i + 1)});
    addFacet(mesh, {at(1, girdle, i), at(1, girdle, i + 1), at(table, top, i + 1), at(table, top, i)});
    addFacet(mesh, {at(1, -girdle, i), at(1, -girdle, i + 1), at(1, girdle, i + 1), at(1, girdle, i)});
    addFacet(mesh, {at(0, depth, 0), at(1, -girdle, i + 1), at(1, -girdle, i)});
  }
  return mesh;
}

/// A stone under one to four spots.
Scene gemUnder(int lights) {
  Scene scene;
  addFloor(scene, 2.5f);
  const int gem = scene.add("gem", transformed(gemstone(8), scaling(glm::vec3(0.55f))),
                            scene.addMaterial(glass("gem", 1.7f, {0.97f, 0.99f, 1.0f})));
  scene.nodes[static_cast<std::size_t>(gem)].translation = {0, 1.3f, 0};
  scene.animations.push_back(turning(gem, {0, 1, 0}, 8));
  scene.medium = {.sigmaA = 0.02f, .sigmaS = 0.15f, .g = 0};
  scene.addLight("key", spot(120, 18), {-1.2f, 4.0f, 0.5f}, {0, 1.25f, 0});
  const glm::vec3 others[] = {{1.4f, 3.8f, 0.3f}, {0.2f, 4.1f, -1.3f}, {0.1f, 3.9f, 1.5f}};
  for (int i = 1; i < lights; ++i)
    scene.addLight("spot" + std::to_string(i + 1), spot(120, 18), others[i - 1], {0, 1.25f, 0});
  scene.addCamera("main", {0.3f, 1.5f, 4.4f}, {0.1f, 1.0f, 0}, 38);
  scene.addCamera("close", {0.2f, 1.2f, 2.4f}, {0.1f, 0.95f, 0}, 38);
  scene.addCamera("above", {0.2f, 3.6f, 2.4f}, {0, 0.6f, 0}, 38);
  return scene;
}

}  // namespace

Scene makeGlassSphere() {
  Scene scene;
  addFloor(scene, 2.5f);
  const int ball = scene.add("ball", sphere(0.5f, 96), scene.addMaterial(glass("glass", 1.5f)));
  scene.nodes[static_cast<std::size_t>(ball)].translation = {0, 1.5f, 0};
  scene.animations.push_back(
      {"bob",
       {{.node = ball,
         .times = {0, 1.5f, 3, 4.5f, 6},
         .rotations = {},
         .translations = {{0, 1.5f, 0}, {0.2f, 1.7f, 0}, {0, 1.5f, 0}, {-0.2f, 1.3f, 0}, {0, 1.5f, 0}}}}});
  scene.medium = {.sigmaA = 0.02f, .sigmaS = 0.15f, .g = 0};
  scene.addLight("key", spot(120, 20), {-0.9f, 4.2f, 0}, {0, 1.5f, 0});
  scene.addCamera("main", {0.3f, 1.6f, 5.2f}, {0.1f, 1.1f, 0}, 38);
  scene.addCamera("close", {0.3f, 1.2f, 2.4f}, {0.15f, 0.85f, 0}, 38);
  scene.addCamera("above", {0.2f, 4.4f, 3.2f}, {0.2f, 0.6f, 0}, 38);
  scene.addCamera("along", {1.0f, 0.1f, 0.6f}, {-0.2f, 2.2f, 0}, 50);
  return scene;
}

Scene makeRing() {
  Scene scene;
  addFloor(scene, 2.5f);
  Material gold = glossy("gold", {1.0f, 0.78f, 0.34f}, 0, 1);
  const int ring = scene.add("ring", torus(0.6f, 0.14f, 160, 64), scene.addMaterial(gold));
  scene.nodes[static_cast<std::size_t>(ring)].translation = {0, 0.5f, 0};
  scene.animations.push_back(turning(ring, {1, 0, 0}, 8));
  scene.medium = {.sigmaA = 0.02f, .sigmaS = 0.15f, .g = 0};
  scene.addLight("key", spot(90, 22), {-1.9f, 2.9f, 0.4f}, {0, 0.5f, 0});
  scene.addCamera("main", {0.4f, 1.5f, 3.6f}, {0, 0.55f, 0}, 38);
  scene.addCamera("close", {0.2f, 1.1f, 2.1f}, {0, 0.5f, 0}, 38);
  scene.addCamera("above", {0.2f, 3.2f, 1.6f}, {0, 0.3f, 0}, 38);
  return scene;
}

Scene makeGem() {
  return gemUnder(1);
}
Scene makeGem2Lights() {
  return gemUnder(2);
}
Scene makeGem4Lights() {
  return gemUnder(4);
}

Scene makeStainedLight() {
  Scene scene;
  addFloor(scene, 2.5f);
  const int ball = scene.add("ball", sphere(0.3f, 96), scene.addMaterial(glass("glass", 1.5f)));
  scene.nodes[static_cast<std::size_t>(ball)].translation = {0.05f, 1.15f, 0.1f};
  scene.medium = {.sigmaA = 0.02f, .sigmaS = 0.12f, .g = 0.2f};
  Light key = spot(260, 17);
  key.texture = scene.addTexture("window", roseWindow());
  scene.addLight("key", key, {-1.5f, 4.0f, 0.6f}, {0.05f, 1.15f, 0.1f});
  scene.addCamera("main", {0.3f, 1.9f, 5.0f}, {0.05f, 1.15f, 0}, 38);
  scene.addCamera("close", {0.4f, 1.2f, 2.2f}, {0.2f, 0.8f, 0}, 38);
  return scene;
}

Scene makeSmoke() {
  Scene scene;
  addFloor(scene, 2.5f);
  const int ball = scene.add("ball", sphere(0.45f, 96), scene.addMaterial(glass("glass", 1.5f)));
  scene.nodes[static_cast<std::size_t>(ball)].translation = {-0.1f, 1.35f, 0};
  scene.medium = {.sigmaA = 0.05f, .sigmaS = 0.9f, .g = 0.2f};
  scene.medium->smoke = {
      .low = {-1.8f, -0.05f, -1.2f}, .high = {1.9f, 2.9f, 1.2f}, .whirl = 0.8f, .rise = 0.3f, .seed = 3};
  scene.addLight("key", spot(160, 16), {-2.2f, 3.6f, 0.5f}, {-0.1f, 1.35f, 0});
  scene.addCamera("main", {0.3f, 1.6f, 5.2f}, {0.1f, 1.15f, 0}, 38);
  scene.addCamera("close", {0.5f, 1.2f, 2.4f}, {0.3f, 0.95f, 0}, 38);
  scene.addCamera("above", {0.2f, 4.4f, 3.2f}, {0.2f, 0.6f, 0}, 38);
  return scene;
}

Scene makeGlassware() {
  Scene scene;
  Material tiles = lambert("tiles", glm::vec3(1));
  tiles.baseColourTexture = scene.addTexture(
      "tiles", tileImage(512, 4, {0.72f, 0.34f, 0.2f}, {0.75f, 0.73f, 0.68f}, {0.25f, 0.24f, 0.22f}));
  scene.add("floor", backdrop(3.2f, 2.2f, 1.8f, 2.8f, 1.2f), scene.addMaterial(tiles));
  const auto put = [&](const char* name, Mesh mesh, Material material, glm::vec3 place) {
    const int node = scene.add(name, std::move(mesh), scene.addMaterial(std::move(material)));
    scene.nodes[static_cast<std::size_t>(node)].translation = place;
    return node;
  };
  put("ball", sphere(0.5f, 96), glass("glass", 1.5f), {-0.75f, 0.55f, 0.3f});
  put("ring", torus(0.5f, 0.16f, 128, 48), glossy("silver", {0.95f, 0.93f, 0.88f}, 0, 1),
      {0.35f, 0.17f, 0.75f});
  const int gem = put("gem", transformed(gemstone(8), scaling(glm::vec3(0.5f))),
                      glass("gem", 1.7f, {0.9f, 0.97f, 1.0f}), {0.75f, 0.95f, -0.1f});
  put("clay", sphere(0.28f, 48), lambert("clay", {0.2f, 0.45f, 0.3f}), {-0.2f, 0.28f, -0.75f});
  scene.animations.push_back(turning(gem, {0, 1, 0}, 8));
  scene.addAreaLight("key", {-1.6f, 3.6f, 2.2f}, {0, 0.4f, 0}, {0.8f, 0.8f}, 36, {1, 0.96f, 0.9f}, 60);
  scene.addCamera("main", {0.2f, 1.5f, 4.4f}, {0, 0.62f, 0}, 36);
  scene.addCamera("close", {-0.5f, 0.9f, 2.2f}, {-0.55f, 0.55f, 0}, 38);
  return scene;
}

Scene makeWater() {
  Scene scene;
  addFloor(scene, 3);
  const Mesh waves = surface(192, 192, [](glm::vec2 u) {
    const float x = 6 * u.x - 3, z = 3 - 6 * u.y;
    const float height = 0.035f * std::sin(3.1f * x + 1.3f * z) + 0.03f * std::sin(2.3f * z - 1.9f * x + 1) +
                         0.014f * std::sin(7.3f * x + 4.1f * z + 2) + 0.012f * std::sin(6.1f * z - 5.3f * x);
    return glm::vec3(x, height, z);
  });
  Material water = glass("water", 1.33f);
  water.doubleSided = true;
  const int sheet = scene.add("waves", waves, scene.addMaterial(water));
  scene.nodes[static_cast<std::size_t>(sheet)].translation = {0, 2, 0};
  scene.animations.push_back({"drift",
                              {{.node = sheet,
                                .times = {0, 4, 8},
                                .rotations = {},
                                .translations = {{-0.3f, 2, 0}, {0.3f, 2, 0.2f}, {-0.3f, 2, 0}}}}});
  scene.medium = {.sigmaA = 0.05f, .sigmaS = 0.12f, .g = 0.5f};
  scene.addLight("key", spot(420, 20), {-1.6f, 7.5f, -0.6f}, {0, 2, 0});
  scene.addCamera("main", {0.2f, 0.9f, 3.4f}, {0, 1.05f, 0}, 50);
  scene.addCamera("close", {0.1f, 0.5f, 1.6f}, {0, 1.3f, 0}, 50);
  return scene;
}

}  // namespace limn::assets
