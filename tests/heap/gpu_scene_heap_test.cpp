// Bringing a scene that moves to the GPU allocates nothing on the heap.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/gpu_scene/gpu_scene.h"
#include "core/scene/camera.h"
#include "core/scene_io/load.h"
#include "tests/gpu/gl_test.h"
#include "tests/heap/counted_allocations.h"
#include "tests/support/paths.h"

namespace limn {
namespace {

class GpuSceneHeap : public GlTest {};

/// A skin whose joints move in each frame, and a camera that turns.
TEST_F(GpuSceneHeap, updatesReuseTheirMemory) {
  const scene::Scene scene =
      scene::load(std::filesystem::path(test::kBinaryDir) / "assets" / "robot" / "robot.glb");
  scene::GpuScene gpuScene(device(), scene);
  scene::Pose pose;
  const auto show = [&](uint32_t frame) {
    scene::evaluate(scene, 0.1 * frame, scene::kNone, pose);
    const float turn = 0.01f * static_cast<float>(frame);
    gpuScene.update(pose, scene::lookAt({turn, 1, 5}, {0, 1, 0}, 0.5f), {64, 64}, frame);
  };
  for (uint32_t frame = 0; frame < 4; ++frame) show(frame);
  ASSERT_FALSE(pose.deformed.empty());
  const test::CountedAllocations allocations;
  for (uint32_t frame = 4; frame < 20; ++frame) show(frame);
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace limn
