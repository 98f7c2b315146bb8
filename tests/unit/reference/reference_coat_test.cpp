// Coats: references hold what they mirror of the environment, once.
#include <gtest/gtest.h>

#include "tests/support/reference_scene.h"

namespace limn::reference {
namespace {

using namespace test;

/// A sphere that reflects all light of a white environment: (1 - F) comes from its base, F from its coat.
World coatedFurnace() {
  World world;
  world.addInstance(world.addMesh(World::sphere(128, world.addMaterial(glm::vec3(1)))));
  glsl::MaterialModel coat{};
  coat.kind = glsl::model_coated;
  coat.options = glsl::model_option_blend;
  coat.eta = glm::vec3(1.5f);
  coat.kd = glm::vec3(1);
  for (auto& material : world.scene.materials) material.model = coat;
  world.camera = scene::lookAt({0, 0, 4}, {0, 0, 0}, 0.5f);
  world.scene.environment.width = 4;
  world.scene.environment.height = 2;
  world.scene.environment.texels.assign(8, glm::vec3(2));
  return world;
}

TEST(ReferenceCoat, MirrorAndBaseReflectAllLight) {
  World world = coatedFurnace();
  const Result result = render(world.request(24, Term::direct, 256));
  EXPECT_LT(meanRelativeError(world, result.image, "R", [](const glm::dvec3&) { return 2.0; }), 0.005);
}

}  // namespace
}  // namespace limn::reference
