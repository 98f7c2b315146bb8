// Requests for shadow maps: what is shared, cached and refused, and when maps follow what moves.
#include <gmock/gmock.h>

#include <vector>

#include "core/base/error.h"
#include "core/scene/camera.h"
#include "tests/gpu/shadow_map_harness.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;

TEST_F(ShadowMapTest, LightsThatGainOrLoseExtentHaveTheGraphBuiltAgain) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, directionalLight({0, -1, 0}, 0));
  scene::GpuScene gpuScene(device(), scene);
  gpuScene.update(pose, scene::frameBounds(pose.bounds), {64, 64}, 0);
  FrameServices services;
  auto& service = services.add<shadow::ShadowMapService>(device(), gpuScene);
  const std::vector<uint32_t> lights{0};
  int layers = 1;
  for (const float next : {0.1f, 0.f}) {
    frame::FrameGraph graph;
    const auto building = services.begin(graph, gpuScene.import(graph), pose);
    const shadow::ShadowMaps maps =
        service.request(lights, {.size = 16, .samples = {{0, 0}, {1, 0}, {0, 1}, {1, 1}}});
    EXPECT_EQ(maps.layers, layers);
    EXPECT_FALSE(services.update(graph, pose));
    pose.lights[0].angular_diameter = next;
    EXPECT_TRUE(services.update(graph, pose)) << "to an angle of " << next;
    EXPECT_TRUE(services.update(graph, pose)) << "until it is";
    layers = 5 - layers;
    gpuScene.forget();
  }
}

TEST_F(ShadowMapTest, StaticMapsAreCachedAndSharedAndFollowWhatMoves) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, rectangleLight({0, 4, 0}, {0, -1, 0}, 2, 1));
  const auto camera = scene::frameBounds(pose.bounds);
  Asking asking(device(), scene, pose, camera);
  const std::vector<uint32_t> lights{0};
  const shadow::ShadowMaps maps = asking.service.request(lights, {.size = 64});
  EXPECT_EQ(asking.service.request(lights, {.size = 64}).depth, maps.depth);
  const shadow::ShadowMaps small = asking.service.request(lights, {.size = 16});
  EXPECT_NE(small.depth, maps.depth);
  EXPECT_EQ(asking.service.request(lights, {.size = 16, .views = 0}).depth, small.depth)
      << "too small to be cut";
  EXPECT_NE(asking.service.request(lights, {.size = 16, .views = 2}).depth, small.depth);
  asking.graph.output(maps.depth);
  asking.graph.prepare(device(), shaders(), asking.pool);
  const auto state = [&] {
    asking.graph.execute();
    for (const frame::PassReport& report : asking.graph.explain()) {
      if (report.name == "shadow maps") return report.state;
    }
    return frame::PassState::leftOut;
  };
  EXPECT_EQ(state(), frame::PassState::run);
  EXPECT_EQ(state(), frame::PassState::cached);
  asking.gpuScene.update(pose, scene::lookAt({1, 2, 3}, {0, 0, 0}, 0.5f), {64, 64}, 1);
  EXPECT_FALSE(asking.services.update(asking.graph, pose));
  EXPECT_EQ(state(), frame::PassState::cached);
  pose.lights[0].position.x = 0.5f;
  asking.gpuScene.update(pose, camera, {64, 64}, 2);
  EXPECT_FALSE(asking.services.update(asking.graph, pose));
  EXPECT_EQ(state(), frame::PassState::run);
  pose.lights[0].position.y = 0.1f;
  asking.gpuScene.update(pose, camera, {64, 64}, 3);
  EXPECT_TRUE(asking.services.update(asking.graph, pose)) << "one map is not enough any more";
}

/// Cubes from one point are whole however they are fitted; from samples each face follows the view.
TEST_F(ShadowMapTest, MapsThatDoNotFollowTheViewAreSharedHoweverTheyAreFitted) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, pointLight({0, 1, 0}));
  Asking asking(device(), scene, pose, scene::frameBounds(pose.bounds));
  const std::vector<uint32_t> lights{0};
  const auto view = shadow::MapFit::view;
  const shadow::ShadowMaps whole = asking.service.request(lights, {.size = 16});
  EXPECT_EQ(asking.service.request(lights, {.size = 16, .fit = view, .lightSize = 0.1f}).depth, whole.depth);
  const shadow::ShadowMaps sampled =
      asking.service.request(lights, {.size = 16, .samples = {{0, 0}, {1, 1}}});
  EXPECT_NE(asking.service.request(lights, {.size = 16, .samples = {{0, 0}, {1, 1}}, .fit = view}).depth,
            sampled.depth);
}

/// Half cubes do not follow the view. What the light is cut by is still what lies within its range, as
/// layersOf() says, in every frame: by all of the scene it would not be cut.
TEST_F(ShadowMapTest, LightsWithARangeAreCutTheSameInEveryFrame) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(20, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addInstance(scene, pose, 0, at(60, 30, 0));
  addLight(pose, rectangleLight({0, 1, 0}, {0, -1, 0}, 0.5f, 0.5f));
  pose.lights[0].range = 6;
  const shadow::ShadowMapDesc desc{.size = 64, .views = 0, .fit = shadow::MapFit::view};
  const scene::CameraPose camera = scene::frameBounds(pose.bounds);
  Asking asking(device(), scene, pose, camera);
  const std::vector<uint32_t> lights{0};
  const shadow::ShadowMaps maps = asking.service.request(lights, desc);
  EXPECT_EQ(asking.service.layersOf(0, desc), 20);
  EXPECT_EQ(asking.service.layersOf(0, {.size = 64, .views = 0}), 5);
  EXPECT_EQ(maps.layers, 20);
  asking.graph.output(maps.depth);
  asking.graph.prepare(device(), shaders(), asking.pool);
  asking.graph.execute();
  pose.lights[0].position.x += 0.01f;
  asking.gpuScene.update(pose, camera, {64, 64}, 1);
  EXPECT_FALSE(asking.services.update(asking.graph, pose));
}

/// What lies within a light's range may fit one map though all of the scene needs a half cube: pictures must
/// not depend on where the light was when the maps were asked for.
TEST_F(ShadowMapTest, MapsFollowTheViewAsSoonAsTheLightLetsThem) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(20, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, rectangleLight({0, 1, 0}, {0, -1, 0}, 0.5f, 0.5f));
  pose.lights[0].range = 6;
  const shadow::ShadowMapDesc desc{.size = 64, .fit = shadow::MapFit::view};
  const scene::CameraPose camera = scene::frameBounds(pose.bounds);
  Asking asking(device(), scene, pose, camera);
  const std::vector<uint32_t> lights{0};
  const shadow::ShadowMaps maps = asking.service.request(lights, desc);
  EXPECT_EQ(maps.layers, 5);
  asking.graph.output(maps.depth);
  asking.graph.prepare(device(), shaders(), asking.pool);
  asking.graph.execute();
  pose.lights[0].position.y = 2;
  asking.gpuScene.update(pose, camera, {64, 64}, 1);
  EXPECT_TRUE(asking.services.update(asking.graph, pose));
  EXPECT_EQ(asking.service.layersOf(0, desc), 1);
  EXPECT_EQ(asking.service.layersOf(0, {.size = 64}), 5);
}

/// Cubes, too, which do not follow the view: near planes are a part of the farthest that is lit, and what is
/// nearer blocks nothing.
TEST_F(ShadowMapTest, MapsFittedToTheViewEndWithTheRangeOfALight) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(3, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addInstance(scene, pose, 0, at(0, 1e4f, 0));
  addLight(pose, pointLight({0, 0.5f, 0}));
  pose.lights[0].range = 2;
  const Maps maps = draw(scene, pose, {0}, {.size = 16, .fit = shadow::MapFit::view});
  ASSERT_EQ(maps.views.size(), 6u);
  for (const glsl::ShadowView& view : maps.views) {
    EXPECT_LT(view.far, 2.01f);
    EXPECT_LT(view.near, 0.5f);
  }
  EXPECT_GT(draw(scene, pose, {0}, {.size = 16}).views[0].near, 0.9f) << "of the whole scene";
}

TEST_F(ShadowMapTest, MapsFittedToTheViewFollowTheCamera) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(20, addMaterial(scene)));
  addMesh(scene, spherePrimitive(0.3f, 0));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addInstance(scene, pose, 1, at(0, 1, 0));    // over what the camera sees
  addInstance(scene, pose, 1, at(12, 1, 12));  // far from it
  addLight(pose, rectangleLight({0, 8, 0}, {0, -1, 0}, 2, 1));
  const auto look = [](float x) { return scene::lookAt({x, 2, 3}, {x, 0, 0}, 0.5f); };
  Asking asking(device(), scene, pose, look(0));
  const std::vector<uint32_t> lights{0};
  const shadow::ShadowMaps whole = asking.service.request(lights, {.size = 64});
  const shadow::ShadowMaps cut = asking.service.request(lights, {.size = 64, .fit = shadow::MapFit::view});
  ASSERT_NE(cut.depth, whole.depth);
  asking.graph.output(whole.depth);
  asking.graph.output(cut.depth);
  asking.graph.prepare(device(), shaders(), asking.pool);
  const auto view = [&](const shadow::ShadowMaps& maps) {
    glsl::ShadowView read;
    asking.graph.buffer(maps.views).read(0, &read, sizeof(read));
    return read;
  };
  const auto drawn = [&](float x, uint32_t frame) {
    asking.gpuScene.update(pose, look(x), {64, 64}, frame);
    EXPECT_FALSE(asking.services.update(asking.graph, pose));
    asking.graph.execute();
    int passes = 0;
    for (const frame::PassReport& report : asking.graph.explain())
      passes += report.name.starts_with("shadow maps") && report.state == frame::PassState::run ? 1 : 0;
    return passes;
  };
  EXPECT_EQ(drawn(0, 1), 2);
  EXPECT_GT(view(cut).scale, 3 * view(whole).scale);
  std::vector<float> depth(64 * 64);
  asking.graph.texture(cut.depth).read(0, GL_RED, GL_FLOAT, depth.data(), depth.size() * sizeof(float));
  const glsl::ShadowPoint ball = glsl::shadow_project(view(cut), {0, 1.3f, 0});
  ASSERT_TRUE(glsl::shadow_inside(ball));
  const auto texel = static_cast<size_t>(ball.uv.y * 64) * 64 + static_cast<size_t>(ball.uv.x * 64);
  EXPECT_NEAR(glsl::shadow_metres(view(cut), depth[texel]), 6.7f, 0.05f);
  EXPECT_EQ(drawn(0, 2), 0);
  EXPECT_EQ(drawn(0.001f, 3), 0) << "rounded: as before";
  EXPECT_EQ(drawn(2, 4), 1) << "the map of the whole scene stays";
}

TEST_F(ShadowMapTest, DerivedMapsAreKeptWhereTheMapsAre) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, pointLight({0, 4, 0}));
  scene::GpuScene gpuScene(device(), scene);
  gpuScene.update(pose, scene::frameBounds(pose.bounds), {64, 64}, 0);
  FrameServices services;
  auto& service = services.add<shadow::ShadowMapService>(device(), gpuScene);
  frame::ResourcePool pool(device());
  for (const bool cacheable : {true, false}) {
    frame::FrameGraph graph;
    const auto building = services.begin(graph, gpuScene.import(graph), pose);
    const std::vector<uint32_t> light{0};
    const shadow::ShadowMaps maps = service.request(light, {.size = 16, .cacheable = cacheable});
    const shadow::MinMaxPyramid pyramid = service.minMaxPyramid(maps);
    EXPECT_EQ(service.minMaxPyramid(maps).texture, pyramid.texture);
    EXPECT_EQ(pyramid.levels, 5);
    EXPECT_EQ(graph.desc(pyramid.texture).layers, maps.layers);
    graph.output(pyramid.texture);
    graph.output(service.summedAreaTable(maps, {}).texture);
    graph.output(service.nBuffer(maps));
    graph.output(service.minMaxWindows(maps));
    graph.prepare(device(), shaders(), pool);
    graph.execute();
    graph.execute();
    for (const frame::PassReport& row : graph.explain()) {
      if (row.state == frame::PassState::leftOut) continue;
      EXPECT_EQ(row.state, cacheable ? frame::PassState::cached : frame::PassState::run) << row.name;
    }
  }
  gpuScene.forget();
}

TEST_F(ShadowMapTest, UncoveredPixelsAreCountedAnewInEachFrameAndGraph) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  scene::GpuScene gpuScene(device(), scene);
  gpuScene.update(pose, scene::frameBounds(pose.bounds), {64, 64}, 0);
  FrameServices services;
  auto& service = services.add<shadow::ShadowMapService>(device(), gpuScene);
  frame::ResourcePool pool(device());
  {
    frame::FrameGraph graph;
    const auto building = services.begin(graph, gpuScene.import(graph), pose);
    std::vector<uint32_t> found;
    for (const uint32_t count : {3u, 5u}) {
      frame::BufferHandle& counter = service.uncoveredCounter();
      frame::PassBuilder pass = graph.addPass("count");
      counter = pass.write(counter, frame::Access::storageLoadStore, "what a visibility pass would count");
      pass.sideEffect().execute([&found, count, counter](frame::PassContext& context) {
        const gpu::Buffer& buffer = context.buffer(counter);
        uint32_t before = 0;
        buffer.read(0, &before, sizeof(before));
        found.push_back(before);
        const uint32_t after = before + count;
        context.gl().ClearNamedBufferData(buffer.id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &after);
      });
    }
    graph.prepare(device(), shaders(), pool);
    for (int i = 0; i < 2; ++i) {
      graph.execute();
      EXPECT_EQ(service.uncoveredPixels(), 8u);
    }
    EXPECT_THAT(found, testing::ElementsAre(0, 3, 0, 3));
  }
  frame::FrameGraph another;
  const auto building = services.begin(another, gpuScene.import(another), pose);
  EXPECT_EQ(service.uncoveredPixels(), 0u);
  gpuScene.forget();
}

TEST_F(ShadowMapTest, ImpossibleRequestsAreRefused) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, pointLight({0, 4, 0}));
  Asking asking(device(), scene, pose, scene::frameBounds(pose.bounds));
  const std::vector<uint32_t> light{0}, absent{1};
  EXPECT_THROW(asking.service.request(light, {.size = 0}), UsageError);
  EXPECT_THROW(asking.service.request(light, {.size = 1 << 20}), UsageError);
  EXPECT_THROW(asking.service.request(light, {.size = 16384}), UsageError);
  EXPECT_NO_THROW(asking.service.request(light, {.size = 8192})) << "3 GiB";
  EXPECT_THROW(asking.service.request(light, {.size = 8192, .reflective = true}), UsageError) << "6 GiB";
  EXPECT_THROW(asking.service.request(absent, {.size = 64}), UsageError);
}

}  // namespace
}  // namespace limn
