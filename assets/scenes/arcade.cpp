// A vaulted arcade, lit by the sky through its arches alone: most of what is seen sees less than half of it.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "assets/generator/shapes.h"
#include "assets/scenes/atrium_parts.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

constexpr int kBays = 5;
constexpr float kArchWidth = 2, kHalfLength = 0.5f * kBays * kArchWidth;
constexpr float kHalfDepth = 1.0f, kWall = 0.3f;  // of the walk, and of its walls
constexpr float kArchSpring = 2.2f, kWallTop = 3.25f,
                kRise = 0.5f;    // heights of the arches, the walls and the vault
constexpr float kSunTurn = -72;  // degrees about the vertical: the sun shines in aslant

/// Arches on columns along the walk's open side.
void addArches(Mesh& stone) {
  const float z = kHalfDepth + 0.5f * kWall;
  const Mesh wall = atrium::archedWall(kArchWidth, kWallTop - kArchSpring, kWall, 0.86f),
             column = atrium::plainColumn(kArchSpring, 0.13f);
  for (int bay = 0; bay < kBays; ++bay)
    append(stone, wall,
           translation({kArchWidth * (static_cast<float>(bay) + 0.5f) - kHalfLength, kArchSpring, z}));
  for (int axis = 1; axis < kBays; ++axis)
    append(stone, column, translation({kArchWidth * static_cast<float>(axis) - kHalfLength, 0, z}));
}

/// The inside of the barrel vault, or its outside, `thickness` away, which keeps light from its edges.
Mesh vault(float thickness) {
  Mesh mesh = surface(1, 24, [=](glm::vec2 uv) {
    const float angle = glm::pi<float>() * (thickness > 0 ? 1 - uv.y : uv.y);
    return glm::vec3((kHalfLength + kWall) * (2 * uv.x - 1), kWallTop + (kRise + thickness) * std::sin(angle),
                     -(kHalfDepth + thickness) * std::cos(angle));
  });
  scaleUv(mesh, {2 * (kHalfLength + kWall), 4});
  return mesh;
}

}  // namespace

Scene makeArcadeDark() {
  Scene scene;
  const glm::mat4 turn = rotation(kSunTurn, {0, 1, 0});
  const auto at = [&](glm::vec3 p) { return glm::vec3(turn * glm::vec4(p, 1)); };
  const auto add = [&](const char* name, const Mesh& mesh, const Material& material) {
    scene.add(name, transformed(mesh, turn), scene.addMaterial(material));
  };
  Material floor = glossy("floor", {1, 1, 1}, 0.5f);
  floor.baseColourTexture = scene.addTexture(
      "tiles", tileImage(512, 4, {0.62f, 0.57f, 0.48f}, {0.3f, 0.19f, 0.14f}, {0.16f, 0.15f, 0.14f}));
  Material plaster = lambert("plaster", {1, 1, 1});
  plaster.baseColourTexture = scene.addTexture("plaster", plasterImage(256, {0.68f, 0.6f, 0.48f}, 0.25f));

  Mesh stage = ground(kHalfLength + kWall, kHalfDepth + 0.6f, 2);
  add("floor", stage, floor);
  Mesh stone;
  addArches(stone);
  add("arches", stone, lambert("limestone", {0.66f, 0.62f, 0.54f}));
  Mesh walls = box({0, 0.5f * kWallTop, -kHalfDepth - 0.5f * kWall},
                   0.5f * glm::vec3(2 * kHalfLength, kWallTop, kWall));
  for (const float end : {-1.0f, 1.0f})
    append(walls, box({end * (kHalfLength + 0.5f * kWall), 0.5f * (kWallTop + kRise) + kWall, 0},
                      0.5f * glm::vec3(kWall, kWallTop + kRise + 2 * kWall, 2 * (kHalfDepth + kWall))));
  append(walls, vault(0));
  append(walls, vault(kWall));
  add("walls", walls, plaster);

  const glm::vec2 urn[] = {{0, 0},        {0.16f, 0},    {0.17f, 0.04f}, {0.11f, 0.08f}, {0.2f, 0.25f},
                           {0.28f, 0.5f}, {0.24f, 0.7f}, {0.13f, 0.82f}, {0.12f, 0.88f}, {0.18f, 0.95f}};
  Mesh urns;
  const Mesh one = lathe(spline(std::span<const glm::vec2>(urn), 4), 48);
  for (const float x : {-2.0f, 0.0f, 2.0f}) append(urns, one, translation({x, 0, -0.65f}));
  add("urns", urns, glossy("glaze", {0.1f, 0.24f, 0.26f}, 0.4f));

  scene.environment = makeSky();
  scene.addCamera("main", at({-4.7f, 1.75f, -0.1f}), at({0, 1.05f, 0.0f}), 47);
  scene.addCamera("close", at({-1.6f, 1.3f, 0.7f}), at({0.8f, 0.5f, -0.5f}), 44);
  return scene;
}

}  // namespace limn::assets
