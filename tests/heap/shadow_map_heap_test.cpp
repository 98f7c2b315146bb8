// Fitting shadow maps takes lists of boxes and views; while nothing moves, none are made.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "core/shadow/shadow_map.h"
#include "tests/gpu/gl_test.h"
#include "tests/heap/counted_allocations.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;

class ShadowMapHeap : public GlTest {};

TEST_F(ShadowMapHeap, whatStandsStillIsNotFittedAgain) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(20, addMaterial(scene)));
  addMesh(scene, spherePrimitive(0.3f, 0));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addInstance(scene, pose, 1, at(0, 1, 0));
  addLight(pose, rectangleLight({0, 8, 0}, {0, -1, 0}, 2, 1));
  scene::GpuScene gpuScene(device(), scene);
  const scene::CameraPose camera = scene::lookAt({0, 2, 3}, {0, 0, 0}, 0.5f);
  gpuScene.update(pose, camera, {64, 64}, 0);
  FrameServices services;
  auto& service = services.add<shadow::ShadowMapService>(device(), gpuScene);
  frame::FrameGraph graph;
  const auto building = services.begin(graph, gpuScene.import(graph), pose);
  const std::vector<uint32_t> lights{0};
  for (const shadow::MapFit fit : {shadow::MapFit::scene, shadow::MapFit::view})
    graph.output(service.request(lights, {.size = 16, .fit = fit}).depth);
  for (uint32_t frame = 1; frame < 4; ++frame) {
    gpuScene.update(pose, camera, {64, 64}, frame);
    const CountedAllocations allocations;
    const bool rebuild = services.update(graph, pose);
    const int64_t count = allocations.count();
    EXPECT_FALSE(rebuild);
    EXPECT_EQ(count, 0) << "frame " << frame;
  }
  gpuScene.forget();
}

}  // namespace
}  // namespace limn
