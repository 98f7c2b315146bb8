// What surfaces whose reflectance is a sum of products reflect of virtual lights.
#include <string>
#include <utility>
#include <vector>

#include "core/scene/camera.h"
#include "core/scene/material_model.h"
#include "glsl/materials/model.glsl"
#include "tests/gpu/render_test.h"
#include "tests/support/scene_nodes.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

/// A floor that a spot lights, and a wall of copper beside it. llvmpipe leaves all loops of a thread after
/// 65,535 steps, of which four pixels of eight products take 37 for each light.
class FactoredIndirectTest : public RenderTest {
 protected:
  static scene::Scene corner(float halfAngle) {
    glsl::MaterialModel copper{};
    copper.kind = glsl::model_torrance_sparrow;
    copper.eta = {0.2f, 0.92f, 1.1f};
    copper.k = {3.91f, 2.45f, 2.14f};
    copper.ks = glm::vec3(0.5f);
    copper.kd = glm::vec3(0.1f);
    copper.roughness = glm::vec2(0.4f);
    scene::Material metal;
    scene::setModel(metal, copper);
    scene::Scene scene;
    const int matte = test::addMaterial(scene, test::lambertian(0.6f));
    test::show(scene, test::quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}, matte));
    test::show(scene, test::quad({1, 1, 0}, {0, 0, 2}, {0, 2, 0}, test::addMaterial(scene, metal)));
    scene::LightSource spot = test::lamp(glsl::light_spot, 1000);
    spot.outerCone = halfAngle;
    test::shine(scene, spot, {0, 1, 0});
    return scene;
  }

  static Image shown(render::Renderer& renderer, const std::string& name,
                     std::vector<std::pair<std::string, std::string>> values) {
    values.emplace_back("block", "1");
    return picture(
        renderer,
        settings(16, 16, Term::indirect,
                 {technique("factored_brdf", {{"fit", "svd"}, {"terms", "8"}, {"fit_texels", "8"}}),
                  technique(name, values)}),
        scene::lookAt({-2, 1.5f, 2}, {0.8f, 0.4f, 0}, 0.7f));
  }
};

/// Many lights on a speck of the floor give what a quarter of them gives.
TEST_F(FactoredIndirectTest, AllVirtualLightsShine) {
  const scene::Scene scene = corner(0.05f);
  render::Renderer renderer(device(), scene);
  const auto light = [&](const char* lights) {
    return mean(shown(renderer, "reflective_shadow_map", {{"vpls", lights}}));
  };
  const double few = light("1024");
  ASSERT_GT(few, 0);
  EXPECT_NEAR(light("4096") / few, 1, 5e-3) << "one loop would leave out more than half";
}

/// Where a loop ends within the maps of an array, the lights behind it keep theirs.
TEST_F(FactoredIndirectTest, VirtualLightsKeepTheirMaps) {
  scene::Scene scene = corner(0.7f);
  test::show(scene, test::quad({0.5f, 0.4f, 0}, {0, 0, 0.6f}, {0, 0.6f, 0}, 0));
  render::Renderer renderer(device(), scene);
  const auto inMemory = [&](const char* mebibytes) {  // 512 maps in 16 MiB
    return shown(renderer, "instant_radiosity",
                 {{"vpls", "2048"}, {"map_size", "64"}, {"memory", mebibytes}});
  };
  const Image together = inMemory("512"), apart = inMemory("16");
  ASSERT_GT(mean(apart), 0);
  EXPECT_LT(rmse(together, apart), 1e-4 * mean(apart));
}

}  // namespace
}  // namespace limn
