// Height maps (extras.limn_height): bricks, noise, an egg-crate and V-shaped grooves, on surfaces that are
// flat but for the sphere. All are Lambertian: what is seen is shape and light alone.
#include <algorithm>
#include <cmath>
#include <string>

#include "assets/generator/shapes.h"
#include "assets/scenes/relief.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

constexpr double kPi = 3.14159265358979;
constexpr glm::vec3 kSunlight(1, 0.97f, 0.92f);

/// Bumps and dents in rows, 3 of each along an axis; the RMS slope is 0.47.
double eggCrate(double u, double v) {
  return 0.0358 * std::sin(6 * kPi * u) * std::sin(6 * kPi * v);
}

/// 6 rows of 3 bricks with bevelled edges, every second row moved by half a brick; the RMS slope is 0.76.
double bricks(double u, double v) {
  const double row = std::floor(6 * v), y = 6 * v - row;
  const double along = 3 * u + (static_cast<int>(row) % 2 == 0 ? 0 : 0.5), x = along - std::floor(along);
  const double edge = std::min(std::min(x, 1 - x) / 3, std::min(y, 1 - y) / 6);
  const double part = std::clamp((edge - 0.012) / 0.03, 0.0, 1.0);
  return 0.0352 * part * part * (3 - 2 * part);
}

int bumpy(Scene& scene, std::string name, glm::vec3 albedo, const HeightMap& height) {
  Material material = lambert(std::move(name), albedo);
  material.height = height;
  return scene.addMaterial(std::move(material));
}

}  // namespace

Scene makeBumpWall() {
  Scene scene;
  const int brick =
      bumpy(scene, "bricks", {0.6f, 0.42f, 0.34f}, addHeights(scene, "bricks", {128, 128}, {1, 1}, bricks));
  Mesh wall = quad({0, 1, 0}, {1.5f, 0, 0}, {0, 1, 0});
  scaleUv(wall, {3, 2});
  scene.add("wall", std::move(wall), brick);
  scene.add("floor", quad({0, 0, 1}, {1.5f, 0, 0}, {0, 0, -1}),
            scene.addMaterial(lambert("floor", {0.5f, 0.5f, 0.52f})));
  // Along the wall and back, near enough to graze it.
  scene.addAreaLight("key", {-1.1f, 1.7f, 0.5f}, {-0.9f, 1, 0}, {0.2f, 0.2f}, 1.6f, {1, 0.95f, 0.88f});
  const int lamp = static_cast<int>(scene.nodes.size()) - 1;
  scene.animations.push_back(
      {"lamp",
       {{.node = lamp,
         .times = {0, 2, 4},
         .rotations = {},
         .translations = {{-1.1f, 1.7f, 0.5f}, {1.1f, 1.7f, 0.5f}, {-1.1f, 1.7f, 0.5f}}}}});
  scene.addCamera("main", {0.4f, 1.2f, 2.7f}, {0, 0.95f, 0}, 45);
  scene.addCamera("close", {-0.5f, 1.2f, 0.9f}, {-0.6f, 1.15f, 0}, 40);
  return scene;
}

Scene makeBumpSphere() {
  Scene scene;
  scene.add("floor", backdrop(4.5f, 3, 2.2f, 3.6f, 1),
            scene.addMaterial(lambert("floor", {0.5f, 0.5f, 0.52f})));
  // Around a sphere a unit of u is 2 pi r sin(theta) long, pi / 4 of the equator's in the mean over its area.
  constexpr float radius = 0.5f, pi = 3.14159265f;
  constexpr glm::vec2 repeats(5, 3);
  const glm::vec2 tile = glm::vec2(0.5f * pi * pi * radius, pi * radius) / repeats;
  const int stone =
      bumpy(scene, "stone", {0.6f, 0.58f, 0.55f}, addHeights(scene, "noise", {128, 128}, tile, noiseRelief));
  Mesh ball = sphere(radius, 64);
  scaleUv(ball, repeats);
  Node& node = scene.nodes[static_cast<std::size_t>(scene.add("sphere", std::move(ball), stone))];
  node.translation = {0, radius, 0};
  scene.addSun(35, {-1, 0.6f}, 3, kSunlight);
  scene.addCamera("main", {0, 0.9f, 2.2f}, {0, 0.45f, 0}, 36);
  scene.addCamera("close", {-0.3f, 0.8f, 1.2f}, {-0.1f, 0.55f, 0}, 36);
  return scene;
}

Scene makeEggCrate() {
  Scene scene;
  const int crate = bumpy(scene, "egg_crate", {0.6f, 0.6f, 0.58f},
                          addHeights(scene, "egg_crate", {64, 64}, {1, 1}, eggCrate));
  scene.add("plane", ground(1.5f, 1.5f, 1), crate);
  scene.addSun(30, {-1, -0.4f}, 3, kSunlight);
  scene.addCamera("main", {0, 2, 2.2f}, {0, 0, 0.1f}, 40);
  scene.addCamera("close", {0.2f, 0.7f, 0.9f}, {0, 0, 0.1f}, 40);
  return scene;
}

// Endless grooves along v, 4 a metre, whose walls stand at 45 degrees: a right angle between them.
Scene makeGroove() {
  Scene scene;
  constexpr int texels = 64;
  // Crests lie on the centres of texels, and so do bottoms: half a texel aside they would be cut off.
  const auto walls = [](double u, double) { return std::abs(u - 0.5 - 0.5 / texels); };
  const int groove = bumpy(scene, "groove", {0.6f, 0.6f, 0.58f},
                           addHeights(scene, "groove", {texels, 1}, {0.25f, 0.25f}, walls));
  scene.add("plane", ground(1, 1, 0.25f), groove);
  scene.addSun(30, {-1, -0.4f}, 3, kSunlight);
  scene.addCamera("main", {0, 1.4f, 1.6f}, {0, 0, 0.1f}, 40);
  scene.addCamera("close", {0.1f, 0.4f, 0.6f}, {0, 0, 0.1f}, 40);
  return scene;
}

}  // namespace limn::assets
