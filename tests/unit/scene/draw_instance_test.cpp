// What instances of meshes and of geometry sources draw, and which way round.
#include "core/scene/draw_instance.h"

#include <gtest/gtest.h>

#include <memory>

#include "tests/support/test_scenes.h"

namespace limn::scene {
namespace {

TEST(DrawInstance, DrawsThePrimitiveAndMaterialOfItsMeshOrSource) {
  Scene scene;
  const int first = test::addMaterial(scene), second = test::addMaterial(scene);
  const int mesh = test::addMesh(scene, test::floorPrimitive(1, second));
  scene.dynamic.push_back({"source", nullptr, first});
  Pose pose;
  test::addInstance(scene, pose, mesh);
  pose.dynamic.push_back({std::make_shared<const Primitive>(test::floorPrimitive(2, second)), {}});
  pose.instances.push_back({.node = kNone, .mesh = 0});

  EXPECT_EQ(&primitiveOf(scene, pose, pose.instances[0]), &scene.meshes[0].primitives[0]);
  EXPECT_EQ(materialIndexOf(scene, pose.instances[0]), second);
  EXPECT_EQ(&primitiveOf(scene, pose, pose.instances[1]), pose.dynamic[0].primitive.get());
  EXPECT_EQ(materialIndexOf(scene, pose.instances[1]), first) << "not that of the source's triangles";
  EXPECT_EQ(&materialOf(scene, pose.instances[1]), &scene.materials[static_cast<size_t>(first)]);
}

TEST(DrawInstance, IsMirroredByItsMatrixOrTheNodeOfItsSkin) {
  DrawInstance instance;
  EXPECT_FALSE(mirrored(instance));
  instance.objectToWorld = glm::scale(glm::mat4(1), glm::vec3(1, -2, 3));
  EXPECT_TRUE(mirrored(instance));
  instance.mirroredSkin = true;
  EXPECT_FALSE(mirrored(instance));
  instance.objectToWorld = glm::mat4(1);
  EXPECT_TRUE(mirrored(instance));
}

}  // namespace
}  // namespace limn::scene
