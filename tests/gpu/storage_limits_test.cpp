// Shaders reach no further into a buffer than the device's largest storage block: what a frame takes more of
// is refused in one line.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

#include "core/gpu_scene/gpu_scene.h"
#include "core/gpu_scene/pixel_blocks.h"
#include "core/scene/camera.h"
#include "tests/gpu/gl_test.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

class StorageLimitsTest : public GlTest {
 protected:
  static size_t most() { return static_cast<size_t>(device().limits().maxStorageBlockBytes); }

  /// What update() says of a pose.
  static std::string refusal(const scene::Scene& scene, const scene::Pose& pose) {
    scene::GpuScene gpuScene(device(), scene);
    return errorOf([&] { gpuScene.update(pose, scene::lookAt({0, 2, 4}, {0, 0, 0}, 0.6f), {64, 64}, 0); });
  }

  static void expectRefused(const std::string& message, const std::string& what) {
    EXPECT_THAT(message, ::testing::AllOf(::testing::StartsWith(what + " take "),
                                          ::testing::EndsWith(fmt::format(
                                              "more than the {} MiB of a storage buffer", most() >> 20))));
  }
};

TEST_F(StorageLimitsTest, InstancesAndLightsOfAPoseFitOrAreRefused) {
  scene::Scene scene;
  test::addMesh(scene, test::floorPrimitive(1, test::addMaterial(scene)));
  scene::Pose one;
  test::addInstance(scene, one, 0);
  scene::Pose instances = one, lights = one;
  instances.instances.resize(most() / sizeof(glsl::Instance) + 1, one.instances[0]);
  lights.lights.resize(most() / sizeof(glsl::Light) + 1);
  expectRefused(refusal(scene, instances), "scene: draw instances");
  expectRefused(refusal(scene, lights), "scene: lights");
}

TEST_F(StorageLimitsTest, JointsOfAPoseFitOrAreRefused) {
  scene::Scene scene;
  scene::Primitive skinned = test::floorPrimitive(1, test::addMaterial(scene));
  skinned.joints.assign(4, glm::u16vec4(0));
  skinned.weights.assign(4, glm::vec4(1, 0, 0, 0));
  skinned.jointBounds = {{0, skinned.bounds}};
  const int mesh = test::addMesh(scene, std::move(skinned));
  scene::Pose pose;
  test::addInstance(scene, pose, mesh);
  pose.instances[0].deformed = 0;
  scene::Deformation& state = pose.deformed.emplace_back();
  state.mesh = mesh;
  state.joints.resize(most() / sizeof(glm::mat4) + 1, glm::mat4(1));
  expectRefused(refusal(scene, pose), "scene: joint matrices");
}

TEST_F(StorageLimitsTest, PixelsOfAPictureInBlocksFitOrAreRefused) {
  constexpr size_t width = 16384;
  const glm::ivec2 size(static_cast<int>(width), static_cast<int>(most() / (sizeof(uint32_t) * width)));
  frame::FrameGraph graph;
  expectRefused(errorOf([&] { const scene::PixelBlocks blocks(graph, device(), {}, {}, size, {}, "test"); }),
                "picture: pixels that no block sees");
}

}  // namespace
}  // namespace limn
