// Evaluating a scene anew allocates nothing on the heap.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>

#include "core/scene/scene.h"
#include "core/scene_io/load.h"
#include "tests/heap/counted_allocations.h"
#include "tests/support/paths.h"
#include "tests/support/test_scenes.h"

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

/// The parts of a textured lamp are numbered, with names that are longer than a string holds in itself.
TEST(SceneEvaluateHeap, numberedNamesReuseTheirMemory) {
  Scene scene;
  Primitive lamp = test::floorPrimitive(1, test::addMaterial(scene));
  EmissivePart part;
  part.quad = {{0, 0, 0}, {2, 0, 0}, {0, 0, -2}};
  lamp.emissiveParts.assign(2, part);
  Node node;
  node.name = "a lamp whose name is longer than most names are";
  node.mesh = test::addMesh(scene, std::move(lamp));
  scene.nodes.push_back(node);
  Pose pose;
  evaluate(scene, 0, kNone, pose);
  ASSERT_EQ(pose.lightNames.size(), 2u);
  EXPECT_EQ(pose.lightNames[1], node.name + "#1");
  const test::CountedAllocations allocations;
  for (int i = 1; i < 4; ++i) evaluate(scene, 0.1 * i, kNone, pose);
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace limn::scene
