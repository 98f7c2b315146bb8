// The environment with shadows: area lights that stand for it, and techniques that answer it as a whole.
#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/scene/density_grid.h"
#include "core/scene/environment_light.h"
#include "core/shading_maps/shading_maps.h"
#include "tests/gpu/environment_harness.h"
#include "tests/support/density_grids.h"

namespace limn {
namespace {

using glm::vec3;

using EnvironmentShadowTest = EnvironmentTest;

TEST_F(EnvironmentShadowTest, PosesHoldTheLightsOfTheEnvironmentBehindTheirOwn) {
  scene::Scene scene = coarse("balls");
  const size_t own = scene::evaluate(scene, 0).lights.size();
  scene.environment = sky();
  scene.environment.rotation = 0.5f;
  scene.environment.scale = 2;
  scene.environment.lights = shading::decomposeEnvironment(scene.environment, {}).lights;
  const scene::Pose pose = scene::evaluate(scene, 0);
  ASSERT_EQ(pose.lights.size(), own + scene.environment.lights.size());
  EXPECT_EQ(reference::ownLights(pose), static_cast<int>(own));
  EXPECT_EQ(pose.lightNames[own + 1], "env#1");
  const glsl::Light& sun = pose.lights[own];
  const vec3 expected = glsl::environment_world_direction(glm::normalize(vec3(0.5f, 0.8f, 0.4f)), 0.5f);
  EXPECT_GT(glm::dot(-sun.direction, expected), 0.97f);
  EXPECT_FLOAT_EQ(sun.emission.y, 2 * scene.environment.lights[0].irradiance.y);
  double solidAngle = 0;
  for (size_t i = own; i < pose.lights.size(); ++i) solidAngle += double(pose.lights[i].solid_angle);
  EXPECT_GT(solidAngle, 4 * 3.14159) << "they cover the sphere, overlapping";
}

TEST_F(EnvironmentShadowTest, VisibilityOfEachLightConvergesToTheReference) {
  const scene::Scene scene = lit(asset("balls"), sky(), 0.05);
  render::Renderer renderer(device(), scene);
  const int lights = static_cast<int>(renderer.pose().lights.size());
  ASSERT_GT(lights, 5);
  int tested = 0;
  for (int light = 0; light < lights && tested < 3; ++light) {
    // What shines along a floor is shadowed by parts of it that rise less than a texel above the tangent
    // plane.
    const vec3 from = -renderer.pose().lights[static_cast<size_t>(light)].direction;
    if (from.y < 0.6f) continue;
    ++tested;
    SCOPED_TRACE(renderer.pose().lightNames[static_cast<size_t>(light)]);
    render::Settings s = settings(96, 72, Term::visibility, {}, light);
    const Image truth = reference(scene, s, 256);
    s.techniques = {technique("sampled_area_light", {{"samples", "256"}, {"shadow_map_size", "512"}})};
    const double sampled = rmse(picture(renderer, s), truth);
    s.techniques = {technique("pcss", {{"shadow_map_size", "512"}})};
    const double soft = rmse(picture(renderer, s), truth);
    s.techniques = {technique("hard_shadow_map", {{"shadow_map_size", "512"}})};
    const double hard = rmse(picture(renderer, s), truth);
    RecordProperty("light " + std::to_string(light),
                   std::to_string(sampled) + " " + std::to_string(soft) + " " + std::to_string(hard));
    EXPECT_LT(sampled, 0.04);
    EXPECT_LT(soft, 0.2);
    EXPECT_LT(soft, hard);
  }
}

TEST_F(EnvironmentShadowTest, AUniformSkyOverAPlaneGivesPiTimesItsRadiance) {
  // Overlapping lights share the sky unevenly; six whole faces do not.
  for (const auto& [threshold, error] : {std::pair(0.02, 2e-3f), std::pair(0.1, 0.02f)}) {
    const scene::Scene scene = lit(floor(), uniform(0.7f), threshold);
    render::Renderer renderer(device(), scene);
    const Image picture = this->picture(renderer, settings(16, 12, Term::direct));
    for (const float v : picture.data()) EXPECT_NEAR(v, 0.7f, 0.7f * error);
  }
}

/// A floor that is a perfect mirror shows the sky, and nothing under a roof that hides all of it.
TEST_F(EnvironmentShadowTest, CoatsMirrorWhatIsNotHidden) {
  for (const bool hidden : {false, true}) {
    const scene::Scene scene = lit(hidden ? roofed(mirror()) : mirror(), uniform(2), 0);
    render::Renderer renderer(device(), scene);
    for (const std::string& name : shadowingTechniques()) {
      const Image picture = this->picture(renderer, settings(16, 12, Term::direct, {sampled(name, 64)}));
      for (const float v : picture.data()) EXPECT_NEAR(v, hidden ? 0 : 2, 0.02f) << name << hidden;
    }
  }
}

/// As in references, nothing is mirrored where the shading normal is turned away from the viewer.
TEST_F(EnvironmentShadowTest, CoatsTurnedAwayMirrorNothing) {
  scene::Scene turned = mirror();
  turned.meshes[0].primitives[0].normals.assign(4, {0, -1, 0});
  const scene::Scene scene = lit(std::move(turned), uniform(2), 0);
  render::Renderer renderer(device(), scene);
  const render::Settings bare = settings(16, 12, Term::direct);
  expectWithin(reference(scene, bare, 1), 0, 0);
  expectWithin(picture(renderer, bare), 0, 0);
  for (const std::string& name : shadowingTechniques()) {
    SCOPED_TRACE(name);
    render::Settings s = bare;
    s.techniques = {sampled(name, 64)};
    expectWithin(picture(renderer, s), 0, 0);
  }
}

/// A medium takes from what coats mirror what it takes along the mirror direction, whoever lights them: near
/// the edge of the floor the way out of the medium is another one than along the normal.
TEST_F(EnvironmentShadowTest, CoatsMirrorThroughTheMedium) {
  scene::Scene scene = lit(mirror(), uniform(2), 0);
  scene.nodes.back().transform.translation.x = 40;  // the camera
  scene.medium.sigmaA = vec3(0.005f, 0.01f, 0.02f);
  render::Renderer renderer(device(), scene);
  const render::Settings bare = settings(16, 12, Term::direct);
  const Image truth = reference(scene, bare, 1);
  EXPECT_LT(mean(truth), 1.9);
  std::vector<std::vector<render::TechniqueUse>> answers(1);  // core's own
  for (const std::string& name : environmentTechniques()) answers.push_back({technique(name)});
  for (const std::string& name : shadowingTechniques()) answers.push_back({sampled(name, 64)});
  for (size_t i = 0; i < answers.size(); ++i) {
    render::Settings s = bare;
    s.techniques = answers[i];
    EXPECT_LT(rmse(picture(renderer, s), truth), 0.01 * mean(truth)) << i;
  }
}

TEST_F(EnvironmentShadowTest, LightsReflectedFromTheirCentresAreThePublishedApproximation) {
  scene::Scene scene = lit(floor(), uniform(1), 0.02);
  scene.environment.reflectCentres = true;
  double expected = 0;
  for (const scene::DistantRectangle& light : scene.environment.lights)
    expected +=
        std::max(0.0, double(light.irradiance.x) * double(glm::normalize(light.centre).y)) / 3.14159265;
  render::Renderer renderer(device(), scene);
  const Image picture = this->picture(renderer, settings(16, 12, Term::direct));
  EXPECT_NEAR(picture.at(8, 6, 0), expected, 1e-3);
}

TEST_F(EnvironmentShadowTest, ALightAloneIsWhatTheReferenceSays) {
  const scene::Scene scene = lit(asset("balls"), sky(), 0.05);
  render::Renderer renderer(device(), scene);
  render::Settings s =
      settings(96, 72, Term::direct, {technique("sampled_area_light", {{"samples", "256"}})}, 0);
  const Image truth = reference(scene, s, 256);
  EXPECT_LT(rmse(picture(renderer, s), truth), 0.05 * mean(truth));
}

TEST_F(EnvironmentShadowTest, ManyLightsAreMoreExactThanNoShadows) {
  const scene::Scene scene = lit(asset("balls"), sky(), 0.05), unshadowed = lit(asset("balls"), sky(), 0);
  render::Renderer renderer(device(), scene), plain(device(), unshadowed);
  const render::Settings bare = settings(96, 72, Term::direct);
  const Image truth = reference(scene, bare, 256);
  EXPECT_LT(rmse(reference(scene, bare, 16), reference(unshadowed, bare, 16)), 1e-6)
      << "the reference integrates the map itself, of the same samples";
  render::Settings s = settings(96, 72, Term::direct, {technique("pcss", {{"shadow_map_size", "512"}})});
  const double shadowed = rmse(picture(renderer, s), truth), without = rmse(picture(plain, bare), truth);
  EXPECT_LT(shadowed, 0.5 * without);
  EXPECT_LT(shadowed, 0.15 * mean(truth));
}

TEST_F(EnvironmentShadowTest, MemoryIsBoundedByBatches) {
  const auto bytes = [&](size_t lights, bool dynamic) {
    scene::Scene scene = lit(coarse("balls"), sky(), 0.2);
    EXPECT_GE(scene.environment.lights.size(), lights);
    scene.environment.lights.resize(lights);
    render::Renderer renderer(device(), scene);
    render::Settings s = settings(64, 48, Term::direct, {technique("pcss", {{"shadow_map_size", "2048"}})});
    s.dynamic = dynamic;
    picture(renderer, s);
    return static_cast<double>(renderer.memoryBytes());
  };
  const double eight = bytes(8, true);
  EXPECT_LT(bytes(64, true) - eight, 300 << 20) << "maps of the other lights alone are 900 MiB";
  EXPECT_LT(bytes(64, false) - eight, 300 << 20);
}

TEST_F(EnvironmentShadowTest, ATechniqueTakesThePlaceOfTheLights) {
  const scene::Scene whole = lit(coarse("balls"), sky(), 0), parts = lit(whole, sky(), 0.05);
  render::Renderer a(device(), whole), b(device(), parts);
  for (const std::string& name : environmentTechniques()) {
    SCOPED_TRACE(name);
    const render::Settings s = settings(64, 48, Term::direct, {quick(name), technique("hard_shadow_map")});
    const Image first = picture(a, s), second = picture(b, s);
    EXPECT_EQ(rmse(first, second), 0);
    EXPECT_GT(mean(first), 0);
    EXPECT_THROW(a.configure(settings(8, 8, Term::direct, {quick(name), quick(name)})), UsageError);
    EXPECT_THROW(a.configure(settings(8, 8, Term::visibility, {quick(name)})), UsageError);
  }
}

TEST_F(EnvironmentShadowTest, EveryTechniqueWithShadowsConvergesToTheReference) {
  const scene::Scene scene = lit(asset("balls"), sky(), 0);
  render::Renderer renderer(device(), scene);
  const Image truth = reference(scene, settings(96, 72, Term::direct), 1024);
  for (const std::string& name : shadowingTechniques()) {
    SCOPED_TRACE(name);
    std::vector<double> errors;
    for (const int samples : {16, 64, 256})
      errors.push_back(
          rmse(picture(renderer, settings(96, 72, Term::direct, {sampled(name, samples)})), truth));
    RecordProperty(
        name, std::to_string(errors[0]) + " " + std::to_string(errors[1]) + " " + std::to_string(errors[2]));
    // At least the slope of independent samples.
    EXPECT_LT(errors[1], 0.6 * errors[0]);
    EXPECT_LT(errors[2], 0.6 * errors[1]);
    EXPECT_LT(errors[2], 0.06 * mean(truth));
  }
}

TEST_F(EnvironmentShadowTest, EveryTechniqueGivesTheClosedFormOverAPlane) {
  const scene::Scene scene = lit(floor(), uniform(0.7f), 0);
  render::Renderer renderer(device(), scene);
  for (const std::string& name : environmentTechniques()) {
    SCOPED_TRACE(name);
    const Image picture = this->picture(renderer, settings(16, 12, Term::direct, {sampled(name, 500)}));
    for (const float v : picture.data()) EXPECT_NEAR(v, 0.7f, 0.7f * 0.01f);
  }
}

TEST_F(EnvironmentShadowTest, TechniquesLeaveScenesWithoutEnvironmentAlone) {
  const scene::Scene scene = coarse("balls"), black = lit(scene, uniform(0), 0);
  render::Renderer renderer(device(), scene), dark(device(), black);
  const Image bare = picture(renderer, settings(64, 48, Term::direct));
  for (const std::string& name : environmentTechniques()) {
    SCOPED_TRACE(name);
    EXPECT_EQ(rmse(picture(renderer, settings(64, 48, Term::direct, {quick(name)})), bare), 0);
    expectWithin(picture(dark, settings(64, 48, Term::direct, {quick(name)})), 0, 0);
  }
}

/// Whether its map is black or its scale 0.
TEST_F(EnvironmentShadowTest, ABlackEnvironmentHasNoPass) {
  const auto state = [&](const scene::Environment& environment) {
    const scene::Scene scene = lit(floor(), environment, 0);
    render::Renderer renderer(device(), scene);
    expectWithin(picture(renderer, settings(16, 12, Term::direct)), 0,
                 1.01f * environment.scale * environment.texels.front().x);
    for (const frame::PassReport& row : renderer.explain())
      if (row.name == "environment light") return row.state;
    return frame::PassState::cached;
  };
  scene::Environment unscaled = uniform(0.7f);
  EXPECT_EQ(state(unscaled), frame::PassState::run);
  unscaled.scale = 0;
  EXPECT_EQ(state(unscaled), frame::PassState::leftOut);
  EXPECT_EQ(state(uniform(0)), frame::PassState::leftOut);
}

/// The tables that samples are drawn by are made once, whatever scale and rotation are then.
TEST_F(EnvironmentShadowTest, SamplesFollowRotationAndScale) {
  scene::Scene scene = lit(coarse("balls"), sky(), 0);
  scene.environment.scale = 0;
  shading_maps::ShadingMapService maps(device(), scene);
  const scene::EnvironmentLight& light = maps.environmentLight();
  EXPECT_FALSE(light.present());
  scene.environment.scale = 2;
  EXPECT_TRUE(light.present());
  EXPECT_EQ(&maps.environmentLight(), &light);

  render::Renderer renderer(device(), scene);
  for (const std::string& name : shadowingTechniques()) {
    const render::Settings s = settings(32, 24, Term::direct, {smallest(name)});
    scene.environment.rotation = 0;
    const Image before = picture(renderer, s);
    scene.environment.rotation = 1;
    const Image turned = picture(renderer, s);
    EXPECT_GT(rmse(turned, before), 0) << name;
    render::Renderer fresh(device(), scene);
    EXPECT_EQ(rmse(turned, picture(fresh, s)), 0) << name;
  }
}

/// What a body's boundary reflects and what enters it are asked for apart, of the same samples: 500 are
/// within 1.2 % of what a uniform sky brings.
TEST_F(EnvironmentShadowTest, TranslucentSurfacesHaveTheLightOfBothRequests) {
  const scene::Scene scene = lit(translucentFloor(), uniform(0.7f), 0);
  render::Renderer renderer(device(), scene);
  const Image expected = picture(renderer, settings(16, 12, Term::final));
  for (const std::string& name : shadowingTechniques()) {
    render::TechniqueUse use = sampled(name, 500);
    use.parameters.set("shadow_map_size", "64");
    const Image image = picture(renderer, settings(16, 12, Term::final, {use}));
    EXPECT_LT(rmse(image, expected), 0.02 * mean(expected)) << name;
  }
}

/// Sixteen maps are 32 MiB, also where two requests want each of them.
TEST_F(EnvironmentShadowTest, BatchesOfSamplesShareMemory) {
  const scene::Scene scene = lit(translucentFloor(), uniform(0.7f), 0);
  for (const std::string& name : shadowingTechniques()) {
    const auto bytes = [&](const char* memory) {
      render::TechniqueUse use = sampled(name, 16);
      use.parameters.set("shadow_map_size", "512");
      use.parameters.set("memory", memory);
      render::Renderer renderer(device(), scene);
      picture(renderer, settings(16, 12, Term::final, {use}));
      return renderer.memoryBytes();
    };
    EXPECT_LT(bytes("2"), bytes("32") - (24 << 20)) << name;
  }
}

/// The same of maps of lights, of which six stand for the sky. All of a sample's are 3 MiB.
TEST_F(EnvironmentShadowTest, BatchesOfLightsSamplesShareMemory) {
  const scene::Scene scene = lit(translucentFloor(), uniform(0.7f), 0.02);
  ASSERT_EQ(scene.environment.lights.size(), 6u);
  const auto bytes = [&](const char* memory) {
    render::Renderer renderer(device(), scene);
    picture(renderer,
            settings(16, 12, Term::final,
                     {technique("sampled_area_light",
                                {{"samples", "16"}, {"shadow_map_size", "256"}, {"memory", memory}})}));
    return renderer.memoryBytes();
  };
  EXPECT_LT(bytes("3"), bytes("48") - (36 << 20));
}

/// The way of each sample's light through a grid takes up to 65 steps of the loops of which llvmpipe leaves
/// all after 65,535. Ways from the middle of the floor to an upper corner of this one take 40.
TEST_F(EnvironmentShadowTest, ManySamplesShineThroughTheGridOfAMedium) {
  const vec3 sun = glm::normalize(vec3(1));
  scene::Scene scene =
      lit(floor(),
          test::environmentOf(64, [&](vec3 d) { return vec3(glm::dot(d, sun) > 0.95f ? 10.f : 0.f); }), 0);
  scene.medium.sigmaA = vec3(0.01f);
  scene::setGrid(scene.medium,
                 test::gridOf({2, 2, 2}, {-20, 0, -20}, {20, 20, 20}, [](vec3) { return 1.f; }));
  render::Renderer renderer(device(), scene);
  const auto with = [&](const char* memory) {
    return picture(
        renderer,
        settings(8, 6, Term::direct,
                 {technique("sampled_environment_light",
                            {{"samples", "2048"}, {"shadow_map_size", "16"}, {"memory", memory}})}));
  };
  const Image apart = with("1"), together = with("4096");
  EXPECT_GT(mean(apart), 0);
  EXPECT_LT(rmse(together, apart), 1e-4 * mean(apart));
}

/// Also of coats, whose mirrors are seen as far as the samples of all batches are.
TEST_F(EnvironmentShadowTest, BatchesOfAnySizeGiveTheSamePicture) {
  for (const char* name : {"balls", "fresnel_spheres"}) {
    const scene::Scene scene = lit(coarse(name), sky(), 0);
    render::Renderer renderer(device(), scene);
    const auto with = [&](const char* memory) {
      return picture(
          renderer,
          settings(64, 48, Term::direct,
                   {technique("sampled_environment_light",
                              {{"samples", "40"}, {"shadow_map_size", "256"}, {"memory", memory}})}));
    };
    EXPECT_LT(rmse(with("1"), with("256")), 1e-6) << name;
  }
}

}  // namespace
}  // namespace limn
