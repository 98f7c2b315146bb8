// The G-buffer of scenes: depth, instances, sides, textures, masks, skins and morph targets.
#include "core/gpu_scene/gpu_scene.h"

#include <gmock/gmock.h>

#include <cmath>
#include <utility>

#include "tests/gpu/gpu_scene_harness.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;

glm::vec3 ray(const glsl::FrameBlock& frame, int x, int y) {
  return glm::vec3(frame.view_ray_origin) + static_cast<float>(x) * glm::vec3(frame.view_ray_dx) +
         static_cast<float>(y) * glm::vec3(frame.view_ray_dy);
}

TEST_F(GpuSceneTest, DepthOfAPlaneIsExactAtEveryScale) {
  for (const float scale : {1e-4f, 1.f, 1e4f}) {
    scene::Scene scene;
    addMesh(scene, floorPrimitive(10 * scale, addMaterial(scene)));
    scene::Pose pose;
    addInstance(scene, pose, 0);
    const auto camera = scene::lookAt({0, 2 * scale, 5 * scale}, {0, 0, 0}, 0.8f);
    const Picture picture = draw(scene, pose, camera);
    glsl::FrameBlock frame{};
    scene::setCamera(frame, camera, pose.bounds, kSide, kSide);
    int covered = 0;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const glm::vec3 d = ray(frame, x, y);
        const float expected = -frame.camera_position.y / d.y;
        const glm::vec3 hit = glm::vec3(frame.camera_position) + expected * d;
        if (d.y >= 0 || std::max(std::abs(hit.x), std::abs(hit.z)) > 9.9f * scale) continue;
        ++covered;
        EXPECT_NEAR(picture.depth[picture.at(x, y)] / expected, 1, snapped(2e-5f))
            << x << "," << y << " scale " << scale;
        EXPECT_EQ(picture.instance[picture.at(x, y)], 0u);
      }
    }
    EXPECT_GT(covered, kSide * kSide / 3);
    EXPECT_LT(glm::distance(picture.faceNormal(64, 40), glm::vec3(0, 1, 0)), 1e-4f);
    EXPECT_EQ(picture.depth[picture.at(0, kSide - 1)], 0.f);
    EXPECT_EQ(picture.instance[picture.at(0, kSide - 1)], glsl::no_instance);
  }
}

TEST_F(GpuSceneTest, NearAndFarMayBeAMillionApart) {
  scene::Scene scene;
  const int material = addMaterial(scene);
  addMesh(scene, floorPrimitive(1, material));
  scene::Pose pose;
  const glm::mat4 upright = glm::rotate(glm::mat4(1), 0.5f * glsl::pi, {1, 0, 0});
  addInstance(scene, pose, 0, at(-1, 0, -1) * upright);                              // left half, 1 m away
  addInstance(scene, pose, 0, at(0, 0, -1.0e6f) * upright * at(0, 0, 0, 1e6f));      // everything, 1000 km
  addInstance(scene, pose, 0, at(0, 0, -1.001e6f) * upright * at(0, 0, 0, 1.1e6f));  // 1 km behind it
  auto camera = scene::lookAt({0, 0, 0}, {0, 0, -1}, 0.8f);
  camera.near = 0.5f;
  const Picture picture = draw(scene, pose, camera);
  EXPECT_EQ(picture.instance[picture.at(30, 64)], 0u);
  EXPECT_EQ(picture.instance[picture.at(127, 64)], 1u);
  EXPECT_NEAR(picture.depth[picture.at(127, 64)], 1e6, 30);
  EXPECT_THAT(picture.instance, ::testing::Each(::testing::AnyOf(0u, 1u)));
}

TEST_F(GpuSceneTest, InstancesShareOneDrawAndKeepTheirIds) {
  scene::Scene scene;
  addMesh(scene, spherePrimitive(0.4f, addMaterial(scene), 12));
  addMesh(scene, spherePrimitive(0.4f, 0, 6));
  scene::Pose pose;
  for (int i = 0; i < 16; ++i)
    addInstance(scene, pose, i % 2,
                at(static_cast<float>(i % 4) - 1.5f, static_cast<float>(i / 4) - 1.5f, 0));
  const auto camera = scene::lookAt({0, 0, 8}, {0, 0, 0}, 0.6f);
  const Picture picture = draw(scene, pose, camera);
  glsl::FrameBlock frame{};
  scene::setCamera(frame, camera, pose.bounds, kSide, kSide);
  for (uint32_t i = 0; i < 16; ++i) {
    const glm::vec4 clip = frame.world_to_clip * pose.instances[i].objectToWorld * glm::vec4(0, 0, 0, 1);
    const int x = static_cast<int>((clip.x / clip.w * 0.5f + 0.5f) * kSide);
    const int y = static_cast<int>((clip.y / clip.w * 0.5f + 0.5f) * kSide);
    EXPECT_EQ(picture.instance[picture.at(x, y)], i);
  }
}

TEST_F(GpuSceneTest, CullingFollowsSidesAndMirroring) {
  scene::Scene scene;
  scene::Material twoSided;
  twoSided.doubleSided = true;
  const int single = addMaterial(scene), both = addMaterial(scene, twoSided);
  const int one = addMesh(scene, floorPrimitive(0.4f, single)),
            two = addMesh(scene, floorPrimitive(0.4f, both));
  const glm::mat4 towards = glm::rotate(glm::mat4(1), 0.5f * glsl::pi, {1, 0, 0});  // faces +z, the camera
  const glm::mat4 away = glm::rotate(glm::mat4(1), -0.5f * glsl::pi, {1, 0, 0});
  const glm::mat4 mirror = glm::scale(glm::mat4(1), glm::vec3(-1, 1, 1));
  scene::Pose pose;
  addInstance(scene, pose, one, at(-1, 1, 0) * towards);
  addInstance(scene, pose, one, at(0, 1, 0) * away);  // unseen
  addInstance(scene, pose, one, at(1, 1, 0) * towards * mirror);
  addInstance(scene, pose, one, at(-1, 0, 0) * away * mirror);  // unseen
  addInstance(scene, pose, two, at(0, 0, 0) * towards);
  addInstance(scene, pose, two, at(1, 0, 0) * away);
  addInstance(scene, pose, two, at(0, -1, 0) * away * mirror);
  const Picture picture = draw(scene, pose, scene::lookAt({0, 0, 4}, {0, 0, 0}, 0.9f));
  const auto idAt = [&](int column, int row) {
    return picture.instance[picture.at(64 + 33 * column, 64 + 33 * row)];
  };
  EXPECT_EQ(idAt(-1, 1), 0u);
  EXPECT_EQ(idAt(0, 1), glsl::no_instance);
  EXPECT_EQ(idAt(1, 1), 2u);
  EXPECT_EQ(idAt(-1, 0), glsl::no_instance);
  EXPECT_EQ(idAt(0, 0), 4u);
  EXPECT_EQ(idAt(1, 0), 5u);
  EXPECT_EQ(idAt(0, -1), 6u);
  for (const auto& [column, row] : {std::pair(-1, 1), {1, 1}, {0, 0}, {1, 0}, {0, -1}}) {
    const int x = 64 + 33 * column, y = 64 + 33 * row;
    EXPECT_LT(glm::distance(picture.shadingNormal(x, y), glm::vec3(0, 0, 1)), 1e-3f) << column << "," << row;
    EXPECT_LT(glm::distance(picture.faceNormal(x, y), glm::vec3(0, 0, 1)), 1e-3f) << column << "," << row;
  }
}

/// A texture of one texel per level, level k of grey value 20 (k + 1).
scene::TextureImage levelTexture(int size) {
  scene::TextureImage image;
  for (uint8_t value = 20; size > 0; size /= 2, value = static_cast<uint8_t>(value + 20)) {
    scene::TextureImage::Level level{size, size, {}};
    level.rgba.assign(static_cast<size_t>(size * size) * 4, value);
    for (size_t i = 3; i < level.rgba.size(); i += 4) level.rgba[i] = 255;
    image.levels.push_back(std::move(level));
  }
  return image;
}

TEST_F(GpuSceneTest, TextureLevelFollowsTheSharedFormula) {
  scene::Scene scene;
  scene.images.push_back(levelTexture(256));
  scene::Material material;
  material.baseColourTexture.image = 0;
  const glm::mat4 upright = glm::rotate(glm::mat4(1), 0.5f * glsl::pi, {1, 0, 0});
  addMesh(scene, floorPrimitive(1, addMaterial(scene, material)));
  scene::Pose pose;
  addInstance(scene, pose, 0, upright);
  for (const float distance : {2.f, 4.f, 8.f}) {
    const Picture picture = draw(scene, pose, scene::lookAt({0, 0, distance}, {0, 0, 0}, 0.8f));
    const float texelsPerPixel = 128 * (2 * std::tan(0.4f) * distance / kSide);
    const float linear = 20 * (1 + std::max(0.f, std::log2(texelsPerPixel))) / 255.f;
    const float encoded = std::sqrt(linear) * 255;
    EXPECT_NEAR(picture.albedo[picture.at(64, 64)].x, encoded, 2) << distance;
  }
}

/// As what a light shines through, or what was resampled for other coordinates.
TEST_F(GpuSceneTest, PicturesThatNoSurfaceShowsTakeNoMemory) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(1, addMaterial(scene)));
  const auto textureBytes = [&] {
    const int64_t before = device().counters().textureBytes;
    const scene::GpuScene gpuScene(device(), scene);
    return device().counters().textureBytes - before;
  };
  const int64_t without = textureBytes();
  scene.images.push_back(levelTexture(256));
  EXPECT_EQ(textureBytes(), without);
  scene.materials[0].emissiveTexture.image = 0;
  EXPECT_GT(textureBytes(), without);
}

TEST_F(GpuSceneTest, MaskedTexelsAreHoles) {
  scene::Scene scene;
  scene::TextureImage image;
  image.levels.push_back({2, 1, {255, 255, 255, 255, 255, 255, 255, 0}});
  scene.images.push_back(image);
  scene::Material material;
  material.baseColourTexture = {0, scene::Wrap::clamp, scene::Wrap::clamp};
  material.alphaCutoff = 0.5f;
  const glm::mat4 upright = glm::rotate(glm::mat4(1), 0.5f * glsl::pi, {1, 0, 0});
  addMesh(scene, floorPrimitive(1, addMaterial(scene, material)));
  addMesh(scene, floorPrimitive(1, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0, upright);
  addInstance(scene, pose, 1, at(0, 0, -0.5f) * upright);
  const Picture picture = draw(scene, pose, scene::lookAt({0, 0, 4}, {0, 0, 0}, 0.4f));
  EXPECT_EQ(picture.instance[picture.at(32, 64)], 0u);
  EXPECT_EQ(picture.instance[picture.at(96, 64)], 1u);
}

TEST_F(GpuSceneTest, SkinnedAndMorphedVerticesEqualTransformedOnes) {
  scene::Scene scene;
  scene::Primitive plain = floorPrimitive(1, addMaterial(scene)), skinned = plain, morphed = plain;
  skinned.joints.assign(4, {0, 1, 0, 0});
  skinned.weights.assign(4, {0.25f, 0.75f, 0, 0});
  skinned.jointBounds = {{0, skinned.bounds}, {1, skinned.bounds}};
  scene::MorphTarget target;
  target.positions.assign(4, {0, 1, 0});
  target.deltaBounds = {{0, 0, 0}, {0, 1, 0}};
  morphed.morphTargets.push_back(target);
  const int plainMesh = addMesh(scene, plain), skinnedMesh = addMesh(scene, skinned),
            morphedMesh = addMesh(scene, morphed);
  const glm::mat4 upright = glm::rotate(glm::mat4(1), 1.3f, {1, 0.2f, 0});
  const auto camera = scene::lookAt({0.5f, 0.5f, 4}, {0, 0, 0}, 0.6f);

  scene::Pose still, skin, morph;
  addInstance(scene, still, plainMesh, at(0.3f, 0.2f, -1) * upright);
  const Picture expected = draw(scene, still, camera);

  addInstance(scene, skin, skinnedMesh);
  skin.instances[0].deformed = 0;
  skin.deformed.push_back({skinnedMesh, 0, {at(1.2f, 0.2f, -1) * upright, at(0, 0.2f, -1) * upright}, {}});
  addInstance(scene, morph, morphedMesh, at(0.3f, 0.2f, -1) * upright * at(0, -0.75f, 0));
  morph.instances[0].deformed = 0;
  morph.deformed.push_back({morphedMesh, 0, {}, {0.75f}});
  for (const scene::Pose* pose : {&skin, &morph}) {
    const Picture picture = draw(scene, *pose, camera);
    int differ = 0, covered = 0;
    for (size_t i = 0; i < expected.depth.size(); ++i) {
      if (picture.instance[i] != expected.instance[i]) {
        ++differ;
      } else if (expected.depth[i] > 0) {
        ++covered;
        EXPECT_NEAR(picture.depth[i], expected.depth[i], 1e-4f);
        EXPECT_LT(glm::distance(picture.normal[i], expected.normal[i]), 2e-4f);
      }
    }
    EXPECT_LT(differ, 5);  // rounding at the silhouette
    EXPECT_GT(covered, 1000);
  }
}

/// Windows of lights are fitted to them, which the reference's bounds must not differ from by rounding.
TEST_F(GpuSceneTest, BoundsAreThoseOfThePose) {
  scene::Scene scene;
  scene::Primitive skinned = floorPrimitive(1, addMaterial(scene));
  skinned.joints.assign(4, glm::u16vec4(0));
  skinned.weights.assign(4, glm::vec4(1, 0, 0, 0));
  skinned.jointBounds = {{0, skinned.bounds}};
  const int mesh = addMesh(scene, skinned);
  scene::Pose pose;
  addInstance(scene, pose, mesh);
  pose.instances[0].deformed = 0;
  pose.deformed.push_back({mesh, 0, {glm::mat4(1)}, {}});
  scene::GpuScene gpuScene(device(), scene);
  for (int step = 0; step < 32; ++step) {
    const float turn = 0.1f + 0.37f * static_cast<float>(step);
    pose.deformed[0].joints[0] = at(turn, 3 - turn, 0.7f) * glm::rotate(glm::mat4(1), turn, {1, 2, 3});
    gpuScene.update(pose, scene::lookAt({0, 2, 4}, {0, 0, 0}, 0.6f), {kSide, kSide}, 0);
    EXPECT_EQ(gpuScene.bounds(0), scene::instanceBounds(scene, pose, pose.instances[0])) << step;
    EXPECT_EQ(gpuScene.bounds(), gpuScene.bounds(0)) << step;
  }
}

/// Joints that mirror turn the winding and the bitangents round as the transform of a rigid mesh does.
TEST_F(GpuSceneTest, MirroredSkinsEqualMirroredInstances) {
  scene::Scene rigid;
  rigid.images.emplace_back().levels.push_back({1, 1, {160, 192, 220, 255}});
  scene::Material material;
  material.normalTexture.image = 0;
  addMesh(rigid, floorPrimitive(1, addMaterial(rigid, material)));
  rigid.nodes.resize(3);  // a root, its mesh and its joint
  rigid.nodes[0].transform.scale = {-1, 1, 1};
  rigid.nodes[1].parent = rigid.nodes[2].parent = 0;
  rigid.nodes[1].mesh = 0;
  scene::Scene skinned = rigid;
  scene::Primitive& bound = skinned.meshes[0].primitives[0];
  bound.joints.assign(4, glm::u16vec4(0));
  bound.weights.assign(4, glm::vec4(1, 0, 0, 0));
  bound.jointBounds = {{0, bound.bounds}};
  skinned.skins.push_back({{2}, {glm::mat4(1)}});
  skinned.nodes[1].skin = 0;
  const auto camera = scene::lookAt({0.2f, 4, 0.3f}, {0, 0, 0}, 0.6f);
  const Picture expected = draw(rigid, scene::evaluate(rigid, 0), camera);
  const Picture picture = draw(skinned, scene::evaluate(skinned, 0), camera);
  EXPECT_EQ(picture.instance[picture.at(64, 64)], 0u);
  EXPECT_LT(std::abs(expected.shadingNormal(64, 64).y), 0.95f) << "the map tilts the normal";
  EXPECT_EQ(picture.instance, expected.instance);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      if (expected.instance[expected.at(x, y)] == glsl::no_instance) continue;
      EXPECT_LT(glm::distance(picture.shadingNormal(x, y), expected.shadingNormal(x, y)), 1e-3f)
          << x << ' ' << y;
      EXPECT_LT(glm::distance(picture.faceNormal(x, y), expected.faceNormal(x, y)), 1e-3f) << x << ' ' << y;
    }
}

}  // namespace
}  // namespace limn
