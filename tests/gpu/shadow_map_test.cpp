// Depths in shadow maps against the scenes that they show, under every projection.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/gpu/shadow_map_harness.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

TEST_F(ShadowMapTest, DepthOfAPlaneIsLinearAndExactAtEveryScale) {
  std::vector<float> first;
  for (const float scale : {1.f, 1e-4f, 1e4f}) {
    scene::Scene scene;
    addMesh(scene, floorPrimitive(8 * scale, addMaterial(scene)));
    scene::Pose pose;
    addInstance(scene, pose, 0);
    addLight(pose, spotLight(vec3(1, 3, 0.5f) * scale, {0.2f, -1, 0.1f}, 0.6f));
    const Maps maps = draw(scene, pose, {0}, {.size = kTexels});
    ASSERT_EQ(maps.views.size(), 1u);
    EXPECT_EQ(maps.stats[0].projection, "perspective");
    for (int y = 0; y < kTexels; ++y) {
      for (int x = 0; x < kTexels; ++x) {
        ASSERT_GE(maps.stored(0, x, y), 0.f);
        ASSERT_LT(maps.stored(0, x, y), 1.f);
        EXPECT_NEAR((maps.views[0].origin + maps.seen(0, x, y)).y / scale, 0, 2e-5f) << x << "," << y;
      }
    }
    if (first.empty()) first = maps.depth;
    for (size_t i = 0; i < first.size(); ++i) EXPECT_NEAR(maps.depth[i], first[i], snapped(2e-6f));
  }
}

/// A sphere over nothing: every texel sees the sphere or nothing.
TEST_F(ShadowMapTest, DepthOfASphereUnderEveryProjection) {
  scene::Scene scene;
  addMesh(scene, spherePrimitive(1, addMaterial(scene), 96));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, pointLight({0, 0, 3}));
  addLight(pose, spotLight({0, 0, 3}, {0, 0, -1}, 0.5f));
  addLight(pose, directionalLight({0, 0, -1}, 0));
  addLight(pose, rectangleLight({0, 0, 3}, {0, 0, -1}, 1, 1));
  for (const auto projection : {shadow::Projection::automatic, shadow::Projection::cube}) {
    const Maps maps = draw(scene, pose, {0, 1, 2, 3}, {.size = kTexels, .projection = projection});
    ASSERT_EQ(maps.lights.size(), 4u);
    for (const glsl::ShadowLight& light : maps.lights) {
      int covered = 0;
      const uint32_t faces = glsl::shadow_face_count(light.faces);
      for (uint32_t layer = light.first_layer; layer < light.first_layer + faces; ++layer) {
        for (int y = 0; y < kTexels; ++y) {
          for (int x = 0; x < kTexels; ++x) {
            if (maps.stored(static_cast<int>(layer), x, y) >= 1) continue;
            ++covered;
            const vec3 p = maps.views[layer].origin + maps.seen(static_cast<int>(layer), x, y);
            // A point of a chord of the tessellated sphere: up to pi^2 / (8 * 96^2) inside it, more where
            // seen at grazing.
            EXPECT_NEAR(glm::length(p), 1, 1e-3f)
                << "light " << light.light << " layer " << layer << " texel " << x << "," << y;
            EXPECT_GT(p.z, -0.02f) << "the side that faces the light";
          }
        }
      }
      EXPECT_GT(covered, kTexels * kTexels / 50) << "light " << light.light;
    }
  }
}

TEST_F(ShadowMapTest, CubesSeeAllAround) {
  scene::Scene scene;
  addMesh(scene, spherePrimitive(2, addMaterial(scene), 96));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, pointLight({0.3f, -0.2f, 0.1f}));
  const Maps maps = draw(scene, pose, {0}, {.size = kTexels, .projection = shadow::Projection::cube});
  EXPECT_EQ(maps.views.size(), 6u);
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 2000; ++i) {
    const vec3 p = 2.f * glm::normalize(vec3(normal(random), normal(random), normal(random)));
    const glsl::ShadowLight& light = maps.lights[0];
    const uint32_t layer =
        light.first_layer + glsl::shadow_face(light.faces, maps.views[light.first_layer], p);
    const glsl::ShadowPoint q = glsl::shadow_project(maps.views[layer], p);
    ASSERT_TRUE(glsl::shadow_inside(q)) << p.x << " " << p.y << " " << p.z;
    const int x = static_cast<int>(q.uv.x * kTexels), y = static_cast<int>(q.uv.y * kTexels);
    const float metres = glsl::shadow_metres(maps.views[layer], maps.stored(static_cast<int>(layer), x, y));
    EXPECT_NEAR(metres, q.depth, 0.05f);
  }
}

TEST_F(ShadowMapTest, LightsThatSeeMoreThanOneMapHoldsGetAHemicube) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(10, addMaterial(scene)));
  addMesh(scene, floorPrimitive(0.5f, 0));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  const uint32_t own = addInstance(scene, pose, 1, at(0, 0.5f, 0));
  glsl::Light low = rectangleLight({0, 0.5f, 0}, {0, -1, 0}, 1, 1);
  low.own_instance = own;
  glsl::Light high = rectangleLight({0, 8, 0}, {0, -1, 0}, 1, 1);
  addLight(pose, low);
  addLight(pose, high);
  const Maps maps = draw(scene, pose, {0, 1}, {.size = kTexels});
  EXPECT_EQ(maps.stats[0].projection, "hemicube");
  EXPECT_EQ(maps.stats[1].projection, "perspective");
  ASSERT_EQ(maps.views.size(), 6u);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-9.9f, 9.9f);
  for (const glsl::ShadowLight& light : maps.lights) {
    for (int i = 0; i < 2000; ++i) {
      const vec3 p(uniform(random), 0, uniform(random));
      const uint32_t layer =
          light.first_layer + glsl::shadow_face(light.faces, maps.views[light.first_layer], p);
      const glsl::ShadowPoint q = glsl::shadow_project(maps.views[layer], p);
      ASSERT_TRUE(glsl::shadow_inside(q));
      const int x = static_cast<int>(q.uv.x * kTexels), y = static_cast<int>(q.uv.y * kTexels);
      const vec3 seen = maps.views[layer].origin + maps.seen(static_cast<int>(layer), x, y);
      const bool shadowed = light.light == 1 && std::max(std::abs(p.x), std::abs(p.z)) < 0.4f;
      if (shadowed) {
        EXPECT_NEAR(seen.y, 0.5f, snapped(1e-4f));
      } else if (light.light == 0) {
        EXPECT_NEAR(seen.y, 0, snapped(1e-4f)) << "its own quad must not be in the way";
      }
    }
  }
}

TEST_F(ShadowMapTest, MaskedTexelsLetLightThrough) {
  scene::Scene scene;
  scene::TextureImage image;
  image.levels.push_back({2, 1, {255, 255, 255, 255, 255, 255, 255, 0}});
  scene.images.push_back(image);
  scene::Material material;
  material.baseColourTexture = {0, scene::Wrap::clamp, scene::Wrap::clamp};
  material.alphaCutoff = 0.5f;
  addMesh(scene, floorPrimitive(1, addMaterial(scene, material)));
  addMesh(scene, floorPrimitive(2, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0, at(0, 1, 0));
  addInstance(scene, pose, 1);
  addLight(pose, directionalLight({0, -1, 0}, 0));
  const Maps maps = draw(scene, pose, {0}, {.size = kTexels});
  for (const float x : {-0.8f, -0.4f, 0.4f, 0.8f}) {
    const glsl::ShadowPoint q = glsl::shadow_project(maps.views[0], {x, 0, 0});
    const vec3 seen = maps.seen(0, static_cast<int>(q.uv.x * kTexels), static_cast<int>(q.uv.y * kTexels));
    EXPECT_NEAR((seen + maps.views[0].origin).y, x < 0 ? 1 : 0, 1e-4f) << x;
  }
}

TEST_F(ShadowMapTest, SamplesOfALightGetMapsOfTheirOwn) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, rectangleLight({0, 4, 0}, {0, -1, 0}, 2, 1));
  addLight(pose, pointLight({0, 4, 0}));
  const Maps maps = draw(scene, pose, {0, 1}, {.size = 16, .samples = {{0, 0.5f}, {0.5f, 1}, {1, 0.5f}}});
  ASSERT_EQ(maps.lights.size(), 6u);
  for (size_t i = 3; i < 6; ++i)
    EXPECT_EQ(maps.lights[i].first_layer, 3u) << "samples of a point share its maps";
  const vec3 u(pose.lights[0].axis_u), v(pose.lights[0].axis_v);
  EXPECT_LT(glm::distance(maps.lights[0].origin, vec3(0, 4, 0) - u), 1e-6f);
  EXPECT_LT(glm::distance(maps.lights[1].origin, vec3(0, 4, 0) + 0.5f * v), 1e-6f);
  EXPECT_EQ(maps.views.size(), 9u);
}

/// Batches of samples after the first one do not look into the map that samples of a point share.
TEST_F(ShadowMapTest, MapsOfLightsWithoutExtentAreDrawnOnlyWhereTheyAreUsed) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, spotLight({0, 4, 0}, {0, -1, 0}, 0.4f));
  addLight(pose, rectangleLight({0, 4, 0}, {0, -1, 0}, 2, 1));
  shadow::ShadowMapDesc desc{.size = 16, .samples = {{0, 0.5f}, {0.5f, 1}}};
  for (const bool punctual : {true, false}) {
    desc.punctual = punctual;
    const Maps maps = draw(scene, pose, {0, 1}, desc);
    ASSERT_EQ(maps.views.size(), 3u);
    EXPECT_EQ(maps.stored(0, 8, 8) < 1, punctual);
    EXPECT_LT(maps.stored(1, 8, 8), 1);
    EXPECT_LT(maps.stored(2, 8, 8), 1);
  }
}

}  // namespace
}  // namespace limn
