// Spheres of many sizes over a plane under one rectangle: every penumbra width in one picture.
#include "assets/generator/random.h"
#include "assets/generator/shapes.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

struct Ball {
  glm::vec3 centre;
  float radius;
};

bool overlaps(const std::vector<Ball>& balls, const Ball& candidate) {
  for (const Ball& ball : balls) {
    if (glm::distance(ball.centre, candidate.centre) < 1.06f * (ball.radius + candidate.radius)) return true;
  }
  return false;
}

/// Dart throwing, large balls first; one in four of the small ones floats.
std::vector<Ball> packBalls() {
  std::vector<Ball> balls = {
      {{-0.95f, 0.62f, -0.55f}, 0.62f}, {{0.85f, 0.45f, 0.15f}, 0.45f}, {{0.3f, 1.35f, -0.7f}, 0.3f}};
  Random random(7);
  for (const auto& [radius, count] : {std::pair{0.26f, 7}, {0.16f, 14}, {0.09f, 26}, {0.05f, 36}}) {
    for (int placed = 0; placed < count;) {
      const float r = radius * random.uniform(0.85f, 1.15f);
      const float lift = radius < 0.2f && random.uniform() < 0.25f ? random.uniform(0.1f, 0.9f) : 0;
      const Ball candidate{{random.uniform(-2.1f, 2.1f), r + lift, random.uniform(-1.6f, 1.9f)}, r};
      if (overlaps(balls, candidate)) continue;
      balls.push_back(candidate);
      ++placed;
    }
  }
  return balls;
}

}  // namespace

Scene makeBalls() {
  Scene scene;
  const int tiles = scene.addTexture(
      "tiles", tileImage(512, 4, {0.62f, 0.6f, 0.56f}, {0.5f, 0.49f, 0.47f}, {0.28f, 0.27f, 0.25f}));
  Material floor = lambert("floor", {1, 1, 1});
  floor.baseColourTexture = tiles;
  scene.add("floor", backdrop(7, 6, 4.5f, 5, 2.4f), scene.addMaterial(floor));

  const int materials[] = {scene.addMaterial(glossy("ivory", {0.78f, 0.74f, 0.66f}, 0.5f)),
                           scene.addMaterial(glossy("terracotta", {0.62f, 0.22f, 0.12f}, 0.6f)),
                           scene.addMaterial(glossy("petrol", {0.06f, 0.26f, 0.32f}, 0.45f)),
                           scene.addMaterial(glossy("ochre", {0.7f, 0.45f, 0.1f}, 0.55f)),
                           scene.addMaterial(glossy("steel", {0.6f, 0.6f, 0.62f}, 0.4f, 1))};
  std::vector<Mesh> byMaterial(std::size(materials));
  const std::vector<Ball> balls = packBalls();
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const float radius = balls[i].radius;
    const int rings = radius > 0.4f ? 44 : radius > 0.2f ? 26 : radius > 0.1f ? 16 : 12;
    append(byMaterial[i < 3 ? i : i % byMaterial.size()], sphere(radius, rings),
           translation(balls[i].centre));
  }
  for (std::size_t m = 0; m < byMaterial.size(); ++m) {
    scene.add("balls_" + scene.materials[static_cast<std::size_t>(materials[m])].name,
              std::move(byMaterial[m]), materials[m]);
  }

  scene.addAreaLight("key", {-2.8f, 3.6f, 0.9f}, {0, 0.2f, 0}, {1.2f, 1.2f}, 55, {1, 0.96f, 0.9f}, 52);
  scene.addCamera("main", {0.3f, 2.5f, 5.0f}, {0, 0.35f, 0}, 38);
  scene.addCamera("close", {-0.4f, 0.9f, 2.6f}, {-0.15f, 0.2f, 0.2f}, 36);
  scene.addCamera("top", {0, 6.5f, 0.4f}, {0, 0, 0.1f}, 40);
  return scene;
}

}  // namespace limn::assets
