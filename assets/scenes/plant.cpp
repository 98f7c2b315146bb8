// A potted fig: branching stems and well over a thousand curved leaves, all of them geometry.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "assets/generator/random.h"
#include "assets/generator/shapes.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

constexpr float kGoldenAngle = 2.39996323f;

/// A leaf of length 1 along +Y, its upper side towards +Z: folded along the midrib, drooping, wavy at the
/// margin.
Mesh leafShape(float droop, float fold, float wave) {
  return surface(4, 8, [=](glm::vec2 uv) {
    const float t = uv.y, across = 2 * uv.x - 1;
    const float width =
        0.27f * std::pow(std::max(std::sin(glm::pi<float>() * std::pow(t, 0.75f)), 0.0f), 0.85f) +
        0.004f * (1 - t);
    const float bend = droop * t * t;
    const float lift = width * (fold * std::abs(across) + wave * across * across * std::sin(9 * t + across));
    const glm::vec3 rib(0, std::sin(bend) / std::max(droop * t, 1e-3f),
                        -(1 - std::cos(bend)) / std::max(droop * t, 1e-3f));
    return rib + glm::vec3(across * width, 0, 0) + lift * glm::vec3(0, std::sin(bend), std::cos(bend));
  });
}

Image leafImage() {
  return makeImage(128, 256, [](glm::vec2 uv) {
    const float x = std::abs(uv.x - 0.5f), y = uv.y;
    const float rib = glm::smoothstep(0.035f, 0.012f, x);
    const float vein =
        0.55f * glm::smoothstep(0.012f, 0.003f, std::abs(std::fmod(y + 0.35f * x + 1, 0.1f) - 0.05f));
    const float cloud = periodicFractal(uv * 6.0f, 6, 3, 12);
    return glm::vec4(glm::mix(glm::vec3(0.55f, 0.75f, 0.35f) * (0.8f + 0.4f * cloud),
                              glm::vec3(0.95f, 1, 0.7f), std::max(rib, 0.5f * vein)),
                     1);
  });
}

class Fig {
 public:
  Fig() {
    for (int i = 0; i < kShapes; ++i) {
      const float s = static_cast<float>(i) / (kShapes - 1);
      shapes_[i] = leafShape(0.35f + 0.7f * s, 0.5f - 0.25f * s, 0.1f + 0.15f * s);
    }
    for (int i = 0; i < 6; ++i) {
      const float turn = kGoldenAngle * static_cast<float>(i),
                  lean = i == 0 ? 0.05f : random_.uniform(0.35f, 0.75f);
      const glm::vec3 foot(0.07f * std::cos(turn), 0.36f, 0.07f * std::sin(turn));
      branch(foot, {lean * std::cos(turn), 1, lean * std::sin(turn)}, random_.uniform(0.85f, 1.2f), 0.017f,
             0);
    }
  }

  Mesh wood;
  static constexpr int kTints = 3;
  Mesh leaves[kTints];

 private:
  void branch(glm::vec3 start, glm::vec3 direction, float length, float radius, int level) {
    constexpr int steps = 9;
    std::vector<glm::vec3> path = {start};
    std::vector<float> radii = {radius};
    direction = glm::normalize(direction);
    const float phase = random_.uniform(0, 2 * glm::pi<float>());
    for (int i = 1; i <= steps; ++i) {
      const float t = static_cast<float>(i) / steps;
      const glm::vec3 wander(random_.uniform(-1, 1), random_.uniform(-0.3f, 0.6f), random_.uniform(-1, 1));
      direction =
          glm::normalize(direction + 0.13f * wander + glm::vec3(0, level == 0 ? 0.03f : 0.06f - 0.1f * t, 0));
      path.push_back(path.back() + direction * (length / steps));
      radii.push_back(radius * (1 - 0.72f * t));
      const float turn = phase + kGoldenAngle * static_cast<float>(i);
      if (level == 0 ? i >= 3 : level == 1 && random_.uniform() < 0.22f)
        fork(path.back(), direction, turn, length * (1.05f - 0.5f * t), radii.back(), level);
      if (level > 0 || i >= 6) {
        for (int k = 0; k < (level == 0 ? 1 : 2); ++k)
          leaf(path.back(), direction, turn + 1.2f + glm::pi<float>() * static_cast<float>(k));
      }
    }
    leaf(path.back(), direction, phase);
    append(wood, tube(path, radii, level == 0 ? 12 : level == 1 ? 8 : 5));
  }

  void fork(glm::vec3 at, glm::vec3 direction, float turn, float length, float radius, int level) {
    const glm::vec3 out = sideways(direction, turn);
    branch(at, direction * random_.uniform(0.5f, 0.8f) + out * 0.8f, length * random_.uniform(0.36f, 0.5f),
           radius * 0.6f, level + 1);
  }

  static glm::vec3 sideways(glm::vec3 axis, float turn) {
    const glm::vec3 a =
        glm::normalize(glm::cross(axis, std::abs(axis.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
    return std::cos(turn) * a + std::sin(turn) * glm::cross(axis, a);
  }

  /// A stalk and a blade that turns its upper side to the light.
  void leaf(glm::vec3 at, glm::vec3 direction, float turn) {
    if (at.y < 0.52f || random_.uniform() < 0.2f) return;
    const glm::vec3 out = sideways(direction, turn);
    const float size = random_.uniform(0.08f, 0.15f);
    glm::vec3 forward =
        glm::normalize(out + 0.55f * direction + glm::vec3(0, random_.uniform(-0.3f, 0.25f), 0));
    const glm::vec3 knee = at + 0.22f * size * forward;
    const glm::vec3 stalk[] = {at, knee};
    const float radii[] = {0.0022f, 0.0016f};
    append(wood, tube(stalk, radii, 4, false));
    glm::vec3 up = glm::vec3(0, 1, 0) + 0.3f * out +
                   glm::vec3(random_.uniform(-0.35f, 0.35f), 0, random_.uniform(-0.35f, 0.35f));
    up = glm::normalize(up - forward * glm::dot(forward, up));
    const glm::mat4 frame(glm::vec4(size * glm::cross(forward, up), 0), glm::vec4(size * forward, 0),
                          glm::vec4(size * up, 0), glm::vec4(knee, 1));
    const int tint = random_.uniform() < 0.25f ? 2 : random_.uniform() < 0.5f ? 1 : 0;
    append(leaves[tint], shapes_[static_cast<int>(random_.uniform() * kShapes)], frame);
  }

  static constexpr int kShapes = 5;
  Mesh shapes_[kShapes];
  Random random_{41};
};

void addPot(Scene& scene) {
  const std::vector<glm::vec2> pot = {{0, 0.03f},       {0.17f, 0.03f},   {0.185f, 0.045f}, {0.25f, 0.33f},
                                      {0.275f, 0.335f}, {0.285f, 0.345f}, {0.285f, 0.4f},   {0.278f, 0.41f},
                                      {0.255f, 0.41f},  {0.248f, 0.4f},   {0.24f, 0.34f},   {0.0f, 0.36f}};
  const std::vector<glm::vec2> saucer = {{0, 0},          {0.22f, 0},       {0.26f, 0.035f},  {0.27f, 0.037f},
                                         {0.27f, 0.045f}, {0.255f, 0.045f}, {0.215f, 0.015f}, {0, 0.015f}};
  Mesh clay = lathe(pot, 96);
  append(clay, lathe(saucer, 96));
  Material terracotta = glossy("terracotta", {1, 1, 1}, 0.9f);
  terracotta.baseColourTexture =
      scene.addTexture("terracotta", plasterImage(256, {0.5f, 0.21f, 0.12f}, 0.45f));
  scaleUv(clay, {3, 1.5f});
  scene.add("pot", std::move(clay), scene.addMaterial(terracotta));

  Random random(9);
  Mesh soil = transformed(sphere(0.235f, 20), translation({0, 0.345f, 0}) * scaling({1, 0.12f, 1}));
  for (int i = 0; i < 160; ++i) {
    const float r = 0.22f * std::sqrt(random.uniform()), a = random.uniform(0, 2 * glm::pi<float>()),
                size = random.uniform(0.006f, 0.016f);
    append(soil, sphere(1, 5),
           translation({r * std::cos(a), 0.37f - 0.25f * r * r, r * std::sin(a)}) *
               rotation(random.uniform(0, 360), {1, 1, 0}) * scaling({size, 0.7f * size, 1.2f * size}));
  }
  scene.add("soil", std::move(soil), scene.addMaterial(lambert("soil", {0.09f, 0.06f, 0.04f})));
}

}  // namespace

Scene makePlant() {
  Scene scene;
  Material floor = lambert("floor", {1, 1, 1});
  floor.baseColourTexture = scene.addTexture("plaster", plasterImage(512, {0.6f, 0.57f, 0.52f}, 0.18f));
  scene.add("floor", backdrop(5, 3.5f, 1.9f, 4, 2), scene.addMaterial(floor));
  addPot(scene);

  Fig fig;
  scene.add("stems", std::move(fig.wood), scene.addMaterial(lambert("bark", {0.2f, 0.15f, 0.1f})));
  const int texture = scene.addTexture("leaf", leafImage());
  const glm::vec3 tints[] = {{0.26f, 0.5f, 0.18f}, {0.38f, 0.66f, 0.22f}, {0.62f, 0.8f, 0.28f}};
  for (int i = 0; i < Fig::kTints; ++i) {
    const std::string name = "leaves_" + std::to_string(i);
    Material leaf = glossy(name, tints[i], 0.6f);
    leaf.baseColourTexture = texture;
    leaf.doubleSided = true;
    scene.add(name, std::move(fig.leaves[i]), scene.addMaterial(leaf));
  }
  scene.addAreaLight("key", {-1.9f, 3.3f, 1.6f}, {0, 0.9f, 0}, {0.4f, 0.4f}, 34, {1, 0.96f, 0.88f}, 52);
  scene.addCamera("main", {0.5f, 1.35f, 4.3f}, {0, 0.84f, 0}, 32);
  scene.addCamera("close", {-0.15f, 1.4f, 1.6f}, {0.02f, 1.05f, 0}, 36);
  scene.addCamera("floor", {1.6f, 1.1f, 1.5f}, {0.75f, 0, -0.35f}, 42);
  return scene;
}

}  // namespace limn::assets
