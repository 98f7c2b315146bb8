#include "assets/scenes/soldier.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "assets/generator/implicit.h"
#include "assets/generator/random.h"
#include "assets/generator/shapes.h"

namespace limn::assets::soldier {
namespace {

const glm::vec3 kGrip(-0.37f, 1.2f, 0.27f);  ///< the hand at the spear
const glm::vec3 kShield(0.2f, 1.1f, 0.33f);

float mirrored(float x) {
  return std::abs(x);
}

/// Arms, hands, thighs, neck and the face behind the helmet.
float skin(glm::vec3 p) {
  float right = roundCone(p, {-0.205f, 1.44f, -0.01f}, {-0.33f, 1.17f, -0.01f}, 0.06f, 0.045f);
  right = smoothUnion(right, ellipsoid(p, {-0.27f, 1.31f, 0.005f}, {0.055f, 0.09f, 0.055f}), 0.05f);
  right = smoothUnion(
      right, roundCone(p, {-0.33f, 1.17f, -0.01f}, kGrip + glm::vec3(0.02f, 0, -0.04f), 0.047f, 0.032f),
      0.03f);
  float fist = ellipsoid(p, kGrip, {0.042f, 0.05f, 0.045f});
  for (int i = 0; i < 4; ++i) {
    const float y = 0.033f - 0.022f * static_cast<float>(i);
    fist = smoothUnion(fist,
                       roundCone(p, kGrip + glm::vec3(-0.03f, y, 0.012f), kGrip + glm::vec3(0.03f, y, 0.036f),
                                 0.013f, 0.012f),
                       0.008f);
  }
  right = smoothUnion(right, fist, 0.02f);
  float left = roundCone(p, {0.205f, 1.44f, -0.01f}, {0.36f, 1.17f, 0.02f}, 0.06f, 0.045f);
  left = smoothUnion(
      left, roundCone(p, {0.36f, 1.17f, 0.02f}, kShield + glm::vec3(-0.06f, 0, -0.07f), 0.047f, 0.032f),
      0.03f);
  const glm::vec3 q(mirrored(p.x), p.y, p.z);
  float legs = roundCone(q, {0.1f, 0.9f, 0}, {0.125f, 0.5f, 0.02f}, 0.09f, 0.062f);
  legs =
      smoothUnion(legs, roundCone(q, {0.125f, 0.5f, 0.02f}, {0.135f, 0.09f, -0.01f}, 0.058f, 0.038f), 0.03f);
  legs = smoothUnion(legs, ellipsoid(q, {0.13f, 0.36f, -0.025f}, {0.055f, 0.12f, 0.06f}), 0.04f);
  legs = smoothUnion(legs, ellipsoid(q, {0.155f, 0.035f, 0.07f}, {0.05f, 0.035f, 0.12f}), 0.03f);
  float face = ellipsoid(p, {0, 1.66f, 0.015f}, {0.085f, 0.12f, 0.1f});
  face = smoothUnion(face, roundCone(p, {0, 1.46f, -0.01f}, {0, 1.58f, 0}, 0.06f, 0.055f), 0.04f);
  face = smoothUnion(face, roundCone(p, {0, 1.68f, 0.108f}, {0, 1.635f, 0.126f}, 0.01f, 0.016f), 0.02f);
  return std::min({right, left, legs, face});
}

/// A closed helmet with almond eyes and a slit to breathe through.
float helmet(glm::vec3 p) {
  const glm::vec3 q(mirrored(p.x), p.y, p.z);
  const float flare = 0.02f * glm::smoothstep(1.58f, 1.49f, p.y) * glm::smoothstep(0.02f, -0.1f, p.z);
  float shell = ellipsoid(p, {0, 1.685f, 0}, {0.123f, 0.147f, 0.148f});
  shell =
      smoothUnion(shell, roundCone(p, {0, 1.67f, 0.005f}, {0, 1.53f, 0.012f}, 0.122f, 0.108f), 0.04f) - flare;
  const float brow = std::abs(p.y - 1.735f - 0.12f * q.x) - 0.008f;
  shell -= 0.006f * glm::smoothstep(0.008f, -0.004f, brow) * glm::smoothstep(-0.05f, 0.02f, p.z);
  const float inside = std::min(ellipsoid(p, {0, 1.68f, 0}, {0.1f, 0.122f, 0.124f}),
                                roundCone(p, {0, 1.66f, 0.005f}, {0, 1.4f, 0.01f}, 0.1f, 0.088f));
  float d = smoothCut(shell, inside, 0.008f);
  d = smoothCut(d, p.y - 1.495f - 0.35f * std::max(0.0f, 0.06f - q.x), 0.01f);
  d = smoothCut(d, ellipsoid(q, {0.045f, 1.678f, 0.13f}, {0.032f, 0.02f, 0.09f}), 0.006f);
  const glm::vec3 slit = glm::abs(p - glm::vec3(0, 1.55f, 0.13f)) -
                         glm::vec3(0.013f + 0.08f * std::max(0.0f, 1.57f - p.y), 0.08f, 0.08f);
  return smoothCut(d, std::max({slit.x, slit.y, slit.z}), 0.006f);
}

/// A muscled cuirass, with the greaves in the same bronze.
float armour(glm::vec3 p) {
  const glm::vec3 q(mirrored(p.x), p.y, p.z);
  float d = roundCone(p, {0, 1.06f, 0}, {0, 1.3f, 0.01f}, 0.14f, 0.155f);
  d = smoothUnion(d, ellipsoid(q, {0.085f, 1.36f, 0.0f}, {0.135f, 0.125f, 0.12f}), 0.06f);
  d = smoothUnion(d, ellipsoid(q, {0.085f, 1.355f, 0.095f}, {0.085f, 0.065f, 0.045f}), 0.03f);  // chest
  for (int row = 0; row < 3; ++row) {
    const float y = 1.255f - 0.065f * static_cast<float>(row);
    d = smoothUnion(d, ellipsoid(q, {0.04f, y, 0.135f}, {0.038f, 0.03f, 0.03f}), 0.02f);
  }
  d = smoothUnion(d, ellipsoid(q, {0.185f, 1.45f, -0.005f}, {0.085f, 0.06f, 0.085f}),
                  0.03f);  // shoulder guards
  d = smoothUnion(
      d, std::max(std::abs(p.y - 1.0f) - 0.02f, ellipsoid(p, {0, 1.0f, 0}, {0.175f, 0.2f, 0.155f})), 0.015f);
  d = smoothCut(d, ellipsoid(p, {0, 1.56f, 0.02f}, {0.085f, 0.085f, 0.1f}), 0.02f);
  float greave = roundCone(q, {0.126f, 0.5f, 0.035f}, {0.135f, 0.14f, 0.0f}, 0.064f, 0.047f);
  greave = smoothUnion(greave, ellipsoid(q, {0.126f, 0.52f, 0.06f}, {0.045f, 0.055f, 0.04f}), 0.03f);
  greave = smoothCut(greave, p.z + 0.012f, 0.01f);
  return std::min(d, greave);
}

/// The tunic: pleats below the belt, short sleeves.
float tunic(glm::vec3 p) {
  const float s = glm::clamp((1.02f - p.y) / 0.36f, 0.0f, 1.0f), angle = std::atan2(p.z, p.x);
  const float radius = 0.135f + 0.1f * s + 0.014f * s * std::cos(18 * angle + std::sin(3 * angle));
  const float skirt = std::max({(glm::length(glm::vec2(p.x, 1.12f * p.z)) - radius) * 0.75f, p.y - 1.02f,
                                0.64f + 0.008f * std::cos(18 * angle) - p.y});
  const glm::vec3 q(mirrored(p.x), p.y, p.z);
  const float sleeve = roundCone(q, {0.2f, 1.44f, -0.01f}, {0.265f, 1.3f, -0.008f}, 0.078f, 0.08f);
  return std::min(skirt, sleeve - 0.004f * std::cos(22 * std::atan2(q.z, q.x - 0.23f)));
}

Mesh crest() {
  Mesh mesh;
  Random random(5);
  const auto ridge = [](float t) {  // from the brow over the crown down the neck
    const float a = glm::mix(0.62f, -2.35f, t);
    return glm::vec3(0, 1.685f + 0.152f * std::cos(a), 0.152f * std::sin(a));
  };
  std::vector<glm::vec3> keel;
  for (int i = 0; i <= 24; ++i) keel.push_back(ridge(static_cast<float>(i) / 24));
  append(mesh, tube(keel, std::vector<float>(keel.size(), 0.014f), 8));
  for (int i = 0; i < 90; ++i) {
    const float t = static_cast<float>(i) / 89;
    const glm::vec3 root = ridge(t), out = glm::normalize(root - glm::vec3(0, 1.685f, 0)),
                    back = glm::normalize(glm::cross(glm::vec3(-1, 0, 0), out));
    for (int k = 0; k < 4; ++k) {
      const float side = (static_cast<float>(k) - 1.5f) / 1.5f,
                  length = (0.11f + 0.03f * std::sin(glm::pi<float>() * t)) * random.uniform(0.9f, 1.05f);
      std::vector<glm::vec3> path;
      std::vector<float> radii;
      for (int j = 0; j <= 3; ++j) {
        const float s = static_cast<float>(j) / 3;
        path.push_back(root + glm::vec3(side * (0.008f + 0.012f * s), 0, 0) + out * (length * s) +
                       back * (0.045f * s * s + 0.02f * s * random.uniform()));
        radii.push_back(0.0052f * (1 - 0.6f * s));
      }
      append(mesh, tube(path, radii, 5, false));
    }
  }
  return mesh;
}

/// Two rows of leather strips below the belt, and the belt.
Mesh leather() {
  Mesh mesh;
  for (int row = 0; row < 2; ++row) {
    for (int i = 0; i < 20; ++i) {
      const float degrees = 18.0f * (static_cast<float>(i) + 0.5f * static_cast<float>(row));
      const float length = row == 0 ? 0.15f : 0.11f;
      const glm::mat4 place = scaling({1, 1, 0.92f}) * rotation(degrees, {0, 1, 0}) *
                              translation({0, 0.99f, 0.172f + 0.012f * static_cast<float>(row)}) *
                              rotation(-13, {1, 0, 0});
      append(mesh, roundedBox({0.024f, length, 0.006f}, 0.0055f, 2), place * translation({0, -length, 0}));
      append(mesh, transformed(sphere(0.009f, 6), translation({0, 0, 0.005f})),
             place * translation({0, -2 * length + 0.025f, 0}));
    }
  }
  append(mesh, torus(0.172f, 0.016f, 72, 10), translation({0, 1.0f, 0}) * scaling({1, 1.5f, 0.93f}));
  for (const float side : {-1.0f, 1.0f}) {  // sandals
    append(mesh, transformed(roundedBox({0.055f, 0.01f, 0.13f}, 0.009f, 2),
                             translation({side * 0.155f, 0.01f, 0.06f})));
    for (const float y : {0.1f, 0.14f})
      append(mesh, torus(0.046f, 0.007f, 24, 6), translation({side * 0.137f, y, -0.006f}));
    append(mesh, torus(0.05f, 0.007f, 24, 6),
           translation({side * 0.155f, 0.035f, 0.11f}) * rotation(70, {1, 0, 0}) * scaling({1, 1, 0.8f}));
  }
  return mesh;
}

Mesh shieldDish() {
  const glm::vec2 knots[] = {{0, -0.02f},       {0.3f, -0.055f},   {0.375f, -0.085f}, {0.43f, -0.095f},
                             {0.452f, -0.09f},  {0.452f, -0.078f}, {0.43f, -0.07f},   {0.385f, -0.068f},
                             {0.372f, -0.052f}, {0.3f, -0.012f},   {0.2f, 0.02f},     {0.1f, 0.036f},
                             {0, 0.042f}};
  return lathe(spline(std::span<const glm::vec2>(knots), 3), 72, 60);
}

/// The device on the shield: a ring and a sun of sixteen rays.
Mesh shieldEmblem() {
  Mesh mesh = transformed(torus(0.3f, 0.008f, 80, 8), translation({0, -0.01f, 0}));
  append(mesh, transformed(sphere(0.06f, 14), translation({0, 0.035f, 0}) * scaling({1, 0.45f, 1})));
  for (int i = 0; i < 16; ++i) {
    const float length = i % 2 == 0 ? 0.26f : 0.19f;
    const glm::vec3 path[] = {{0.07f, 0.04f, 0}, {0.5f * length + 0.03f, 0.034f, 0}, {length, 0.008f, 0}};
    const float radii[] = {0.012f, 0.016f, 0.002f};
    append(mesh,
           tube(spline(std::span<const glm::vec3>(path), 3),
                std::vector<float>{0.012f, 0.015f, 0.016f, 0.016f, 0.012f, 0.007f, radii[2]}, 8, false),
           rotation(22.5f * static_cast<float>(i), {0, 1, 0}));
  }
  return mesh;
}

Mesh spearHead() {
  const glm::vec2 knots[] = {{0.017f, 0},     {0.019f, 0.03f}, {0.014f, 0.08f}, {0.02f, 0.11f},
                             {0.036f, 0.17f}, {0.026f, 0.27f}, {0.001f, 0.38f}};
  Mesh mesh =
      transformed(lathe(spline(std::span<const glm::vec2>(knots), 4), 24, 60), scaling({1, 1, 0.45f}));
  const glm::vec2 butt[] = {
      {0, -2.42f}, {0.006f, -2.38f}, {0.018f, -2.26f}, {0.019f, -2.2f}, {0.016f, -2.19f}};
  append(mesh, lathe(butt, 24));
  return mesh;
}

}  // namespace

std::vector<Primitive> build(Scene& scene) {
  std::vector<Primitive> primitives;
  const auto add = [&](Mesh mesh, Material material) {
    primitives.push_back({std::move(mesh), scene.addMaterial(std::move(material))});
  };
  add(polygonise(skin, {-0.5f, -0.03f, -0.25f}, {0.5f, 1.85f, 0.45f}, 0.025f),
      lambert("skin", {0.48f, 0.27f, 0.17f}));
  Mesh bronze = polygonise(armour, {-0.35f, 0.05f, -0.25f}, {0.35f, 1.6f, 0.3f}, 0.0245f);
  append(bronze, polygonise(helmet, {-0.2f, 1.45f, -0.22f}, {0.2f, 1.88f, 0.22f}, 0.0135f));
  append(bronze, spearHead(), translation({kGrip.x, 2.42f, kGrip.z + 0.02f}));
  const glm::mat4 hold = translation(kShield) * rotation(12, {0, 1, 0}) * rotation(86, {1, 0, 0});
  append(bronze, shieldEmblem(), hold);
  add(std::move(bronze), glossy("bronze", {0.72f, 0.47f, 0.22f}, 0.5f, 1));
  add(polygonise(tunic, {-0.4f, 0.58f, -0.3f}, {0.4f, 1.58f, 0.3f}, 0.025f),
      lambert("tunic", {0.5f, 0.44f, 0.34f}));
  add(leather(), glossy("leather", {0.24f, 0.12f, 0.06f}, 0.8f));
  add(crest(), lambert("crest", {0.5f, 0.05f, 0.04f}));
  add(transformed(shieldDish(), hold), glossy("shield", {0.4f, 0.05f, 0.04f}, 0.5f));
  const glm::vec3 pole[] = {
      {kGrip.x, 0.2f, kGrip.z + 0.02f}, {kGrip.x, 1.2f, kGrip.z + 0.02f}, {kGrip.x, 2.44f, kGrip.z + 0.02f}};
  add(tube(pole, std::vector<float>{0.015f, 0.0165f, 0.013f}, 16), glossy("ash", {0.4f, 0.26f, 0.14f}, 0.7f));
  return primitives;
}

}  // namespace limn::assets::soldier
