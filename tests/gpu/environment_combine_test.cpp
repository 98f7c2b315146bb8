// The environment's own light with the shadows of the lights that stand for it.
#include <algorithm>
#include <string>

#include "glsl/materials/material_model.glsl"
#include "tests/gpu/environment_harness.h"

namespace limn {
namespace {

using glm::vec3;

class EnvironmentCombineTest : public EnvironmentTest {
 protected:
  static scene::Scene byRatio(scene::Scene scene) {
    scene.environment.shadowedByRatio = true;
    return scene;
  }

  static Image direct(render::Renderer& renderer, std::vector<render::TechniqueUse> techniques = {},
                      int light = -1) {
    return picture(renderer, settings(64, 48, Term::direct, std::move(techniques), light));
  }
  static Image direct(const scene::Scene& scene, std::vector<render::TechniqueUse> techniques = {}) {
    render::Renderer renderer(device(), scene);
    return direct(renderer, std::move(techniques));
  }

  static render::TechniqueUse hard() { return technique("hard_shadow_map", {{"shadow_map_size", "512"}}); }
};

/// Of metallic-roughness, of coats, of material models, and of what enters and leaves translucent bodies.
TEST_F(EnvironmentCombineTest, WhereNothingIsHiddenTheLightIsThatOfTheMap) {
  for (const char* name :
       {"balls_sky", "torus_metal", "fresnel_spheres", "measured_spheres", "translucent_spheres"}) {
    const scene::Scene map = lit(coarse(name), sky(), 0);
    scene::Scene parts = byRatio(lit(map, sky(), 0.05));
    render::Renderer unshadowed(device(), map);
    const render::Settings s = settings(64, 48, Term::final);
    const Image expected = picture(unshadowed, s);
    EXPECT_GT(mean(expected), 0) << name;
    for (const bool centres : {false, true}) {
      parts.environment.reflectCentres = centres;
      render::Renderer renderer(device(), parts);
      EXPECT_LT(rmse(picture(renderer, s), expected), 1e-6 * mean(expected)) << name << centres;
    }
  }
}

TEST_F(EnvironmentCombineTest, WhereAllIsHiddenThereIsNoLight) {
  for (const scene::Scene& scene : {floor(), mirror()}) {
    scene::Scene open = byRatio(lit(scene, uniform(2), 0.05));
    // Those along the floor shine below the roof.
    std::erase_if(open.environment.lights,
                  [](const scene::DistantRectangle& light) { return glm::normalize(light.centre).y < 0.5f; });
    const scene::Scene closed = roofed(open);
    const Image lighted = direct(open), dark = direct(closed, {hard()});
    for (const float v : lighted.data()) EXPECT_NEAR(v, 2, 0.02f);
    for (const float v : dark.data()) EXPECT_NEAR(v, 0, 0.02f);
  }
}

/// Of a room whose windows have edges, reflected by smooth metal.
TEST_F(EnvironmentCombineTest, GlossySurfacesShowTheMapInsteadOfItsLights) {
  std::vector<std::string> warnings;
  const scene::Environment studio = scene::loadEnvironment(
      std::filesystem::path(test::kBinaryDir) / "assets" / "environments" / "studio.exr", warnings);
  scene::Scene sum = lit(asset("torus_metal"), studio, 0.05);
  const Image truth = reference(sum, settings(64, 48, Term::direct), 256);
  for (const bool centres : {false, true}) {
    sum.environment.reflectCentres = centres;
    const scene::Scene shares = byRatio(sum);
    render::Renderer adding(device(), sum), sharing(device(), shares);
    for (const char* shadows : {"hard_shadow_map", "pcss"}) {
      const std::vector<render::TechniqueUse> use{technique(shadows, {{"shadow_map_size", "512"}})};
      const double added = rmse(direct(adding, use), truth), ratio = rmse(direct(sharing, use), truth);
      RecordProperty(std::string(shadows) + (centres ? " centre" : " area"),
                     std::to_string(added) + " " + std::to_string(ratio));
      EXPECT_LT(ratio, 0.7 * added) << shadows << centres;
    }
  }
}

/// However the lights fall into batches, with lamps beside them or without.
TEST_F(EnvironmentCombineTest, BatchesDoNotMatter) {
  const scene::Scene lamps = coarse("balls");
  scene::Scene scene = byRatio(lit(lamps, sky(), 0.05));
  ASSERT_GT(scene.environment.lights.size(), 16u);
  const Image forwards = direct(scene, {hard()});
  std::ranges::reverse(scene.environment.lights);
  const Image backwards = direct(scene, {hard()});
  EXPECT_LT(rmse(forwards, backwards), 1e-6 * mean(forwards));

  scene.environment.lights.resize(8);
  const Image once = direct(scene, {hard()});
  scene.environment.lights.push_back(scene.environment.lights.back());
  scene.environment.lights.back().irradiance *= 1e-20f;
  EXPECT_LT(rmse(once, direct(scene, {hard()})), 1e-6 * mean(once)) << "of one batch and of two";

  scene::Scene both = lamps;
  both.environment = scene.environment;
  const Image together = direct(both, {hard()}), apart = direct(lamps, {hard()});
  Image sum = once;
  for (size_t i = 0; i < sum.data().size(); ++i) sum.data()[i] += apart.data()[i];
  EXPECT_LT(rmse(together, sum), 1e-6 * mean(sum));
}

/// The medium takes its part of each light, as a shadow does.
TEST_F(EnvironmentCombineTest, MediaAttenuateWhatArrives) {
  scene::Scene sum = lit(asset("balls"), sky(), 0.05);
  const Image clear = direct(byRatio(sum), {hard()});
  sum.medium.sigmaA = vec3(0.1f, 0.2f, 0.3f);
  const Image truth = reference(sum, settings(64, 48, Term::direct), 256),
              dim = direct(byRatio(sum), {hard()});
  EXPECT_LT(mean(dim), 0.8 * mean(clear));
  EXPECT_NEAR(mean(dim), mean(truth), 0.1 * mean(truth));
  EXPECT_LT(rmse(dim, truth), 1.1 * rmse(direct(sum, {hard()}), truth));
}

TEST_F(EnvironmentCombineTest, NothingElseChanges) {
  const scene::Scene sum = lit(coarse("balls"), sky(), 0.05), ratio = byRatio(sum);
  render::Renderer adding(device(), sum), sharing(device(), ratio);
  EXPECT_EQ(rmse(direct(adding, {hard()}, 3), direct(sharing, {hard()}, 3)), 0) << "a light alone";
  const scene::Scene lamps = coarse("balls"), flagged = byRatio(lamps);
  EXPECT_EQ(rmse(direct(lamps, {hard()}), direct(flagged, {hard()})), 0) << "no light of an environment";
  for (const char* answer : {"sampled_environment_light", "implicit_visibility"})
    EXPECT_EQ(rmse(direct(adding, {quick(answer)}), direct(sharing, {quick(answer)})), 0) << answer;

  direct(adding, {hard()});
  for (const frame::PassReport& pass : adding.explain())
    if (pass.state == frame::PassState::run) {
      EXPECT_EQ(pass.name.find("environment"), std::string::npos) << pass.name;
    }
}

}  // namespace
}  // namespace limn
