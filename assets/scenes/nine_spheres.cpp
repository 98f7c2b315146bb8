// Nine spheres on a checkered floor: diffuse, with bumps, glossy and of metal, under a sky; and shut in a
// box, where no sky is seen. Shadows and highlights of an environment are measured on them.
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "assets/generator/shapes.h"
#include "assets/scenes/relief.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

struct PlacedBall {
  glm::vec2 at;  ///< x and z
  float radius;
};

constexpr PlacedBall kBalls[] = {
    {{-1.05f, -0.95f}, 0.4f}, {{0.02f, -1.1f}, 0.3f},    {{1.0f, -0.8f}, 0.46f},
    {{-1.15f, 0.08f}, 0.28f}, {{-0.12f, -0.05f}, 0.44f}, {{0.9f, 0.22f}, 0.26f},
    {{-0.75f, 0.92f}, 0.34f}, {{0.2f, 0.85f}, 0.24f},    {{1.02f, 1.05f}, 0.36f}};

/// What everything is made of.
enum class Look { diffuse, bumps, glossy, metal };

/// GGX's alpha is the square of the roughness.
float roughnessOf(float alpha) {
  return std::sqrt(alpha);
}

/// A material of that look: of the colour `albedo`, or a metal of reflectance `metal` and lobe `alpha`.
Material made(Look look, std::string name, glm::vec3 albedo, glm::vec3 metal, float alpha) {
  if (look == Look::metal) return glossy(std::move(name), metal, roughnessOf(alpha), 1);
  if (look != Look::glossy) return lambert(std::move(name), albedo);
  Material lacquer = glossy(std::move(name), albedo, roughnessOf(0.15f));
  lacquer.ior = 1.8f;
  return lacquer;
}

/// The floor |x| <= 3, |z| <= 4 and the spheres on it.
void addSpheres(Scene& scene, Look look) {
  const bool metal = look == Look::metal;
  constexpr float tile = 2, bump = 0.5f;  // metres
  Material floor = made(look, "floor", glm::vec3(1), glm::vec3(1), 0.25f);
  floor.baseColourTexture = scene.addTexture(
      "checks", metal ? tileImage(512, 4, {0.8f, 0.81f, 0.83f}, {0.76f, 0.5f, 0.38f}, {0.5f, 0.48f, 0.45f})
                      : tileImage(512, 4, {0.7f, 0.68f, 0.63f}, {0.16f, 0.2f, 0.25f}, {0.12f, 0.12f, 0.12f}));
  std::array<Material, 3> skins = {
      made(look, "ivory", {0.78f, 0.74f, 0.66f}, {0.77f, 0.78f, 0.78f}, 0.1f),
      made(look, "terracotta", {0.62f, 0.22f, 0.12f}, {0.95f, 0.64f, 0.54f}, 0.25f),
      made(look, "ochre", {0.7f, 0.45f, 0.1f}, {1, 0.77f, 0.34f}, 0.15f)};
  if (look == Look::bumps) {
    const auto relief = [](float repeats) {
      return normalImage(512, [repeats](glm::vec2 uv) {
        return static_cast<float>(
                   noiseRelief(static_cast<double>(repeats * uv.x), static_cast<double>(repeats * uv.y))) /
               repeats;
      });
    };
    floor.normalTexture = scene.addTexture("floor_bumps", relief(tile / bump), true);
    const int bumps = scene.addTexture("bumps", relief(1), true);
    for (Material& skin : skins) skin.normalTexture = bumps;
  }

  Mesh stage = ground(3, 4, tile);
  std::array<Mesh, skins.size()> bySkin;
  for (std::size_t i = 0; i < std::size(kBalls); ++i) {
    const PlacedBall& ball = kBalls[i];
    Mesh mesh = sphere(ball.radius, 48);
    const float around = std::round(6.28f * ball.radius / bump);
    scaleUv(mesh, {around, 0.5f * around});
    append(bySkin[(i + i / 3) % bySkin.size()], mesh, translation({ball.at.x, ball.radius, ball.at.y}));
  }
  if (look == Look::bumps) {
    computeTangents(stage);
    for (Mesh& mesh : bySkin) computeTangents(mesh);
  }
  scene.add("floor", std::move(stage), scene.addMaterial(std::move(floor)));
  for (std::size_t i = 0; i < skins.size(); ++i) {
    const std::string name = "spheres_" + skins[i].name;
    scene.add(name, std::move(bySkin[i]), scene.addMaterial(std::move(skins[i])));
  }
  scene.addCamera("main", {0.5f, 2.5f, 3.6f}, {0, 0.12f, 0}, 34);
  scene.addCamera("close", {-1.3f, 1.1f, 2.2f}, {-0.1f, 0.2f, 0}, 36);
}

Scene underSky(Look look) {
  Scene scene;
  addSpheres(scene, look);
  scene.environment = makeSky();
  return scene;
}

}  // namespace

Scene makeNineSpheres() {
  return underSky(Look::diffuse);
}

Scene makeNineSpheresBump() {
  return underSky(Look::bumps);
}

Scene makeNineSpheresGlossy() {
  return underSky(Look::glossy);
}

Scene makeNineSpheresMetal() {
  return underSky(Look::metal);
}

// Walls are thicker than a texel of a shadow map, and overlap at their edges.
Scene makeClosedBox() {
  Scene scene;
  addSpheres(scene, Look::glossy);
  constexpr float thick = 0.25f, height = 3.2f, x = 2.8f, z = 3.8f;
  constexpr glm::vec3 outer(x + 2 * thick, 0.5f * height + 2 * thick, z + 2 * thick);
  constexpr float middle = 0.5f * height;
  Mesh sides;
  for (const float side : {-1.0f, 1.0f}) {
    append(sides, box({side * (x + thick), middle, 0}, {thick, outer.y, outer.z}));
    append(sides, box({0, middle, side * (z + thick)}, {outer.x, outer.y, thick}));
  }
  scene.add("walls", std::move(sides), scene.addMaterial(lambert("plaster", {0.66f, 0.62f, 0.55f})));
  Mesh slabs = box({0, height + thick, 0}, {outer.x, thick, outer.z});
  append(slabs, box({0, -thick - 0.01f, 0}, {outer.x, thick, outer.z}));  // a centimetre below the floor
  scene.add("slabs", std::move(slabs), scene.addMaterial(lambert("ceiling", {0.72f, 0.71f, 0.68f})));
  scene.addAreaLight("key", {-0.7f, height - 0.25f, 0.3f}, {0, 0, 0}, {1, 1}, 34, {1, 0.93f, 0.82f});
  return scene;
}

}  // namespace limn::assets
