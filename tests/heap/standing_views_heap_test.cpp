// Fitting views of shadow maps and of caustic rays takes lists of boxes, points and views; while nothing
// moves, none are made.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "core/caustics/caustic_rays.h"
#include "core/shadow/shadow_map.h"
#include "tests/gpu/gl_test.h"
#include "tests/heap/counted_allocations.h"
#include "tests/support/scene_nodes.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;

class StandingViews : public GlTest {
 protected:
  /// Shows a ball of this material between floor and lamp: `add` adds services and returns the one that `ask`
  /// then asks for maps.
  template <class Add, class Ask>
  void expectNothingMade(const scene::Material& ball, Add add, Ask ask) {
    scene::Scene scene;
    addMesh(scene, floorPrimitive(20, addMaterial(scene)));
    addMesh(scene, spherePrimitive(0.3f, addMaterial(scene, ball)));
    scene::Pose pose;
    addInstance(scene, pose, 0);
    addInstance(scene, pose, 1, at(0, 1, 0));
    addLight(pose, rectangleLight({0, 8, 0}, {0, -1, 0}, 2, 1));
    scene::GpuScene gpuScene(device(), scene);
    const scene::CameraPose camera = scene::lookAt({0, 2, 3}, {0, 0, 0}, 0.5f);
    gpuScene.update(pose, camera, {64, 64}, 0);
    FrameServices services;
    auto& service = add(services, gpuScene);
    frame::FrameGraph graph;
    const auto building = services.begin(graph, gpuScene.import(graph), pose);
    ask(service, graph, std::vector<uint32_t>{0});
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
};

using ShadowMapHeap = StandingViews;
using CausticRaysHeap = StandingViews;

TEST_F(ShadowMapHeap, whatStandsStillIsNotFittedAgain) {
  expectNothingMade(
      {},
      [&](FrameServices & services, scene::GpuScene & scene) -> auto& {
        return services.add<shadow::ShadowMapService>(device(), scene);
      },
      [](shadow::ShadowMapService& service, frame::FrameGraph& graph, const std::vector<uint32_t>& lights) {
        for (const shadow::MapFit fit : {shadow::MapFit::scene, shadow::MapFit::view})
          graph.output(service.request(lights, {.size = 16, .fit = fit}).depth);
      });
}

/// What the camera sees changes maps that are fitted to it and no others, however many there are.
TEST_F(ShadowMapHeap, mapsOfTheSceneAreNotFittedAgainForACameraThatMoves) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(20, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, rectangleLight({0, 8, 0}, {0, -1, 0}, 2, 1));
  const auto look = [](float x) { return scene::lookAt({x, 2, 3}, {x, 0, 0}, 0.5f); };
  const std::vector<uint32_t> lights{0};
  int64_t taken[2] = {};  // without maps of the scene, and with some
  for (const bool others : {false, true}) {
    scene::GpuScene gpuScene(device(), scene);
    gpuScene.update(pose, look(0), {64, 64}, 0);
    FrameServices services;
    auto& service = services.add<shadow::ShadowMapService>(device(), gpuScene);
    frame::FrameGraph graph;
    const auto building = services.begin(graph, gpuScene.import(graph), pose);
    graph.output(service.request(lights, {.size = 16, .fit = shadow::MapFit::view}).depth);
    for (const int size : {32, 64}) {
      if (others) graph.output(service.request(lights, {.size = size}).depth);
    }
    for (uint32_t frame = 1; frame < 6; ++frame) {
      gpuScene.update(pose, look(0.5f * static_cast<float>(frame)), {64, 64}, frame);
      const CountedAllocations allocations;
      const bool rebuild = services.update(graph, pose);
      taken[others ? 1 : 0] = allocations.count();
      EXPECT_FALSE(rebuild);
    }
    gpuScene.forget();
  }
  EXPECT_GT(taken[0], 0);
  EXPECT_EQ(taken[1], taken[0]);
}

TEST_F(CausticRaysHeap, viewsOfWhatStandsStillAreNotFittedAgain) {
  expectNothingMade(
      glass(1.5f),
      [&](FrameServices & services, scene::GpuScene & scene) -> auto& {
        services.add<shadow::ShadowMapService>(device(), scene);
        return services.add<caustics::CausticRayService>(device(), scene);
      },
      [](caustics::CausticRayService& service, frame::FrameGraph& graph,
         const std::vector<uint32_t>& lights) {
        const caustics::CausticRays rays =
            service.request(lights, {.size = 16, .sceneSize = 16, .lightSamples = 4});
        EXPECT_EQ(rays.layers, 4);
        graph.output(rays.rays);
      });
}

}  // namespace
}  // namespace limn
