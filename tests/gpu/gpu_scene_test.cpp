#include "core/gpu_scene/gpu_scene.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "glsl/surface/gbuffer.glsl"
#include "tests/gpu/gl_test.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::StartsWith;

constexpr int kSide = 128;

/// A G-buffer on the CPU, row 0 at the bottom.
struct Picture {
  std::vector<float> depth;
  std::vector<uint32_t> instance;
  std::vector<glm::vec2> normal, geometricNormal;
  std::vector<glm::u8vec4> albedo;

  size_t at(int x, int y) const { return static_cast<size_t>(y) * kSide + static_cast<size_t>(x); }
  glm::vec3 shadingNormal(int x, int y) const { return glsl::octahedral_decode(normal[at(x, y)]); }
  glm::vec3 faceNormal(int x, int y) const { return glsl::octahedral_decode(geometricNormal[at(x, y)]); }
};

class GpuSceneTest : public GlTest {
 protected:
  /// Renders the scene once and reads the G-buffer.
  Picture draw(const scene::Scene& scene, const scene::Pose& pose, const scene::CameraPose& camera) {
    scene::GpuScene gpuScene(device(), scene);
    gpuScene.update(pose, camera, {kSide, kSide}, 0);
    frame::ResourcePool pool(device());
    scene::GBufferPass pass;
    frame::FrameGraph graph;
    const SceneHandles handles = gpuScene.import(graph);
    const GBuffer g = pass.add(graph, gpuScene, handles, {kSide, kSide});
    for (const frame::TextureHandle h : {g.depth, g.normal, g.geometricNormal, g.albedo, g.instance})
      graph.output(h);
    graph.prepare(device(), shaders(), pool);
    graph.execute();
    Picture picture;
    const auto read = [&](frame::TextureHandle handle, auto& out, GLenum format, GLenum type) {
      out.resize(kSide * kSide);
      graph.texture(handle).read(0, format, type, out.data(), out.size() * sizeof(out[0]));
    };
    read(g.depth, picture.depth, GL_RED, GL_FLOAT);
    read(g.instance, picture.instance, GL_RED_INTEGER, GL_UNSIGNED_INT);
    read(g.normal, picture.normal, GL_RG, GL_FLOAT);
    read(g.geometricNormal, picture.geometricNormal, GL_RG, GL_FLOAT);
    read(g.albedo, picture.albedo, GL_RGBA, GL_UNSIGNED_BYTE);
    gpuScene.forget();
    return picture;
  }
};

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

/// The room for a quad that is deformed is that of a quad, however much stands still beside it.
TEST_F(GpuSceneTest, DeformedVerticesTakeRoomForThemselves) {
  scene::Scene scene;
  scene::Primitive morphed = floorPrimitive(1, addMaterial(scene));
  morphed.morphTargets.emplace_back().positions.assign(4, {0, 1, 0});
  morphed.morphTargets[0].deltaBounds = {{0, 0, 0}, {0, 1, 0}};
  const int floor = addMesh(scene, morphed), sphere = addMesh(scene, spherePrimitive(1, 0));
  scene::Pose pose;
  addInstance(scene, pose, sphere);
  addInstance(scene, pose, floor);
  pose.instances[1].deformed = 0;
  pose.deformed.push_back({floor, 0, {}, {0.5f}});
  scene::GpuScene gpuScene(device(), scene);
  const int64_t before = device().counters().bufferBytes;
  gpuScene.update(pose, scene::lookAt({0, 2, 4}, {0, 0, 0}, 0.6f), {kSide, kSide}, 0);
  EXPECT_LT(device().counters().bufferBytes - before, 4096);
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

/// Shaders reach no further into a buffer than the device's largest storage block.
TEST_F(GpuSceneTest, SkinsAndMorphTargetsLargerThanAStorageBufferAreRefused) {
  const auto most = static_cast<size_t>(device().limits().maxStorageBlockBytes);
  constexpr size_t skinBytes = 4 * sizeof(uint16_t) + 4 * sizeof(float), morphBytes = 9 * sizeof(float);
  const auto refusal = [](scene::Primitive primitive) {
    scene::Scene scene;
    primitive.material = addMaterial(scene);
    addMesh(scene, std::move(primitive));
    return errorOf([&] { const scene::GpuScene tooLarge(device(), scene); });
  };
  scene::Primitive skinned = floorPrimitive(1, 0), morphed = spherePrimitive(1, 0, 128);
  skinned.joints.resize(most / skinBytes + 1);
  morphed.morphTargets.resize(most / (morphBytes * morphed.positions.size()) + 1);
  const std::string limit = fmt::format("more than the {} MiB of a storage buffer", most >> 20);
  EXPECT_THAT(refusal(std::move(skinned)),
              AllOf(StartsWith("scene: joints and weights of skins take "), EndsWith(limit)));
  EXPECT_THAT(refusal(std::move(morphed)), AllOf(StartsWith("scene: morph targets take "), EndsWith(limit)));
}

TEST_F(GpuSceneTest, VerticesAndTrianglesLargerThanAStorageBufferAreRefused) {
  const auto most = static_cast<size_t>(device().limits().maxStorageBlockBytes);
  const auto refusal = [](const scene::Primitive& primitive) {
    scene::Scene scene;
    addMaterial(scene);
    addMesh(scene, primitive);
    std::string message;
    try {
      const scene::GpuScene tooLarge(device(), scene);
    } catch (const UsageError& error) {
      message = error.what();
    }
    return message;
  };
  const std::string limit = fmt::format("more than the {} MiB of a storage buffer", most >> 20);
  scene::Primitive vertices = floorPrimitive(1, 0), triangles = vertices;
  vertices.positions.resize(most / sizeof(glm::vec3) + 1);
  triangles.indices.resize(most / sizeof(uint32_t) + 1);
  EXPECT_THAT(refusal(vertices), AllOf(StartsWith("scene: positions of vertices take "), EndsWith(limit)));
  EXPECT_THAT(refusal(triangles), AllOf(StartsWith("scene: indices of triangles take "), EndsWith(limit)));
}

/// A skin's vertices are there twice, at rest and in their pose.
TEST_F(GpuSceneTest, DeformedVerticesLargerThanAStorageBufferAreRefusedInEachFrame) {
  scene::Scene scene;
  scene::Primitive skinned = floorPrimitive(1, addMaterial(scene));
  const size_t count = static_cast<size_t>(device().limits().maxStorageBlockBytes) / 28;
  skinned.positions.resize(count);
  skinned.joints.resize(count);
  skinned.weights.resize(count, glm::vec4(1, 0, 0, 0));
  skinned.jointBounds = {{0, skinned.bounds}};
  addMesh(scene, std::move(skinned));
  scene.skins.push_back({{0}, {glm::mat4(1)}});
  scene.nodes.resize(1);
  scene.nodes[0].mesh = scene.nodes[0].skin = 0;
  scene::GpuScene gpuScene(device(), scene);
  const scene::Pose pose = scene::evaluate(scene, 0);
  const auto camera = scene::lookAt({0, 2, 4}, {0, 0, 0}, 0.6f);
  for (int frame = 0; frame < 2; ++frame)
    EXPECT_THAT(errorOf([&] {
                  gpuScene.update(pose, camera, {kSide, kSide}, 0);
                }),
                StartsWith("scene: attributes of vertices take "))
        << frame;
}

TEST_F(GpuSceneTest, OnlyWhatMovesIsTouched) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(1, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, pointLight({0, 2, 0}));
  scene::GpuScene gpuScene(device(), scene);
  auto camera = scene::lookAt({0, 2, 4}, {0, 0, 0}, 0.6f);
  EXPECT_FALSE(gpuScene.update(pose, camera, {kSide, kSide}, 0));
  frame::ResourcePool pool(device());
  frame::FrameGraph graph;
  const SceneHandles handles = gpuScene.import(graph);
  // A stand-in for a shadow map: depends on geometry, instances and lights, not on the camera.
  frame::PassBuilder builder = graph.addPass("map");
  scene::GpuScene::declareReads(builder, handles);
  builder.read(handles.lights, frame::Access::storageLoad, "test");
  int runs = 0;
  const auto out = builder.write(graph.createBuffer("out", {16}), frame::Access::copyTarget, "test");
  builder.cacheable().execute([&](frame::PassContext&) { ++runs; });
  graph.output(out);
  graph.prepare(device(), shaders(), pool);
  graph.execute();
  EXPECT_EQ(runs, 1);

  camera = scene::lookAt({1, 2, 4}, {0, 0, 0}, 0.6f);
  EXPECT_FALSE(gpuScene.update(pose, camera, {kSide, kSide}, 1));
  graph.execute();
  EXPECT_EQ(runs, 1);
  pose.instances[0].objectToWorld = at(0, 1, 0);
  EXPECT_FALSE(gpuScene.update(pose, camera, {kSide, kSide}, 2));
  graph.execute();
  EXPECT_EQ(runs, 2);
  pose.lights[0].position.x = 1;
  EXPECT_FALSE(gpuScene.update(pose, camera, {kSide, kSide}, 3));
  graph.execute();
  EXPECT_EQ(runs, 3);
  addLight(pose, pointLight({0, 3, 0}));
  EXPECT_TRUE(gpuScene.update(pose, camera, {kSide, kSide}, 4));
  gpuScene.forget();
}

}  // namespace
}  // namespace limn
