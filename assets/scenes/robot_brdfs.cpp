// Robots of four materials dance on a turntable under the sky: one after the other comes to the front.
#include <glm/gtc/constants.hpp>

#include "assets/generator/shapes.h"
#include "assets/scenes/metals.h"
#include "assets/scenes/robot.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

constexpr std::size_t kTriangles = 12000;  // of a robot
constexpr int kLoops = 3;                  // of the dance while the table turns once
constexpr float kSeconds = robot::kLoop * kLoops;

/// The four of DeCoro and Rusinkiewicz 2008, figure 3: Phong's model with a wide and a narrow lobe, metallic
/// paint, whose flakes lie about its diffuse pigment, and Torrance and Sparrow's model of copper.
const ReflectionModel kModels[] = {
    {.model = "phong", .kd = glm::vec3(0.5f, 0.14f, 0.08f), .ks = glm::vec3(0.3f), .exponent = 12.f},
    {.model = "phong", .kd = glm::vec3(0.1f, 0.3f, 0.16f), .ks = glm::vec3(0.5f), .exponent = 80.f},
    {.model = "torrance_sparrow",
     .roughness = glm::vec2(0.35f),
     .eta = glm::vec3(5),
     .kd = glm::vec3(0.03f, 0.1f, 0.32f),
     .ks = glm::vec3(0.5f, 0.65f, 0.9f)},
    {.model = "torrance_sparrow", .roughness = glm::vec2(0.2f), .eta = kCopperEta, .k = kCopperK}};
const char* const kNames[] = {"phong_wide", "phong_narrow", "metallic_paint", "copper"};

}  // namespace

Scene makeRobotBrdfs() {
  Scene scene;
  Material floor = lambert("floor", {1, 1, 1});
  floor.baseColourTexture = scene.addTexture(
      "tiles", tileImage(512, 4, {0.5f, 0.49f, 0.46f}, {0.3f, 0.31f, 0.33f}, {0.16f, 0.16f, 0.16f}));
  scene.add("floor", ground(5, 5, 2), scene.addMaterial(floor));

  const std::vector<Primitive> body = robot::buildBody(scene, kTriangles);
  const int shell = body[0].material;
  Animation animation{"dance", {}};
  constexpr float height = 0.08f, radius = 1.55f;
  constexpr glm::vec2 rim[] = {{radius, -height}, {radius, -0.015f}, {radius - 0.015f, 0}, {0, 0}};
  Node table{.name = "turntable", .translation = {0, height, 0}};
  std::vector<Primitive> disc;
  disc.push_back({lathe(rim, 96), scene.addMaterial(lambert("turntable", {0.42f, 0.38f, 0.33f}))});
  table.mesh = scene.addMesh("turntable", std::move(disc));
  for (int i = 0; i < 4; ++i) {
    const auto model = static_cast<std::size_t>(i);
    std::vector<Primitive> primitives = body;
    const int material = scene.addMaterial(reflecting(kNames[model], kModels[model]));
    for (Primitive& p : primitives)
      if (p.material == shell) p.material = material;
    const float angle = 0.5f * glm::pi<float>() * static_cast<float>(i);
    const glm::vec2 at = 0.95f * glm::vec2(std::sin(angle), std::cos(angle));
    table.children.push_back(robot::addDancer(
        scene, scene.addMesh(kNames[model], std::move(primitives)),
        {.at = at, .degrees = glm::degrees(angle), .delay = 24 * i, .loops = kLoops}, animation));
  }
  const int turntable = scene.addNode(std::move(table));
  Channel turning{turntable, {}, {}, {}};
  constexpr int keys = 12;
  for (int k = 0; k <= keys; ++k) {
    const float part = static_cast<float>(k) / keys;
    turning.times.push_back(kSeconds * part);
    turning.rotations.push_back(
        glm::angleAxis(-2 * glm::pi<float>() * static_cast<float>(k % keys) / keys, glm::vec3(0, 1, 0)));
  }
  robot::untwist(turning);
  animation.channels.push_back(std::move(turning));
  scene.animations.push_back(std::move(animation));

  scene.environment = makeSky();
  scene.addCamera("main", {0.6f, 2.1f, 5.2f}, {0, 0.8f, 0}, 34);
  scene.addCamera("close", {0.4f, 1.5f, 2.9f}, {0, 1.1f, 0}, 38);
  return scene;
}

}  // namespace limn::assets
