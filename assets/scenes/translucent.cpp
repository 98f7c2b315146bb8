// Translucent bodies (extras.limn_subsurface) of the size of what they stand for: a block of skin, spheres,
// an ear, a board of marble, a bowl of milk. Each body is one closed mesh.
#include "assets/scenes/translucent.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "assets/generator/implicit.h"
#include "assets/generator/shapes.h"
#include "assets/generator/simplify.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

/// The points of a circle about (0, height) on the axis, from one angle to another; degrees, 0 is level.
void addArc(std::vector<glm::vec2>& profile, float height, float radius, float from, float to, int parts) {
  for (int i = 0; i <= parts; ++i) {
    const float angle = glm::radians(glm::mix(from, to, static_cast<float>(i) / static_cast<float>(parts)));
    profile.emplace_back(radius * std::cos(angle), height + radius * std::sin(angle));
  }
}

/// A sphere about the origin whose vertices at the seam are the same to the bit.
Mesh ball(float radius, int rings) {
  std::vector<glm::vec2> profile;
  addArc(profile, 0, radius, -90, 90, rings);
  profile.front().x = profile.back().x = 0;
  Mesh mesh = lathe(profile, 2 * rings);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.normals[i] = mesh.positions[i] / radius;
  return mesh;
}

constexpr glm::vec2 kEarRadii(0.02f, 0.032f);  ///< of its outline, half way up

/// 0 in the middle of the ear and 1 on its outline, which is narrower below.
float earPlace(glm::vec2 p) {
  return glm::length(p / (kEarRadii * glm::vec2(1 + 0.25f * p.y / kEarRadii.y, 1)));
}

/// How far the middle of the shell lies before z = 0: a bowl with a rolled rim, a fold and a hollow.
float earDepth(glm::vec2 p) {
  const auto bell = [](float x, float width) { return std::exp(-x * x / (width * width)); };
  const float place = earPlace(p), angle = std::atan2(p.y, p.x);
  const float upper = glm::smoothstep(-0.9f, 0.3f, std::sin(angle) + 0.5f * std::cos(angle));
  return 6 * glm::dot(p, p) +
         upper * (0.0035f * bell(place - 0.86f, 0.13f) + 0.0025f * bell(place - 0.5f, 0.14f)) -
         0.004f * bell(glm::distance(p, {-0.004f, -0.003f}), 0.007f);
}

/// Distance to a shell between planes that are 2 mm apart at the upper end and 10 mm at the lower one.
float ear(glm::vec3 p) {
  constexpr float step = 1e-4f;
  const glm::vec2 q(p), right(step, 0), up(0, step);
  const glm::vec2 slope =
      glm::vec2(earDepth(q + right) - earDepth(q - right), earDepth(q + up) - earDepth(q - up)) / (2 * step);
  const float away = std::abs(p.z - earDepth(q)) / std::sqrt(1 + glm::dot(slope, slope));
  const float thickness = glm::mix(0.01f, 0.002f, glm::clamp(0.5f + 0.5f * q.y / kEarRadii.y, 0.0f, 1.0f));
  const float outline = (earPlace(q) - 1) * kEarRadii.x;
  return smoothCut(away - 0.5f * thickness, -outline, 0.0015f);
}

/// Mean distance between where light enters a half space and where it leaves, in reduced mean free paths, at
/// IOR 1.3 and albedos of an event of 0.99, 0.98 and 0.95.
constexpr glm::vec3 kWarmAbsorption(0.01f, 0.02f, 0.05f), kWarmMeanDistance(3.471f, 2.87f, 2.166f);

/// A body in whose channels that mean distance is `distance` metres.
Material warm(std::string name, float distance) {
  const glm::vec3 extinction = kWarmMeanDistance / distance;
  return translucent(std::move(name), kWarmAbsorption * extinction, (1.0f - kWarmAbsorption) * extinction,
                     1.3f, 0.4f);
}

}  // namespace

Material skin(std::string name, float roughness) {
  return translucent(std::move(name), {32, 170, 480}, {740, 880, 1010}, 1.3f, roughness);
}

Material marble(std::string name) {
  return translucent(std::move(name), {2.1f, 4.1f, 7.1f}, {2190, 2620, 3000}, 1.5f, 0.35f);
}

Material wholeMilk(std::string name) {
  return translucent(std::move(name), {1.1f, 2.4f, 14}, {2550, 3210, 3770}, 1.3f, 0.1f);
}

// The shadow's edge lies along x = 0. "main" looks straight down: at 192 rows a pixel is 0.25 mm, a third of
// the least mean distance of skin's channels (3.0, 1.4 and 0.8 mm), and what is beside the picture is too far
// away to matter.
Scene makeTranslucentEdge() {
  Scene scene;
  scene.add("block", box({0, -0.02f, 0}, {0.05f, 0.02f, 0.05f}), scene.addMaterial(skin("skin", 0.5f)));
  scene.add("plate", box({-0.1f, 0.0495f, 0}, {0.05f, 0.0005f, 0.055f}),
            scene.addMaterial(lambert("plate", glm::vec3(0.02f))));
  scene.addSun(45, {-1, 0}, 8);
  scene.addCamera("main", {0, 0.25f, 0}, {0, 0, 0}, 11);
  scene.addCamera("close", {0.01f, 0.06f, 0.1f}, {0, 0, 0}, 20);
  return scene;
}

Scene makeTranslucentSpheres() {
  constexpr float radius = 0.02f, apart = 0.055f;
  Scene scene;
  scene.add("floor", ground(0.25f, 0.25f, 1), scene.addMaterial(lambert("floor", glm::vec3(0.3f))));
  // Like the five of a die, the most translucent one at the back.
  constexpr glm::vec2 places[] = {{-1, -1}, {1, -1}, {0, 0}, {-1, 1}, {1, 1}};
  constexpr int reaches[] = {1, 3, 10, 30, 100};  ///< radii in mean distances
  for (std::size_t i = 0; i < std::size(places); ++i) {
    const std::string name = "radius " + std::to_string(reaches[i]);
    const int body = scene.addMaterial(warm(name, radius / static_cast<float>(reaches[i])));
    Node& node = scene.nodes[static_cast<std::size_t>(scene.add(name, ball(radius, 40), body))];
    node.translation = {apart * places[i].x, 1.02f * radius, apart * places[i].y};
  }
  scene.addSun(35, {-1, -0.3f}, 5);
  scene.addCamera("main", {0, 0.26f, 0.3f}, {0.004f, 0.012f, 0.004f}, 22);
  scene.addCamera("close", {0.02f, 0.1f, 0.12f}, {0, 0.02f, 0}, 24);
  return scene;
}

Scene makeTranslucentEar() {
  Scene scene;
  const Mesh fine = polygonise(ear, {-0.028f, -0.04f, -0.014f}, {0.028f, 0.04f, 0.026f}, 0.0008f);
  scene.add("ear", simplified(fine, 24'000), scene.addMaterial(skin("skin", 0.5f)));
  scene.add("table", transformed(ground(0.3f, 0.3f, 1), translation({0, -0.045f, 0})),
            scene.addMaterial(lambert("table", {0.03f, 0.026f, 0.024f})));
  scene.addAreaLight("key", {0.03f, 0.05f, -0.16f}, {0, 0, 0}, {0.01f, 0.01f}, 0.6f, {1, 0.96f, 0.9f});
  scene.addCamera("main", {-0.04f, 0.01f, 0.24f}, {0, 0, 0.004f}, 18);
  scene.addCamera("close", {-0.02f, 0.03f, 0.12f}, {0, 0.012f, 0.004f}, 18);
  scene.addCamera("lit", {-0.17f, 0.02f, -0.12f}, {0, 0, 0.004f}, 20);
  return scene;
}

// Squares of 15 mm, 7 mean distances: one mean free path, two albedos.
Scene makeTranslucentChecker() {
  constexpr float square = 0.015f, half = 4 * square;
  Scene scene;
  Material board = marble("board");
  board.baseColour = glm::vec4(1);
  board.baseColourTexture =
      scene.addTexture("checker", makeImage(64, 64, [](glm::vec2 uv) {
                         const bool even = (uv.x < 0.5f) == (uv.y < 0.5f);
                         return even ? glm::vec4(0.83f, 0.79f, 0.75f, 1) : glm::vec4(0.22f, 0.3f, 0.25f, 1);
                       }));
  board.subsurface->meanFreePath = 1.0f / (board.subsurface->sigmaA + board.subsurface->sigmaSPrime);
  Mesh slab = box({0, -0.01f, 0}, {half, 0.01f, half});
  scaleUv(slab, glm::vec2(0.5f / square));
  scene.add("board", std::move(slab), scene.addMaterial(board));
  scene.add("table", transformed(ground(0.3f, 0.3f, 1), translation({0, -0.021f, 0})),
            scene.addMaterial(lambert("table", {0.2f, 0.16f, 0.12f})));
  std::vector<glm::vec2> pawn = {{0, 0}, {0.006f, 0}, {0.006f, 0.002f}, {0.0024f, 0.006f}, {0.002f, 0.015f}};
  addArc(pawn, 0.019f, 0.0045f, -60, 90, 12);
  pawn.back().x = 0;
  const int wood = scene.addMaterial(glossy("wood", {0.12f, 0.06f, 0.03f}, 0.4f));
  for (const glm::vec2 at : {glm::vec2(-1.5f, 0.5f), {1.5f, -1.5f}, {0.5f, 2.5f}}) {
    Node& node = scene.nodes[static_cast<std::size_t>(scene.add("pawn", lathe(pawn, 48), wood))];
    node.translation = {square * at.x, -0.0005f, square * at.y};
  }
  scene.addSun(35, {-1, -0.25f}, 4);
  scene.addCamera("main", {0.02f, 0.17f, 0.17f}, {0, -0.005f, 0.006f}, 27);
  scene.addCamera("close", {-0.01f, 0.05f, 0.085f}, {-0.01f, 0, 0.007f}, 30);
  return scene;
}

Scene makeMilk() {
  constexpr float middle = 0.068f, level = 0.055f;  ///< of the bowl's spheres, and of the milk
  const auto below = [&](float radius) { return glm::degrees(std::asin((level - middle) / radius)); };
  Scene scene;
  scene.add("table", ground(0.4f, 0.4f, 1), scene.addMaterial(lambert("table", {0.25f, 0.2f, 0.16f})));
  std::vector<glm::vec2> bowl = {{0, 0}, {0.026f, 0}, {0.028f, 0.004f}};
  addArc(bowl, middle, 0.066f, -65, 0, 20);
  bowl.emplace_back(0.064f, middle + 0.0015f);
  addArc(bowl, middle, 0.062f, 0, -90, 24);
  bowl.back().x = 0;
  scene.add("bowl", lathe(bowl, 96), scene.addMaterial(glossy("porcelain", {0.1f, 0.22f, 0.5f}, 0.3f)));
  // Its sides run within the wall of the bowl.
  std::vector<glm::vec2> milk;
  addArc(milk, middle, 0.064f, -90, below(0.064f), 16);
  milk.front().x = 0;
  milk.emplace_back(0, level);
  scene.add("milk", lathe(milk, 96), scene.addMaterial(wholeMilk("milk")));
  const int berry = scene.addMaterial(glossy("berry", {0.55f, 0.03f, 0.05f}, 0.4f));
  for (const glm::vec3 at : {glm::vec3(0.006f, 0.06f, 0.01f), {-0.02f, 0.056f, 0.03f}}) {
    Node& node = scene.nodes[static_cast<std::size_t>(scene.add("berry", sphere(0.012f, 32), berry))];
    node.translation = at;
  }
  scene.addSun(38, {-1, -0.3f}, 3.5f);
  scene.addCamera("main", {0.03f, 0.24f, 0.2f}, {0, 0.045f, 0.002f}, 30);
  scene.addCamera("close", {0.01f, 0.15f, 0.1f}, {0, 0.055f, 0.01f}, 30);
  return scene;
}

}  // namespace limn::assets
