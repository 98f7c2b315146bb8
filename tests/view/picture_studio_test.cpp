// The work of the rendering thread, step by step and without a window.
#include "apps/view/picture_studio.h"

#include <gtest/gtest.h>

#include "core/base/file.h"
#include "tests/cli/process.h"
#include "tests/support/gltf_builder.h"

namespace limn::app {
namespace {

using test::GltfBuilder;

/// A lamp of a mesh, seen from above.
std::vector<std::byte> lamp() {
  GltfBuilder b;
  const int material = b.append("materials", {{"emissiveFactor", {1, 1, 1}}, {"doubleSided", true}});
  const int corners = b.vec3({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  const int mesh = b.mesh({{"POSITION", corners}}, b.indices({0, 1, 2, 0, 2, 3}), material);
  b.node({{"name", "lamp"}, {"mesh", mesh}});
  return b.glb();
}

/// A picture that is made again gives the scene its lights again, for which the truth stops reading it. Where
/// these were changed meanwhile and are as before, the question is the same, and it must be asked again.
TEST(PictureStudio, TheTruthGoesOnWhenLightsAreSetAgain) {
  const test::TemporaryFolder folder;
  writeFile(folder / "lamp.glb", lamp());
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  PictureStudio studio(
      device, {}, {}, [&](const PictureFacts& newest) { facts = newest; }, [] {});
  PictureOrder order;
  order.scene.scene = (folder / "lamp.glb").string();
  order.scene.defaultLights = "on";  // which follow the camera
  order.scene.lightSettings = {"lamp.intensity=3"};
  studio.open({.scene = order.scene});
  ASSERT_TRUE(facts.scene) << facts.message;
  order.of = facts.scene;
  order.size = {16, 12};
  order.beside = Beside::reference;
  const auto never = [] { return false; };
  studio.step(order, never);
  EXPECT_EQ(facts.picture.problem, "");
  EXPECT_TRUE(facts.reference.running);
  order.tone.exposureEv = 1;
  studio.step(order, never);
  EXPECT_TRUE(facts.reference.running);
}

}  // namespace
}  // namespace limn::app
