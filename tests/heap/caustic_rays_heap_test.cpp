// Fitting the views of caustic rays takes lists of points and views; while nothing moves, none are made.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "core/caustics/caustic_rays.h"
#include "tests/gpu/gl_test.h"
#include "tests/heap/counted_allocations.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

using namespace limn::test;

class CausticRaysHeap : public GlTest {};

TEST_F(CausticRaysHeap, viewsOfWhatStandsStillAreNotFittedAgain) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(20, addMaterial(scene)));
  addMesh(scene, spherePrimitive(0.3f, addMaterial(scene, glass(1.5f))));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addInstance(scene, pose, 1, at(0, 1, 0));
  addLight(pose, rectangleLight({0, 8, 0}, {0, -1, 0}, 2, 1));
  scene::GpuScene gpuScene(device(), scene);
  const scene::CameraPose camera = scene::lookAt({0, 2, 3}, {0, 0, 0}, 0.5f);
  gpuScene.update(pose, camera, {64, 64}, 0);
  FrameServices services;
  services.add<shadow::ShadowMapService>(device(), gpuScene);
  auto& service = services.add<caustics::CausticRayService>(device(), gpuScene);
  frame::FrameGraph graph;
  const auto building = services.begin(graph, gpuScene.import(graph), pose);
  const std::vector<uint32_t> lights{0};
  const caustics::CausticRays rays =
      service.request(lights, {.size = 16, .sceneSize = 16, .lightSamples = 4});
  EXPECT_EQ(rays.layers, 4);
  graph.output(rays.rays);
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
