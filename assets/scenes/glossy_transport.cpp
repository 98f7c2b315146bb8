// Scenes in which glossy surfaces send light on: three_lights, glossy_room, glossy_globe, soda_corner and
// glossy_furnace.
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "assets/generator/shapes.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

/// Reflects three quarters of the light at normal incidence.
constexpr glm::vec3 kSatin{0.75f, 0.74f, 0.72f};

/// Part of the inside of a sphere, from `from` to `to` degrees off its lowest point.
Mesh innerCap(float radius, float from, float to, int rings, int segments) {
  Mesh cap = surface(segments, rings, [=](glm::vec2 uv) {
    const float azimuth = 2 * glm::pi<float>() * uv.x, polar = glm::radians(glm::mix(from, to, uv.y));
    return radius * glm::vec3(std::sin(polar) * std::cos(azimuth), -std::cos(polar),
                              std::sin(polar) * std::sin(azimuth));
  });
  for (std::size_t i = 0; i < cap.positions.size(); ++i) cap.normals[i] = cap.positions[i] * (-1 / radius);
  return cap;
}

/// A stool: a foot, a leg and a seat, the seat apart.
Mesh stoolFrame() {
  const std::array<glm::vec2, 8> outline{{{0, 0},
                                          {0.2f, 0},
                                          {0.2f, 0.015f},
                                          {0.05f, 0.05f},
                                          {0.028f, 0.1f},
                                          {0.028f, 0.62f},
                                          {0.12f, 0.66f},
                                          {0, 0.66f}}};
  return lathe(outline, 24);
}

Mesh stoolSeat() {
  const std::array<glm::vec2, 6> outline{
      {{0, 0.67f}, {0.17f, 0.67f}, {0.19f, 0.695f}, {0.18f, 0.725f}, {0.15f, 0.74f}, {0, 0.745f}}};
  return lathe(outline, 24);
}

}  // namespace

Scene makeThreeLights() {
  Scene scene;
  scene.add("plate", quad({0, 0, 0}, {0.25f, 0, 0}, {0, 0, -0.25f}),
            scene.addMaterial(glossy("satin", kSatin, 0.2f, 1)));
  scene.add("wall", quad({0, 0.41f, -0.3f}, {0.6f, 0, 0}, {0, 0.4f, 0}),
            scene.addMaterial(lambert("wall", {0.8f, 0.8f, 0.8f})));
  const struct {
    const char* name;
    float x;
    glm::vec3 colour;
  } lights[] = {
      {"key", 0, {0.15f, 1, 0.2f}}, {"red", -0.28f, {1, 0.12f, 0.1f}}, {"blue", 0.28f, {0.15f, 0.3f, 1}}};
  // A cone that the plate fills: what the wall shows of indirect light is the plate's.
  for (const auto& light : lights)
    scene.addAreaLight(light.name, {light.x, 0.5f, 0.45f}, {0.3f * light.x, 0, 0}, {0.12f, 0.12f}, 1.2f,
                       light.colour, 40);
  scene.addCamera("main", {0.35f, 0.6f, 1.3f}, {0, 0.3f, -0.1f}, 36);
  scene.addCamera("close", {0, 0.42f, 1.0f}, {0, 0.42f, -0.3f}, 34);
  return scene;
}

Scene makeGlossyRoom() {
  Scene scene;
  const int white = scene.addMaterial(lambert("white", {0.73f, 0.72f, 0.68f}));
  scene.add("floor", quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1}),
            scene.addMaterial(glossy("floor", kSatin, 0.3f, 1)));
  Mesh room = quad({0, 2, 0}, {1, 0, 0}, {0, 0, 1});
  append(room, quad({0, 1, -1}, {1, 0, 0}, {0, 1, 0}));
  append(room, quad({0, 1, 1}, {-1, 0, 0}, {0, 1, 0}));
  scene.add("room", std::move(room), white);
  scene.add("left_wall", quad({-1, 1, 0}, {0, 0, -1}, {0, 1, 0}),
            scene.addMaterial(lambert("red", {0.6f, 0.06f, 0.045f})));
  scene.add("right_wall", quad({1, 1, 0}, {0, 0, 1}, {0, 1, 0}),
            scene.addMaterial(lambert("green", {0.12f, 0.45f, 0.09f})));
  scene.add("box",
            transformed(box({0, 0, 0}, {0.3f, 0.2f, 0.2f}),
                        translation({0.05f, 0.6f, -0.2f}) * rotation(25, {0, 1, 0})),
            scene.addMaterial(lambert("blue", {0.2f, 0.3f, 0.65f})));
  scene.addAreaLight("key", {-0.2f, 1.95f, 0.3f}, {-0.2f, 0, 0.3f}, {0.5f, 0.5f}, 3.2f, {1, 0.96f, 0.9f});
  scene.addCamera("main", {0.0043f, 1.1031f, 3.9f}, {0, 0.93f, 0}, 38);
  scene.addCamera("close", {0.35f, 0.8f, 0.9f}, {0, 0.1f, -0.4f}, 48);
  return scene;
}

Scene makeGlossyGlobe() {
  Scene scene;
  scene.add("floor", quad({0, 0, 0}, {1.5f, 0, 0}, {0, 0, -1.5f}),
            scene.addMaterial(glossy("floor", {0.68f, 0.66f, 0.62f}, 0.2f, 1)));
  Material globe = lambert("globe", {1, 1, 1});
  globe.baseColourTexture = scene.addTexture(
      "globe", tileImage(512, 6, {0.82f, 0.2f, 0.12f}, {0.85f, 0.75f, 0.5f}, {0.3f, 0.2f, 0.15f}));
  Mesh ball = sphere(0.4f, 32);
  scaleUv(ball, {2, 1});
  scene.add("globe", transformed(ball, translation({0, 0.5f, 0})), scene.addMaterial(globe));
  scene.add("wall", quad({0, 0.75f, -1.5f}, {1.5f, 0, 0}, {0, 0.75f, 0}),
            scene.addMaterial(lambert("wall", {0.55f, 0.6f, 0.7f})));
  scene.addAreaLight("key", {-0.9f, 1.9f, 1.1f}, {0, 0.4f, 0}, {0.4f, 0.4f}, 15, {1, 0.97f, 0.92f});
  scene.addCamera("main", {0.5f, 0.85f, 2.3f}, {0, 0.38f, 0}, 36);
  scene.addCamera("close", {0.35f, 0.5f, 1.3f}, {0, 0.2f, 0}, 36);
  return scene;
}

Scene makeSodaCorner() {
  Scene scene;
  Material tiles = glossy("tiles", {1, 1, 1}, 0.3f, 0);
  tiles.baseColourTexture = scene.addTexture(
      "tiles", tileImage(512, 8, {0.85f, 0.83f, 0.78f}, {0.08f, 0.08f, 0.09f}, {0.3f, 0.3f, 0.3f}));
  scene.add("floor", ground(1.6f, 1.6f, 1.6f), scene.addMaterial(tiles));
  scene.add("back_wall", quad({0, 1.2f, -1.6f}, {1.6f, 0, 0}, {0, 1.2f, 0}),
            scene.addMaterial(lambert("mint", {0.5f, 0.74f, 0.64f})));
  scene.add("left_wall", quad({-1.6f, 1.2f, 0}, {0, 0, -1.6f}, {0, 1.2f, 0}),
            scene.addMaterial(lambert("cream", {0.82f, 0.76f, 0.62f})));
  scene.add("mirror_panel", quad({0.3f, 1.55f, -1.59f}, {0.9f, 0, 0}, {0, 0.35f, 0}),
            scene.addMaterial(glossy("brushed_panel", {0.85f, 0.85f, 0.88f}, 0.2f, 1)));
  const int steel = scene.addMaterial(glossy("steel", {0.78f, 0.78f, 0.8f}, 0.3f, 1));
  scene.add("counter", box({0.2f, 0.45f, -0.95f}, {1.1f, 0.45f, 0.25f}),
            scene.addMaterial(glossy("red_lacquer", {0.6f, 0.05f, 0.05f}, 0.35f)));
  scene.add("counter_top", box({0.2f, 0.925f, -0.93f}, {1.15f, 0.025f, 0.3f}), steel);
  const int leather = scene.addMaterial(lambert("leather", {0.65f, 0.1f, 0.08f}));
  for (const float x : {-0.55f, 0.1f, 0.75f}) {
    scene.add("stool", transformed(stoolFrame(), translation({x, 0, -0.3f})), steel);
    scene.add("seat", transformed(stoolSeat(), translation({x, 0, -0.3f})), leather);
  }
  const std::array<glm::vec2, 7> glass{
      {{0, 0}, {0.05f, 0}, {0.05f, 0.01f}, {0.015f, 0.03f}, {0.02f, 0.06f}, {0.055f, 0.2f}, {0, 0.2f}}};
  const glm::vec3 sodas[] = {{0.85f, 0.35f, 0.1f}, {0.2f, 0.6f, 0.25f}, {0.75f, 0.2f, 0.45f}};
  for (int i = 0; i < 3; ++i) {
    const std::string name = "soda_" + std::to_string(i);
    scene.add(name, transformed(lathe(glass, 20), translation({-0.4f + 0.55f * float(i), 0.95f, -0.85f})),
              scene.addMaterial(glossy(name, sodas[i], 0.2f)));
  }
  scene.addAreaLight("key", {0.3f, 2.3f, 0.2f}, {0.2f, 0.6f, -0.8f}, {1.0f, 0.3f}, 12, {1, 0.93f, 0.82f});
  scene.addCamera("main", {-0.55f, 1.45f, 2.5f}, {0.1f, 0.7f, -0.7f}, 42);
  scene.addCamera("close", {-0.75f, 1.3f, 0.5f}, {0.1f, 0.85f, -0.95f}, 44);
  return scene;
}

Scene makeGlossyFurnace() {
  Scene scene;
  constexpr float cap = 12;  // degrees
  scene.add("sphere", innerCap(1, cap, 180, 42, 90), scene.addMaterial(lambert("grey", {0.5f, 0.5f, 0.5f})));
  scene.add("cap", innerCap(1, 0, cap, 6, 90), scene.addMaterial(glossy("satin", kSatin, 0.3f, 1)));
  scene.addLight("key", {.intensity = 2}, {0, 0, 0}, {0, -1, 0});
  scene.addCamera("main", {0, -0.1f, 0}, {0.05f, -1, 0}, 40);
  scene.addCamera("close", {0.62f, -0.62f, 0}, {0, -1, 0}, 30);
  return scene;
}

}  // namespace limn::assets
