// A bust of skin whose pores and wrinkles are a height map: light and its shadows blur below the surface, the
// bumps' own shading does not.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "assets/generator/implicit.h"
#include "assets/generator/shapes.h"
#include "assets/scenes/relief.h"
#include "assets/scenes/scenes.h"
#include "assets/scenes/translucent.h"

namespace limn::assets {
namespace {

/// Looks towards +Z, chin to crown from y = -0.12 to 0.115; the neck is cut off at -0.18.
float bust(glm::vec3 p) {
  const glm::vec3 q(std::abs(p.x), p.y, p.z);
  float d = ellipsoid(p, {0, 0.02f, -0.015f}, {0.075f, 0.095f, 0.095f});
  d = smoothUnion(d, ellipsoid(p, {0, -0.035f, 0.02f}, {0.06f, 0.08f, 0.066f}), 0.03f);
  d = smoothUnion(d, ellipsoid(p, {0, -0.1f, 0.062f}, {0.024f, 0.02f, 0.02f}), 0.025f);  // chin
  d = smoothUnion(d, ellipsoid(q, {0.038f, -0.022f, 0.06f}, glm::vec3(0.024f)), 0.03f);  // cheeks
  d = smoothUnion(d, roundCone(q, {0.012f, 0.03f, 0.08f}, {0.045f, 0.03f, 0.064f}, 0.008f, 0.007f), 0.02f);
  d = smoothCut(d, ellipsoid(q, {0.031f, 0.01f, 0.09f}, {0.019f, 0.013f, 0.016f}), 0.016f);      // sockets
  d = smoothUnion(d, ellipsoid(q, {0.031f, 0.009f, 0.068f}, {0.014f, 0.011f, 0.013f}), 0.006f);  // eyes
  d = smoothUnion(d, roundCone(p, {0, 0.018f, 0.08f}, {0, -0.028f, 0.1f}, 0.008f, 0.012f), 0.014f);  // nose
  d = smoothUnion(d, ellipsoid(q, {0.011f, -0.032f, 0.092f}, glm::vec3(0.009f)), 0.008f);
  d = smoothUnion(d, ellipsoid(p, {0, -0.061f, 0.084f}, {0.021f, 0.006f, 0.009f}), 0.008f);  // lips
  d = smoothUnion(d, ellipsoid(p, {0, -0.073f, 0.082f}, {0.018f, 0.006f, 0.009f}), 0.008f);
  d = smoothUnion(d, ellipsoid(q, {0.076f, 0, -0.012f}, {0.009f, 0.032f, 0.02f}), 0.01f);  // ears
  d = smoothUnion(d, roundCone(p, {0, -0.07f, -0.02f}, {0, -0.2f, -0.03f}, 0.05f, 0.06f), 0.03f);
  return smoothCut(d, p.y + 0.18f, 0.008f);
}

/// The outermost point of the bust in a direction from its axis. u goes once around from the back; v goes
/// down from the crown to the middle of the base, on rays that start lower and slope more below the eyes.
glm::vec3 onBust(glm::vec2 uv) {
  // The seam and both ends meet to the bit.
  const float turn = uv.y > 0 && uv.y < 1 && uv.x < 1 ? uv.x : 0;
  const float around = 2 * glm::pi<float>() * turn, below = std::max(uv.y - 0.4f, 0.0f) / 0.6f;
  const float elevation = uv.y < 0.4f ? 90 * (1 - uv.y / 0.4f) : -90 * below * below;
  const glm::vec3 start(0, glm::mix(0.01f, -0.13f, glm::smoothstep(0.0f, 0.8f, below)), -0.012f);
  const float level = std::cos(glm::radians(elevation));
  const glm::vec3 along(level * std::sin(around), std::sin(glm::radians(elevation)),
                        -level * std::cos(around));
  float reach = 0.2f;
  for (int i = 0; i < 200; ++i) {
    const float d = bust(start + reach * along);
    reach -= 0.6f * d;
    if (d < 1e-6f) break;
  }
  return start + reach * along;
}

/// Mean metres per unit of u and v over the area.
glm::vec2 metresPerUv(const Mesh& mesh) {
  glm::dvec2 sum(0);
  double area = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    const glm::dvec3 e(mesh.positions[b] - mesh.positions[a]), f(mesh.positions[c] - mesh.positions[a]);
    const glm::dvec2 s(mesh.uvs[b] - mesh.uvs[a]), t(mesh.uvs[c] - mesh.uvs[a]);
    const double turn = s.x * t.y - t.x * s.y, twice = glm::length(glm::cross(e, f));
    sum +=
        twice * glm::dvec2(glm::length(t.y * e - s.y * f), glm::length(s.x * f - t.x * e)) / std::abs(turn);
    area += twice;
  }
  return sum / area;
}

}  // namespace

Scene makeTranslucentHead() {
  Scene scene;
  Mesh head = surface(128, 128, onBust);
  scaleUv(head, {12, 12});
  Material material = skin("skin", 0.45f);
  material.height = addHeights(scene, "pores", {128, 128}, metresPerUv(head),
                               [](double u, double v) { return 0.4 * noiseRelief(u, v); });
  const int node = scene.add("head", std::move(head), scene.addMaterial(material));
  scene.nodes[static_cast<std::size_t>(node)].translation = {0, 0.181f, 0};
  scene.add("floor", backdrop(0.8f, 0.5f, 0.4f, 0.8f, 1),
            scene.addMaterial(lambert("floor", {0.22f, 0.23f, 0.25f})));
  scene.addAreaLight("key", {-0.6f, 0.55f, 0.4f}, {0, 0.18f, 0}, {0.02f, 0.02f}, 4, {1, 0.97f, 0.92f}, 50);
  scene.addCamera("main", {0.12f, 0.24f, 0.75f}, {0, 0.165f, 0}, 28);
  scene.addCamera("close", {0.08f, 0.2f, 0.38f}, {0.01f, 0.165f, 0.05f}, 26);
  return scene;
}

}  // namespace limn::assets
