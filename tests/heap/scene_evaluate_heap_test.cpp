// Evaluating a scene anew allocates nothing on the heap.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/scene/scene.h"
#include "core/scene_io/load.h"
#include "tests/heap/counted_allocations.h"
#include "tests/support/paths.h"

namespace limn::scene {
namespace {

TEST(SceneEvaluateHeap, reusesItsMemory) {
  for (const char* name : {"robot", "lights", "patrol"}) {
    const Scene scene =
        load(std::filesystem::path(test::kBinaryDir) / "assets" / name / (std::string(name) + ".glb"));
    Pose pose;
    evaluate(scene, 0, kNone, pose);
    const test::CountedAllocations allocations;
    for (int i = 1; i < 20; ++i) evaluate(scene, 0.1 * i, kNone, pose);
    EXPECT_EQ(allocations.count(), 0) << name;
  }
}

}  // namespace
}  // namespace limn::scene
