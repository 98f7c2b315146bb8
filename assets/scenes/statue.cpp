// A dancer carved from one block: a closed surface with folds, thin parts and openings, on a turned plinth.
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "assets/generator/implicit.h"
#include "assets/generator/shapes.h"
#include "assets/generator/simplify.h"
#include "assets/scenes/rose_window.h"
#include "assets/scenes/scenes.h"
#include "assets/scenes/translucent.h"

namespace limn::assets {
namespace {

/// The skirt: a bell whose pleats deepen and turn towards the hem.
float skirt(glm::vec3 p) {
  const glm::vec3 axis(0.05f * std::sin(2.2f * p.y), p.y, 0);
  const glm::vec2 q(p.x - axis.x, p.z);
  const float s = glm::clamp((1.14f - p.y) / 1.0f, 0.0f, 1.0f);  // 0 at the waist, 1 at the hem
  const float angle = std::atan2(q.y, q.x) + 1.5f * s;
  const float depth = 0.075f * s * s + 0.008f * s;
  const float fold = std::cos(9 * angle + 0.7f * std::sin(2 * angle)) + 0.25f * std::cos(18 * angle + 3 * s);
  const float sway = 0.07f * s * s * std::cos(angle - 2.2f);
  const float radius = 0.115f + 0.1f * std::pow(s, 0.6f) + 0.3f * s * s * s + sway + depth * fold;
  const float hem = 0.17f + 0.035f * std::cos(3 * angle) + 0.02f * std::cos(9 * angle) - p.y;
  const float side = (glm::length(q) - radius) * 0.62f;
  const float bell = smoothCut(std::max(side, p.y - 1.14f), -hem, 0.03f);
  // Hollow from below, so that the hem is a sheet with the legs inside it.
  const float inner = radius - depth * (fold + 1.25f) - 0.035f;
  const float hollow = std::max((glm::length(q) - inner) * 0.62f, p.y - 0.62f);
  return smoothCut(bell, hollow, 0.03f);
}

float torso(glm::vec3 p) {
  float d = roundCone(p, {0.03f, 1.1f, 0}, {0, 1.32f, 0.01f}, 0.1f, 0.125f);
  d = smoothUnion(d, ellipsoid(p, {-0.005f, 1.38f, 0}, {0.175f, 0.13f, 0.105f}), 0.08f);
  d = smoothUnion(d, ellipsoid(p, {-0.065f, 1.36f, 0.085f}, {0.06f, 0.06f, 0.055f}), 0.05f);
  d = smoothUnion(d, ellipsoid(p, {0.06f, 1.36f, 0.085f}, {0.06f, 0.06f, 0.055f}), 0.05f);
  d = smoothUnion(d, roundCone(p, {-0.01f, 1.46f, -0.01f}, {-0.03f, 1.6f, 0.01f}, 0.055f, 0.046f), 0.07f);
  // Carved girdle.
  const float ring = std::abs(std::sin(60 * p.y + 6 * std::sin(2 * std::atan2(p.z, p.x)))) * 0.006f;
  return d + (p.y > 1.06f && p.y < 1.2f ? ring * std::sin(glm::pi<float>() * (p.y - 1.06f) / 0.14f) : 0);
}

float head(glm::vec3 p) {
  const glm::vec3 centre(-0.045f, 1.7f, 0.02f);
  // Tilted and turned: work in the head's own frame.
  glm::vec3 q = p - centre;
  const float c = std::cos(0.35f), s = std::sin(0.35f);
  q = {c * q.x + s * q.y, -s * q.x + c * q.y, q.z};
  float d = ellipsoid(q, {0, 0, 0}, {0.082f, 0.115f, 0.1f});
  d = smoothUnion(d, ellipsoid(q, {0, -0.06f, 0.045f}, {0.05f, 0.055f, 0.05f}), 0.05f);             // jaw
  d = smoothUnion(d, roundCone(q, {0, 0.03f, 0.094f}, {0, -0.03f, 0.115f}, 0.01f, 0.016f), 0.03f);  // nose
  for (const float side : {-1.0f, 1.0f}) {
    d = smoothCut(d, ellipsoid(q, {side * 0.036f, 0.012f, 0.108f}, {0.024f, 0.014f, 0.025f}), 0.02f);
  }
  d = smoothUnion(d, ellipsoid(q, {0, -0.058f, 0.096f}, {0.022f, 0.009f, 0.012f}), 0.012f);  // lips
  // Hair: a cap with combed grooves and a knot.
  const float comb = 0.004f * std::cos(34 * std::atan2(q.y - 0.02f, q.x));
  const float cap = ellipsoid(q, {0, 0.028f, -0.022f}, {0.096f, 0.112f, 0.106f}) + comb;
  d = smoothUnion(d, cap, 0.012f);
  const float coil =
      0.005f * std::cos(9 * std::atan2(q.y - 0.1f, q.x) + 90 * glm::length(glm::vec2(q.x, q.y - 0.1f)));
  return smoothUnion(d, ellipsoid(q, {0, 0.1f, -0.1f}, {0.065f, 0.06f, 0.06f}) + coil, 0.02f);
}

float hand(glm::vec3 p, glm::vec3 wrist, glm::vec3 along, glm::vec3 spread) {
  const glm::vec3 palm = wrist + 0.06f * along;
  float d = roundCone(p, wrist, palm, 0.024f, 0.03f);
  for (int finger = 0; finger < 4; ++finger) {
    const float at = (static_cast<float>(finger) - 1.5f) / 1.5f;
    const glm::vec3 root = palm + 0.024f * at * spread + 0.012f * along;
    const glm::vec3 tip =
        root + (0.085f - 0.012f * std::abs(at)) * glm::normalize(along + 0.25f * at * spread);
    d = smoothUnion(d, roundCone(p, root, tip, 0.0155f, 0.0125f), 0.012f);
  }
  const glm::vec3 thumb = wrist + 0.025f * along - 0.022f * spread;
  return smoothUnion(
      d, roundCone(p, thumb, thumb + 0.05f * glm::normalize(along - 1.2f * spread), 0.013f, 0.01f), 0.014f);
}

float arms(glm::vec3 p) {
  const glm::vec3 rightShoulder(0.155f, 1.42f, 0), rightElbow(0.36f, 1.66f, 0.06f),
      rightWrist(0.2f, 1.93f, 0.1f);
  const glm::vec3 leftShoulder(-0.165f, 1.41f, 0), leftElbow(-0.43f, 1.36f, 0.06f),
      leftWrist(-0.64f, 1.52f, 0.16f);
  float right = roundCone(p, rightShoulder, rightElbow, 0.058f, 0.043f);
  right = smoothUnion(right, roundCone(p, rightElbow, rightWrist, 0.043f, 0.027f), 0.03f);
  right = smoothUnion(
      right, hand(p, rightWrist, glm::normalize(glm::vec3(-0.8f, 0.5f, 0.1f)), {0.3f, 0.2f, -0.9f}), 0.02f);
  float left = roundCone(p, leftShoulder, leftElbow, 0.058f, 0.043f);
  left = smoothUnion(left, roundCone(p, leftElbow, leftWrist, 0.043f, 0.027f), 0.03f);
  left = smoothUnion(
      left, hand(p, leftWrist, glm::normalize(glm::vec3(-0.75f, 0.55f, 0.3f)), {0.1f, 0.35f, 0.9f}), 0.02f);
  return std::min(left, right);
}

/// A veil from the raised hand around the back to the outstretched one and down to the hem: a band along a
/// curve, its frame carried without twist, its edges rippled.
class Veil {
 public:
  Veil() {
    const glm::vec3 knots[] = {{0.16f, 1.97f, 0.1f},   {0.34f, 1.82f, -0.12f}, {0.42f, 1.5f, -0.3f},
                               {0.25f, 1.2f, -0.42f},  {-0.1f, 1.12f, -0.44f}, {-0.42f, 1.26f, -0.3f},
                               {-0.62f, 1.5f, -0.02f}, {-0.68f, 1.55f, 0.17f}, {-0.66f, 1.36f, 0.3f},
                               {-0.56f, 1.02f, 0.34f}, {-0.5f, 0.66f, 0.36f},  {-0.44f, 0.42f, 0.3f}};
    path_ = spline(std::span<const glm::vec3>(knots), 5);
    glm::vec3 tall(0.6f, 0.3f, 0.6f);
    for (std::size_t i = 0; i < path_.size(); ++i) {
      const glm::vec3 along =
          glm::normalize(path_[std::min(i + 1, path_.size() - 1)] - path_[i > 0 ? i - 1 : 0]);
      tall = glm::normalize(tall - along * glm::dot(along, tall));
      tall_.push_back(tall);
    }
  }

  float operator()(glm::vec3 p) const {
    float best = 1e9f;
    for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
      const glm::vec3 ab = path_[i + 1] - path_[i];
      const float t = glm::clamp(glm::dot(p - path_[i], ab) / glm::dot(ab, ab), 0.0f, 1.0f);
      const glm::vec3 offset = p - (path_[i] + t * ab);
      const float away = glm::length(offset);
      if (0.75f * (away - 0.13f) > best) continue;
      const float along = (static_cast<float>(i) + t) / static_cast<float>(path_.size() - 1);
      const glm::vec3 tall = glm::normalize(glm::mix(tall_[i], tall_[i + 1], t));
      const float reach = 0.03f + 0.075f * std::sin(glm::pi<float>() * along);
      const float x = glm::dot(offset, tall), flat = std::sqrt(std::max(away * away - x * x, 0.0f));
      const glm::vec3 thin = glm::normalize(glm::cross(ab, tall));
      const float ripple = 0.018f * std::sin(40 * along + (x > 0 ? 1.5f : 0)) * x * x / (reach * reach);
      const float y =
          std::abs(glm::dot(offset, thin) + ripple) + std::max(flat - std::abs(glm::dot(offset, thin)), 0.0f);
      best =
          std::min(best, 0.75f * (glm::length(glm::vec2(std::max(std::abs(x) - reach, 0.0f), y)) - 0.014f));
    }
    return best;
  }

 private:
  std::vector<glm::vec3> path_, tall_;
};

float legsAndPlinth(glm::vec3 p) {
  float d = roundCone(p, {0.05f, 0.9f, 0}, {0.09f, 0.14f, 0.03f}, 0.085f, 0.036f);
  d = std::min(d, roundCone(p, {-0.04f, 0.9f, 0}, {-0.1f, 0.16f, -0.06f}, 0.085f, 0.036f));
  d = smoothUnion(d, roundCone(p, {0.09f, 0.11f, 0.02f}, {0.12f, 0.09f, 0.17f}, 0.036f, 0.022f), 0.03f);
  d = smoothUnion(d, roundCone(p, {-0.1f, 0.12f, -0.08f}, {-0.15f, 0.08f, 0.03f}, 0.034f, 0.022f), 0.03f);
  // Turned plinth: a stack of rounded discs.
  const float r = glm::length(glm::vec2(p.x, p.z));
  constexpr glm::vec3 discs[] = {
      {0.38f, 0.03f, 0.03f}, {0.42f, -0.04f, 0.035f}, {0.37f, -0.13f, 0.06f}, {0.46f, -0.225f, 0.04f}};
  for (const glm::vec3& disc : discs) {  // radius, height, half thickness
    const glm::vec2 q(r - (disc.x - disc.z), std::abs(p.y - disc.y));
    const float rounded =
        glm::length(glm::max(q, glm::vec2(0))) + std::min(std::max(q.x, q.y), 0.0f) - disc.z;
    d = smoothUnion(d, rounded, 0.02f);
  }
  return d;
}

/// A part of the figure, replaced by the distance to its bounding sphere where that is large: blends reach
/// 0.05 at most.
template <class Part>
float within(glm::vec3 p, glm::vec3 centre, float radius, const Part& part) {
  const float away = glm::distance(p, centre) - radius;
  return away > 0.1f ? away : part(p);
}

Mesh dancer(float cell) {
  const Veil veil;
  const Distance figure = [&](glm::vec3 p) {
    float d = smoothUnion(skirt(p), within(p, {0, 1.3f, 0}, 0.42f, torso), 0.04f);
    d = smoothUnion(d, within(p, {-0.15f, 1.65f, 0.05f}, 0.75f, arms), 0.045f);
    d = smoothUnion(d, within(p, {-0.05f, 1.72f, 0}, 0.25f, head), 0.025f);
    d = smoothUnion(d, legsAndPlinth(p), 0.015f);
    return smoothUnion(d, veil(p), 0.012f);
  };
  return polygonise(figure, {-0.95f, -0.32f, -0.8f}, {0.8f, 2.2f, 0.8f}, cell);
}

}  // namespace

Scene makeStatue() {
  Scene scene;
  Material floor = lambert("floor", {1, 1, 1});
  floor.baseColourTexture = scene.addTexture("plaster", plasterImage(512, {0.4f, 0.42f, 0.45f}, 0.25f));
  scene.add("floor", backdrop(6, 4, 2.6f, 4.5f, 2.5f), scene.addMaterial(floor));
  const int stone = scene.addMaterial(glossy("stone", {0.72f, 0.68f, 0.61f}, 0.65f));
  const int statue = scene.add("statue", dancer(0.015f), stone);
  scene.nodes[static_cast<std::size_t>(statue)].translation = {0, 0.266f, 0};
  scene.addAreaLight("key", {-2.2f, 3.6f, 2.2f}, {0, 1.1f, 0}, {0.9f, 0.9f}, 44, {1, 0.95f, 0.88f}, 52);
  scene.addCamera("main", {0.9f, 1.6f, 4.9f}, {-0.05f, 1.18f, 0}, 34);
  scene.addCamera("close", {0.3f, 1.95f, 2.1f}, {-0.06f, 1.82f, 0}, 38);
  return scene;
}

Scene makeGlassStatue() {
  Scene scene;
  scene.add("floor", ground(3, 3, 1), scene.addMaterial(lambert("floor", {0.5f, 0.5f, 0.5f})));
  Mesh figure = dancer(0.018f);
  const int statue = scene.add("statue", std::move(figure), scene.addMaterial(glass("glass", 1.5f)));
  Node& node = scene.nodes[static_cast<std::size_t>(statue)];
  node.translation = {0, 0.28f, 0};
  Animation turn{"turn", {{.node = statue, .times = {}, .rotations = {}, .translations = {}}}};
  for (int quarter = 0; quarter <= 4; ++quarter) {
    turn.channels[0].times.push_back(2.0f * static_cast<float>(quarter));
    turn.channels[0].rotations.push_back(
        glm::angleAxis(0.5f * glm::pi<float>() * static_cast<float>(quarter), glm::vec3(0, 1, 0)));
  }
  scene.animations.push_back(turn);
  scene.medium = {.sigmaA = 0.01f, .sigmaS = 0.08f, .g = 0};
  scene.addLight(
      "key", {.type = Light::Type::spot, .intensity = 260, .innerConeAngle = 0.3f, .outerConeAngle = 0.42f},
      {-2.6f, 4.4f, 0.8f}, {0, 1.2f, 0});
  scene.addCamera("main", {0.4f, 1.6f, 5.6f}, {0.1f, 1.15f, 0}, 36);
  scene.addCamera("close", {0.3f, 1.5f, 2.8f}, {0.1f, 1.1f, 0}, 38);
  return scene;
}

// A figurine: at the size of the statue light would hardly leave the place where it entered.
Scene makeMarbleStatue() {
  constexpr float scale = 0.12f;
  Scene scene;
  scene.add("floor", backdrop(0.7f, 0.5f, 0.35f, 0.6f, 1),
            scene.addMaterial(lambert("floor", {0.3f, 0.3f, 0.32f})));
  Mesh figure = transformed(simplified(dancer(0.02f), 80'000), scaling(glm::vec3(scale)));
  const int statue = scene.add("statue", std::move(figure), scene.addMaterial(marble("marble")));
  scene.nodes[static_cast<std::size_t>(statue)].translation = {0, 0.268f * scale, 0};
  Light key{.type = Light::Type::spot, .intensity = 1.8f, .innerConeAngle = 0.3f, .outerConeAngle = 0.33f};
  key.texture = scene.addTexture("window", roseWindow());
  scene.addLight("key", key, {-0.36f, 0.42f, 0.42f}, {0, 0.14f, 0});
  scene.addCamera("main", {0.11f, 0.2f, 0.6f}, {0.006f, 0.145f, 0}, 29);
  scene.addCamera("close", {0.04f, 0.235f, 0.25f}, {-0.007f, 0.2f, 0}, 36);
  return scene;
}

}  // namespace limn::assets
