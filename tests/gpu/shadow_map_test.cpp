#include "core/shadow/shadow_map.h"

#include <gmock/gmock.h>

#include <random>

#include "core/base/error.h"
#include "core/shadow/light_fit.h"
#include "tests/gpu/gl_test.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

constexpr int kTexels = 128;

/// Shadow maps on the CPU.
struct Maps {
  std::vector<glsl::ShadowView> views;
  std::vector<glsl::ShadowLight> lights;
  std::vector<shadow::ShadowMapStats> stats;
  std::vector<float> depth;
  int size = 0;

  float stored(int layer, int x, int y) const {
    return depth[(static_cast<size_t>(layer) * static_cast<size_t>(size) + static_cast<size_t>(y)) *
                     static_cast<size_t>(size) +
                 static_cast<size_t>(x)];
  }
  /// Offset of what a texel sees from its view's origin, in world axes.
  vec3 seen(int layer, int x, int y) const {
    const glsl::ShadowView& view = views[static_cast<size_t>(layer)];
    return glsl::shadow_world_offset(view, glsl::shadow_texel_offset(view, {x, y}, stored(layer, x, y)));
  }
};

/// Holds what a renderer has of a scene while it asks for shadow maps and executes their graph.
struct Asking {
  scene::GpuScene gpuScene;
  FrameServices services;
  shadow::ShadowMapService& service;
  frame::ResourcePool pool;
  frame::FrameGraph graph;
  FrameServices::Building building;

  Asking(gpu::Device& device, const scene::Scene& scene, const scene::Pose& pose,
         const scene::CameraPose& camera)
      : gpuScene(device, scene),
        service(services.add<shadow::ShadowMapService>(device, gpuScene)),
        pool(device),
        building(begin(pose, camera)) {}
  ~Asking() { gpuScene.forget(); }

 private:
  FrameServices::Building begin(const scene::Pose& pose, const scene::CameraPose& camera) {
    gpuScene.update(pose, camera, {64, 64}, 0);
    return services.begin(graph, gpuScene.import(graph), pose);
  }
};

class ShadowMapTest : public GlTest {
 protected:
  Maps draw(const scene::Scene& scene, const scene::Pose& pose, std::vector<uint32_t> lights,
            const shadow::ShadowMapDesc& desc) {
    Asking asking(device(), scene, pose, scene::frameBounds(pose.bounds));
    const shadow::ShadowMaps maps = asking.service.request(lights, desc);
    asking.graph.output(maps.depth);
    asking.graph.prepare(device(), shaders(), asking.pool);
    asking.graph.execute();
    Maps out;
    out.size = desc.size;
    out.stats = asking.service.stats();
    out.views.resize(static_cast<size_t>(maps.layers));
    out.depth.resize(static_cast<size_t>(maps.layers * desc.size * desc.size));
    const gpu::Buffer& views = asking.graph.buffer(maps.views);
    views.read(0, out.views.data(), views.size());
    const gpu::Buffer& shadowLights = asking.graph.buffer(maps.lights);
    out.lights.resize(shadowLights.size() / sizeof(glsl::ShadowLight));
    shadowLights.read(0, out.lights.data(), shadowLights.size());
    asking.graph.texture(maps.depth)
        .read(0, GL_RED, GL_FLOAT, out.depth.data(), out.depth.size() * sizeof(float));
    return out;
  }
};

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

/// Half cubes do not follow the view. What the light is cut by is then all of the scene, from the request on:
/// by what lies within its range alone it would be cut, and the graph built again in every frame.
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
  EXPECT_EQ(maps.layers, 5);
  asking.graph.output(maps.depth);
  asking.graph.prepare(device(), shaders(), asking.pool);
  asking.graph.execute();
  pose.lights[0].position.x += 0.01f;
  asking.gpuScene.update(pose, camera, {64, 64}, 1);
  EXPECT_FALSE(asking.services.update(asking.graph, pose));
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
