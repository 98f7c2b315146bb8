// Meshes in place of height maps: where vertices lie, and how large surfaces are.
#include "core/scene/displaced.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/scene/tangents.h"
#include "tests/support/test_scenes.h"
#include "tests/unit/relief/fields.h"

namespace limn::scene {
namespace {

using relief::HeightField;

Scene bumpy(Primitive primitive, HeightField field) {
  Scene scene;
  scene.heights.push_back(std::move(field));
  Material material;
  material.height = 0;
  primitive.material = test::addMaterial(scene, material);
  primitive.tangents =
      generateTangents(primitive.positions, primitive.normals, primitive.uvs, primitive.indices);
  Node node;
  node.mesh = test::addMesh(scene, std::move(primitive));
  scene.nodes.push_back(node);
  return scene;
}

/// A floor of 2 m x 2 m in the plane y = 0 on which the map lies `tiles` times.
Primitive floorOf(glm::vec2 tiles) {
  Primitive p = test::floorPrimitive(1, 0);
  for (glm::vec2& uv : p.uvs) uv *= tiles;
  return p;
}

const Primitive& onlyPrimitive(const Scene& scene) {
  return scene.meshes.at(0).primitives.at(0);
}

double areaOf(const Primitive& p) {
  double area = 0;
  for (std::size_t i = 0; i < p.indices.size(); i += 3) {
    const glm::dvec3 a(p.positions[p.indices[i]]), b(p.positions[p.indices[i + 1]]),
        c(p.positions[p.indices[i + 2]]);
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return area;
}

TEST(Displaced, AFlatMapMovesTheSurfaceAlone) {
  const Scene scene =
      displaced(bumpy(floorOf({1, 1}), {{4, 4}, std::vector<float>(16, 0.3f), glm::dvec2(2)}));
  const Primitive& p = onlyPrimitive(scene);
  EXPECT_EQ(scene.materials[0].height, kNone);
  EXPECT_TRUE(scene.heights.empty());
  EXPECT_NEAR(areaOf(p), 4, 1e-5);
  for (std::size_t i = 0; i < p.positions.size(); ++i) {
    EXPECT_FLOAT_EQ(p.positions[i].y, 0.3f);
    EXPECT_LT(glm::distance(p.normals[i], glm::vec3(0, 1, 0)), 1e-6f);
  }
  EXPECT_FLOAT_EQ(p.bounds.high.y, 0.3f);
}

/// Walls of 45 degrees: the surface is larger by a factor of the root of 2, and its normals are the walls'.
TEST(Displaced, GroovesHaveTheAreaOfTheirWalls) {
  constexpr int texels = 64;
  std::vector<float> values;
  for (int i = 0; i < texels; ++i)
    values.push_back(2 * static_cast<float>(std::abs(i - texels / 2)) / texels);
  for (const float tiles : {1.f, 3.f}) {
    const Scene scene = displaced(
        bumpy(floorOf({tiles, 1}), {{texels, 1}, values, glm::dvec2(2 / tiles, 2), 1 / double(tiles)}));
    const Primitive& p = onlyPrimitive(scene);
    EXPECT_NEAR(areaOf(p), 4 * std::sqrt(2.0), 1e-4);
    int steep = 0;
    for (const glm::vec3& n : p.normals) steep += std::abs(n.y - std::sqrt(0.5f)) < 1e-5f;
    EXPECT_GT(steep, static_cast<int>(0.9 * static_cast<double>(p.normals.size())));
  }
}

/// Every vertex lies as high as the field does at its own coordinates, mirrored and turned ones too.
TEST(Displaced, VerticesLieOnTheField) {
  const HeightField field = relief::test::noise(24, 0.5);
  for (const glm::mat2& turn :
       {glm::mat2(1), glm::mat2(-1, 0, 0, 1), glm::mat2(0, 1, 1, 0), glm::mat2(0.8f, 0.6f, -0.6f, 0.8f)}) {
    Primitive p = floorOf({2.3f, 1.7f});
    for (glm::vec2& uv : p.uvs) uv = turn * uv - 0.4f;
    const Primitive moved = onlyPrimitive(displaced(bumpy(p, field)));
    EXPECT_GT(moved.positions.size(), 4 * 24 * 24u);
    for (std::size_t i = 0; i < moved.positions.size(); ++i)
      EXPECT_NEAR(moved.positions[i].y, field.height(field.place(glm::dvec2(moved.uvs[i]))), 1e-4);
    double base = 0;
    for (std::size_t i = 0; i < moved.indices.size(); i += 3) {
      const auto at = [&](std::size_t k) {
        const glm::vec3& q = moved.positions[moved.indices[i + k]];
        return glm::dvec2(q.x, q.z);
      };
      const glm::dvec2 a = at(1) - at(0), b = at(2) - at(0);
      const double area = 0.5 * (a.y * b.x - a.x * b.y);
      EXPECT_GE(area, -1e-9) << "no triangle is turned over";
      base += area;
    }
    EXPECT_NEAR(base, 4, 1e-4) << "pieces cover the floor once";
  }
}

TEST(Displaced, SpheresGrowAlongTheirNormals) {
  const HeightField field = relief::test::eggCrate(16, 0.2);
  Primitive ball = test::spherePrimitive(1, 0, 24);
  for (glm::vec2& uv : ball.uvs) uv *= glm::vec2(4, 2);
  const Primitive p = onlyPrimitive(displaced(bumpy(ball, field)));
  for (const glm::vec3& position : p.positions) {
    // Chords of the sphere lie up to 1 - cos(pi / 48) inside.
    EXPECT_GT(glm::length(position), 1 + field.lowest() - 0.005);
    EXPECT_LT(glm::length(position), 1 + field.highest() + 1e-4);
  }
}

TEST(Displaced, WhatCannotBeDisplacedIsSaid) {
  const HeightField field = relief::test::noise(24, 0.5);
  EXPECT_THROW(displaced(bumpy(floorOf({1000, 1000}), field), 100000), UsageError);
  EXPECT_THROW(displaced(bumpy(floorOf({1e20f, 1e20f}), field)), UsageError);
  // So far away that one texel more is the same number: no columns, but rows without end.
  Primitive astray = floorOf({1, 1e12f});
  for (glm::vec2& uv : astray.uvs) uv.x = 1e17f;
  EXPECT_THROW(displaced(bumpy(astray, field)), UsageError);
  Scene skinned = bumpy(floorOf({1, 1}), field);
  skinned.meshes[0].primitives[0].morphTargets.emplace_back();
  EXPECT_THROW(displaced(std::move(skinned)), UsageError);
  Scene plain = bumpy(floorOf({1, 1}), field);
  plain.meshes[0].primitives[0].tangents.clear();
  EXPECT_EQ(onlyPrimitive(displaced(std::move(plain))).positions.size(), 4u);
}

}  // namespace
}  // namespace limn::scene
