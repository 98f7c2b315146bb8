// A late afternoon as an environment map, and scenes that it lights alone.
#include <algorithm>
#include <cmath>

#include "assets/generator/random.h"
#include "assets/generator/shapes.h"
#include "assets/scenes/scenes.h"
#include "assets/scenes/soldier.h"
#include "glsl/numeric/equirectangular.glsl"

namespace limn::assets {
namespace {

using glm::vec3;

/// Degrees: azimuth from -z towards +x, elevation above the horizon.
vec3 direction(float azimuth, float elevation) {
  const float a = glm::radians(azimuth), e = glm::radians(elevation);
  return {std::cos(e) * std::sin(a), std::sin(e), -std::cos(e) * std::cos(a)};
}

/// A sun behind haze, `width` degrees across at 1/e of its radiance.
float lobe(vec3 d, vec3 towards, float width) {
  const float angle = glm::degrees(std::acos(glm::clamp(glm::dot(d, towards), -1.0f, 1.0f)));
  return std::exp(-4 * (angle / width) * (angle / width));
}

/// A bright rectangle, degrees; panes divided by bars.
float window(float azimuth, float elevation, glm::vec2 centre, glm::vec2 size) {
  const glm::vec2 p = (glm::vec2(azimuth, elevation) - centre) / size + 0.5f;
  if (p.x < 0 || p.y < 0 || p.x > 1 || p.y > 1) return 0;
  const glm::vec2 pane = glm::fract(p * glm::vec2(2, 3));
  const glm::vec2 bar = 0.6f / size * glm::vec2(2, 3);
  return pane.x > bar.x && pane.x < 1 - bar.x && pane.y > bar.y && pane.y < 1 - bar.y ? 1.0f : 0.0f;
}

vec3 skyRadiance(glm::vec2 uv) {
  const vec3 d = glsl::equirectangular_direction(uv);
  const float elevation = glm::degrees(std::asin(glm::clamp(d.y, -1.0f, 1.0f))),
              azimuth = 360 * (uv.x - 0.5f);
  const vec3 sun = direction(-62, 34);
  if (d.y < 0) return vec3(0.055f, 0.047f, 0.038f) * (1 + 2 * lobe(d, direction(-62, 0), 90));
  const float cloud = periodicFractal({12 * uv.x, 12 * uv.y}, 12, 5, 3);
  vec3 sky = glm::mix(vec3(0.42f, 0.36f, 0.3f), vec3(0.07f, 0.14f, 0.3f), std::pow(d.y, 0.45f));
  sky += 0.5f * glm::smoothstep(0.5f, 0.8f, cloud) * vec3(0.5f, 0.47f, 0.45f) * std::min(4 * d.y, 1.0f);
  const float glow = std::exp(-elevation / 7) * (0.35f + 0.65f * lobe(d, direction(-62, 0), 110));
  sky += glow * vec3(1.5f, 0.85f, 0.4f);
  sky += lobe(d, sun, 45) * vec3(1.3f, 1.0f, 0.7f) + lobe(d, sun, 9) * vec3(130, 108, 80);
  sky += window(azimuth, elevation, {78, 26}, {26, 30}) * vec3(7, 7.6f, 8.4f);
  sky += window(azimuth, elevation, {128, 22}, {18, 24}) * vec3(4.2f, 4.5f, 5);
  return sky;
}

/// Nothing but the sky lights it.
Scene underSky(Scene scene) {
  scene.lights.clear();
  std::erase_if(scene.nodes, [](const Node& node) { return node.light >= 0; });
  scene.environment = makeSky();
  return scene;
}

}  // namespace

Image makeSky() {
  // The mean of 3 x 3 directions per pixel: small bright parts keep their energy.
  return makeImage(512, 256, [](glm::vec2 uv) {
    vec3 sum(0);
    for (int i = 0; i < 9; ++i)
      sum += skyRadiance(uv + glm::vec2(i % 3 - 1, i / 3 - 1) / (3.0f * glm::vec2(512, 256)));
    return glm::vec4(sum / 9.0f, 1);
  });
}

Scene makeBallsSky() {
  return underSky(makeBalls());
}

Scene makePatrol() {
  Scene scene;
  Material earth = lambert("earth", {1, 1, 1});
  earth.baseColourTexture = scene.addTexture("earth", plasterImage(512, {0.4f, 0.31f, 0.21f}, 0.6f));
  scene.add("floor", backdrop(14, 12, 8, 8, 3), scene.addMaterial(earth));
  Node patrol{.name = "soldiers"};
  patrol.mesh = scene.addMesh("soldier", soldier::build(scene));
  Random random(31);
  for (int i = 0; i < 10; ++i) {
    const glm::vec3 at(1.25f * static_cast<float>(i % 5 - 2) + random.uniform(-0.15f, 0.15f), 0,
                       0.8f - 1.7f * static_cast<float>(i / 5) + random.uniform(-0.2f, 0.2f));
    const glm::quat turn = glm::angleAxis(glm::radians(random.uniform(-15, 15)), glm::vec3(0, 1, 0));
    patrol.instances.push_back({at, turn, glm::vec3(random.uniform(0.95f, 1.05f))});
  }
  scene.addNode(std::move(patrol));
  scene.addCamera("main", {2.6f, 2.4f, 6.2f}, {0.1f, 0.75f, 0}, 36);
  scene.addCamera("close", {-1.2f, 1.6f, 3.6f}, {-0.6f, 0.9f, 0.6f}, 40);
  return underSky(std::move(scene));
}

}  // namespace limn::assets
