// Tabulated materials against the exact model, as both are drawn.
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "core/scene/camera.h"
#include "core/scene/material_model.h"
#include "tests/gpu/render_test.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using Values = std::vector<std::pair<std::string, std::string>>;

class FactoredBrdfTest : public RenderTest {
 protected:
  /// A ball under a light from the side and one from behind the camera.
  static scene::Scene ball(float roughness, uint32_t kind = glsl::model_torrance_sparrow) {
    glsl::MaterialModel model{};
    model.kind = kind;
    model.eta = {0.2f, 0.92f, 1.1f};
    model.k = {3.91f, 2.45f, 2.14f};
    model.ks = glm::vec3(0.5f);
    model.kd = glm::vec3(0.1f);
    model.exponent = 20;
    model.roughness = glm::vec2(roughness);
    scene::Scene scene;
    scene::Material material;
    scene::setModel(material, model);
    scene::Node node;
    node.mesh = test::addMesh(scene, test::spherePrimitive(1, test::addMaterial(scene, material)));
    scene.nodes.push_back(node);
    for (const glm::vec3& direction : {glm::vec3(-1, -1, -0.4f), glm::vec3(0.5f, -0.3f, -1)}) {
      scene::LightSource light;
      light.type = glsl::light_directional;
      light.intensity = 2;
      scene::Node lamp;
      lamp.transform.rotation = glm::quatLookAt(glm::normalize(direction), glm::vec3(0, 1, 0));
      lamp.light = static_cast<int>(scene.lights.size());
      scene.lights.push_back(light);
      scene.nodes.push_back(lamp);
    }
    return scene;
  }

  Image drawn(const scene::Scene& scene, const std::vector<render::TechniqueUse>& techniques) {
    render::Renderer renderer(device(), scene);
    renderer.configure(settings(96, 96, Term::direct, techniques));
    renderer.setCamera(scene::lookAt({0.3f, 0.8f, 3}, {0, 0, 0}, 0.8f));
    renderer.render();
    return renderer.read();
  }

  /// RMS of the difference over RMS of the exact picture.
  double error(const scene::Scene& scene, const Values& values) {
    const Image exact = drawn(scene, {}), tables = drawn(scene, {technique("factored_brdf", values)});
    double difference = 0, sum = 0;
    for (size_t i = 0; i < exact.data().size(); ++i) {
      const double d = static_cast<double>(tables.data()[i]) - static_cast<double>(exact.data()[i]);
      EXPECT_TRUE(std::isfinite(tables.data()[i]));
      difference += d * d;
      sum += static_cast<double>(exact.data()[i]) * static_cast<double>(exact.data()[i]);
    }
    EXPECT_GT(sum, 0);
    return std::sqrt(difference / sum);
  }
};

TEST_F(FactoredBrdfTest, WarpedTablesAreThePublishedOnesAFiftiethWrong) {
  const scene::Scene scene = ball(0.1f);
  const double warped = error(scene, {{"texels", "128"}, {"format", "float32"}});
  const double published =
      error(scene, {{"texels", "128"}, {"format", "float32"}, {"coordinates", "published"}});
  EXPECT_LT(warped, 3e-3);
  EXPECT_GT(published, 50 * warped);
  EXPECT_LT(error(scene, {{"texels", "128"}, {"format", "half"}}), 3e-3);
}

TEST_F(FactoredBrdfTest, OtherModelsAreExact) {
  const scene::Scene scene = ball(0.3f, glsl::model_phong);
  EXPECT_EQ(error(scene, {{"texels", "2"}}), 0);
}

TEST_F(FactoredBrdfTest, ExtremesAreFinite) {
  for (const float roughness : {0.f, 1e-3f, 1.f})
    for (const char* format : {"float32", "half", "byte"})
      error(ball(roughness), {{"texels", "2"}, {"format", format}});
}

/// A scene without models keeps its picture and its programs.
TEST_F(FactoredBrdfTest, IsLeftOutWhereNoMaterialHasAModel) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  renderer.configure(settings(48, 36, Term::final, {technique("factored_brdf")}));
  renderer.setCamera(renderer.pose().cameras.at(0));
  renderer.render();
  bool left = false;
  for (const frame::PassReport& pass : renderer.explain())
    left = left || (pass.technique == "factored_brdf" && pass.reason == "no material has a model");
  EXPECT_TRUE(left);
}

}  // namespace
}  // namespace limn
