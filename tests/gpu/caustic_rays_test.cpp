// Caustic rays of a graph of their own: their flux behind glass, and when they need another graph.
#include "core/caustics/caustic_rays.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/scene/camera.h"
#include "tests/gpu/gl_test.h"
#include "tests/support/scene_nodes.h"

namespace limn::caustics {
namespace {

using glm::vec3;

/// Holds what a renderer has of a scene while it asks for caustic rays and executes their graph.
struct AskingForRays {
  scene::GpuScene gpuScene;
  FrameServices services;
  CausticRayService& service;
  frame::ResourcePool pool;
  frame::FrameGraph graph;
  FrameServices::Building building;

  AskingForRays(gpu::Device& device, const scene::Scene& scene, const scene::Pose& pose)
      : gpuScene(device, scene), service(addServices(device)), pool(device), building(begin(pose)) {}
  ~AskingForRays() { gpuScene.forget(); }

  void moveTo(const scene::Pose& pose) {
    gpuScene.update(pose, scene::frameBounds(pose.bounds), {64, 64}, 0);
  }

 private:
  CausticRayService& addServices(gpu::Device& device) {
    services.add<shadow::ShadowMapService>(device, gpuScene);
    return services.add<CausticRayService>(device, gpuScene);
  }
  FrameServices::Building begin(const scene::Pose& pose) {
    moveTo(pose);
    return services.begin(graph, gpuScene.import(graph), pose);
  }
};

class CausticRaysTest : public GlTest {
 protected:
  std::vector<glsl::CausticRay> trace(const scene::Scene& scene, const scene::Pose& pose,
                                      const CausticRayDesc& desc) {
    AskingForRays asking(device(), scene, pose);
    const std::vector<uint32_t> lights{0};
    const CausticRays made = asking.service.request(lights, desc);
    std::vector<glsl::CausticRay> rays(static_cast<size_t>(made.count()));
    if (rays.empty()) return rays;
    asking.graph.output(made.rays);
    asking.graph.prepare(device(), shaders(), asking.pool);
    asking.graph.execute();
    asking.graph.buffer(made.rays).read(0, rays.data(), rays.size() * sizeof(rays[0]));
    return rays;
  }
};

/// The sun shines through the front of a prism without walls and its tilted back: all rays that do so have
/// the same flux. A mirror over the prism hides a part of it. There image space knows nothing of the prism,
/// and light that comes under the mirror leaves the prism where the mirror's picture begins. The nearest
/// texel is the mirror's then, whose normal is not to change the flux: by a fifth here.
TEST_F(CausticRaysTest, LightThatLeavesABodyBesideAnotherHasTheNormalsOfItsOwn) {
  constexpr float wedge = 0.15f;
  for (const float turn : {0.3f, 0.8f, 1.3f}) {
    SCOPED_TRACE(turn);
    scene::Scene scene;
    const int glass = test::addMaterial(scene, test::glass(1.5f));
    const int silver = test::addMaterial(scene, test::silver());
    const int matte = test::addMaterial(scene, test::lambertian(0.5f));
    const scene::Primitive back =
        test::quad({0, 0, 0.4f}, {2 * std::cos(wedge), 0, 2 * std::sin(wedge)}, {0, -2, 0}, glass);
    const int prism = test::addMesh(
        scene, test::finish(test::joined(test::quad({0, 0, 0.7f}, {2, 0, 0}, {0, 2, 0}, glass), back)));
    const int mirror = test::addMesh(
        scene, test::finish(test::quad({-0.25f, -0.1f, 1.2f}, {1, 0.45f, -0.85f}, {-0.45f, 1, 0}, silver)));
    const int ground =
        test::addMesh(scene, test::finish(test::quad({0, 0, -1}, {8, 0, 0}, {0, 8, 0}, matte)));
    scene::Pose pose;
    test::addInstance(scene, pose, prism, glm::rotate(glm::mat4(1), turn, vec3(0, 0, 1)));
    test::addInstance(scene, pose, mirror);
    test::addInstance(scene, pose, ground);
    test::addLight(pose, test::directionalLight({0.5f, 0.2f, -1}, 0));
    std::vector<double> fluxes;  // far from the prism's own edges, where light passes one of its sides alone
    for (const glsl::CausticRay& ray :
         trace(scene, pose, {.size = 64, .sceneSize = 64, .paths = glsl::caustic_refraction}))
      if (ray.power.x > 0 && std::hypot(ray.start.x, ray.start.y) < 0.7f)
        fluxes.push_back(double(ray.power.x));
    ASSERT_GT(fluxes.size(), 100u);
    std::ranges::sort(fluxes);
    const double usual = fluxes[fluxes.size() / 2];
    EXPECT_NEAR(fluxes.front() / usual, 1, 1e-3);
    EXPECT_NEAR(fluxes.back() / usual, 1, 1e-3);
  }
}

/// Light is searched for where it leaves an object at points over as many metres as the widest object has,
/// not over the 20 m to another: or a body would lose its folds because of something far away.
TEST_F(CausticRaysTest, WaysThroughAnObjectAreAsLongAsTheWidestIs) {
  scene::Scene scene;
  const int glass = test::addMaterial(scene, test::glass(1.5f));
  const int wide = test::addMesh(scene, test::finish(test::quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, glass)));
  const int ground = test::addMesh(scene, test::floorPrimitive(2, test::addMaterial(scene)));
  scene::Pose pose;
  test::addInstance(scene, pose, wide);
  test::addInstance(scene, pose, wide, test::at(20, 0, 0, 0.5f));
  test::addInstance(scene, pose, ground, test::at(0, -1, 0));
  test::addLight(pose, test::directionalLight({0, 0, -1}, 0));
  AskingForRays asking(device(), scene, pose);
  const std::vector<uint32_t> lights{0};
  const CausticRays made = asking.service.request(lights, {.size = 16, .sceneSize = 16});
  ASSERT_EQ(made.layers, 1);
  asking.graph.output(made.rays);
  asking.graph.prepare(device(), shaders(), asking.pool);
  asking.graph.execute();
  glsl::CausticLayer layer{};
  asking.graph.buffer(made.layerLights).read(0, &layer, sizeof(layer));
  EXPECT_NEAR(double(layer.diameter), std::sqrt(8.0), 1e-5);
}

/// Rays of a texel take next to no memory: what is too much is their layers, one for each point on a light.
TEST_F(CausticRaysTest, MoreLayersThanTheDeviceHasAreRefusedAsWhatTheyAre) {
  scene::Scene scene;
  test::addMesh(scene, test::spherePrimitive(0.3f, test::addMaterial(scene, test::glass(1.5f)), 8));
  scene::Pose pose;
  test::addInstance(scene, pose, 0);
  std::vector<uint32_t> lights;
  for (int points = 0; points <= device().limits().maxArrayLayers; points += 64)
    lights.push_back(test::addLight(pose, test::rectangleLight({0, 4, 0}, {0, -1, 0}, 1, 1)));
  AskingForRays asking(device(), scene, pose);
  std::string message;
  try {
    asking.service.request(lights, {.size = 1, .sceneSize = 16, .lightSamples = 64});
  } catch (const UsageError& error) {
    message = error.what();
  }
  EXPECT_THAT(message, testing::HasSubstr(fmt::format("caustic rays in {} layers: the device has at most",
                                                      64 * lights.size())));
}

/// A scene without glass has no rays. Where glass appears, those who asked for them need another graph, and
/// nobody else does.
TEST_F(CausticRaysTest, OnlyWhoAsksForRaysHasTheGraphBuiltAgainForThem) {
  scene::Scene scene;
  const int ground = test::addMesh(scene, test::floorPrimitive(2, test::addMaterial(scene)));
  const int ball =
      test::addMesh(scene, test::spherePrimitive(0.3f, test::addMaterial(scene, test::glass(1.5f)), 8));
  scene::Pose pose;
  test::addInstance(scene, pose, ground);
  test::addLight(pose, test::directionalLight({0, -1, 0}, 0));
  scene::Pose later = pose;
  test::addInstance(scene, later, ball, test::at(0, 1, 0));
  for (const bool asked : {false, true}) {
    AskingForRays asking(device(), scene, pose);
    const std::vector<uint32_t> lights{0};
    if (asked) {
      EXPECT_EQ(asking.service.request(lights, {.size = 16, .sceneSize = 16}).count(), 0);
    }
    asking.moveTo(later);
    EXPECT_EQ(asking.services.update(asking.graph, later), asked);
  }
}

}  // namespace
}  // namespace limn::caustics
