// What scenes take of a device's memory, which of them are refused, and what is updated where something
// moves.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>
#include <utility>

#include "core/gpu_scene/gpu_scene.h"
#include "tests/gpu/gpu_scene_harness.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::StartsWith;

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
