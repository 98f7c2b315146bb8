// A Lambertian surface under perpendicular light of irradiance E has the radiance albedo E / pi: what the
// G-buffer's formats take from it is a bias, the same for every pixel of a wall.
#include <gtest/gtest.h>

#include "core/reference/reference.h"
#include "core/scene/camera.h"
#include "tests/gpu/comparability.h"
#include "tests/gpu/render_test.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

constexpr float kIrradiance = 3;

enum class Holder { material, vertices };

/// A wall before a directional light that shines along -z, its albedo held by the material or by its
/// vertices.
scene::Scene wall(float albedo, Holder holder) {
  scene::Scene scene;
  scene::Material material;
  material.metallic = 0;
  material.specularFactor = 0;
  material.baseColour = glm::vec4(glm::vec3(holder == Holder::material ? albedo : 1.f), 1);
  scene::Primitive p = test::floorPrimitive(2, test::addMaterial(scene, material));
  if (holder == Holder::vertices) p.colours.assign(4, glm::vec4(glm::vec3(albedo), 1));
  scene.nodes.resize(2);
  scene.nodes[0].mesh = test::addMesh(scene, std::move(p));
  scene.nodes[0].transform.rotation = glm::angleAxis(0.5f * glsl::pi, glm::vec3(1, 0, 0));
  scene.nodes[1].light = 0;
  scene::LightSource light;
  light.type = glsl::light_directional;
  light.intensity = kIrradiance;
  scene.lights.push_back(light);
  return scene;
}

class AlbedoTest : public RenderTest {};

TEST_F(AlbedoTest, NoFormatTakesOrAddsLight) {
  for (const Holder holder : {Holder::material, Holder::vertices}) {
    for (const float albedo : {0.005f, 0.02f, 0.37f, 0.5f, 0.8f}) {
      const scene::Scene scene = wall(albedo, holder);
      const test::Pair pair =
          test::renderBoth(device(), scene, scene::evaluate(scene, 0),
                           scene::lookAt({0, 0, 2}, {0, 0, 0}, 0.8f), {8, 8}, Term::direct, 2);
      const float expected = albedo * kIrradiance / glsl::pi;
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(pair.image.at(3, 4, c), expected, 5e-4f * expected) << albedo;
        EXPECT_NEAR(pair.reference.at(3, 4, c), expected, 1e-5f * expected) << albedo;
      }
    }
  }
}

}  // namespace
}  // namespace limn
