// What passes say they are for, which the cost of a frame is split by.
#include <gmock/gmock.h>

#include <set>

#include "core/bench/cost_split.h"
#include "core/scene/material_model.h"
#include "glsl/materials/model.glsl"
#include "tests/gpu/bump_floor.h"
#include "tests/support/environment_maps.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

using frame::PassRole;

class PassRoleTest : public BumpFloorTest {
 protected:
  /// Adds a camera that looks at the origin from above the front.
  static scene::Scene seen(scene::Scene scene) {
    const glm::vec3 eye(0, 2, 2);
    scene::Node camera;
    camera.camera = 0;
    camera.transform.translation = eye;
    camera.transform.rotation = glm::quatLookAt(glm::normalize(-eye), glm::vec3(0, 1, 0));
    scene.cameras.emplace_back();
    scene.nodes.push_back(camera);
    return scene;
  }
  /// A ball of a material on a floor of it, under a lamp.
  static scene::Scene ball(const scene::Material& material) {
    scene::Scene scene;
    const int index = test::addMaterial(scene, material);
    test::show(scene, test::spherePrimitive(0.5f, index, 12));
    test::show(scene, test::quad({0, -0.5f, 0}, {4, 0, 0}, {0, 0, -4}, index));
    test::shine(scene, test::lamp(glsl::light_point, 9), {1, 2, 1});
    return seen(std::move(scene));
  }
  static scene::Scene underASky() {
    scene::Scene scene = ball(test::lambertian(0.5f));
    scene.environment =
        test::environmentOf(32, [](const glm::vec3& d) { return glm::vec3(d.y > 0 ? 1.f : 0.1f); });
    return scene;
  }
  static scene::Scene translucentBall() {
    scene::Material matter = test::lambertian(0.8f);
    matter.ior = 1.4f;
    matter.subsurface = scene::Subsurface{.extinction = glm::vec3(20), .absorption = glm::vec3(0.05f)};
    return ball(matter);
  }
  static scene::Scene modelledBall() {
    glsl::MaterialModel model{};
    model.kind = glsl::model_torrance_sparrow;
    model.eta = {0.2f, 0.92f, 1.1f};
    model.k = {3.91f, 2.45f, 2.14f};
    model.ks = glm::vec3(0.5f);
    model.roughness = glm::vec2(0.3f);
    scene::Material material;
    scene::setModel(material, model);
    return ball(material);
  }

  static std::vector<frame::PassReport> passesOf(render::Renderer& renderer, render::Settings settings) {
    picture(renderer, std::move(settings));
    std::vector<frame::PassReport> run;
    for (frame::PassReport& pass : renderer.explain())
      if (pass.state == frame::PassState::run) run.push_back(std::move(pass));
    EXPECT_FALSE(run.empty());
    return run;
  }

  static std::set<PassRole> rolesOf(std::span<const frame::PassReport> passes, std::string_view technique) {
    std::set<PassRole> roles;
    for (const frame::PassReport& pass : passes)
      if (pass.technique == technique) roles.insert(pass.role);
    return roles;
  }
};

/// Beside core's own passes those are maps, and only those, that draw triangles.
TEST_F(PassRoleTest, MapsOfEveryTechniqueAreWhatDrawsTriangles) {
  const auto check = [&](const scene::Scene& scene, Term output, const std::vector<std::string>& names) {
    render::Renderer renderer(device(), scene);
    for (const std::string& name : names) {
      SCOPED_TRACE(name);
      for (const frame::PassReport& pass :
           passesOf(renderer, settings(64, 48, output, {smallest(name, 16)}))) {
        SCOPED_TRACE(pass.name);
        EXPECT_EQ(pass.role == PassRole::core, pass.technique == "core");
        if (pass.role == PassRole::core) continue;
        EXPECT_EQ(pass.role == PassRole::map, pass.triangles > 0);
      }
    }
  };
  const scene::Scene box = asset("cornell_box"), glass = asset("glass_sphere");
  check(box, Term::direct, techniquesAnswering(Term::visibility));
  check(box, Term::indirect, techniquesAnswering(Term::indirect));
  check(glass, Term::caustic, techniquesAnswering(Term::caustic));
  check(glass, Term::specular, techniquesAnswering(Term::specular));
  check(glass, Term::media, techniquesAnswering(Term::media));
  check(underASky(), Term::direct, techniquesAnswering(Term::environment));
  check(translucentBall(), Term::subsurface, techniquesAnswering(Term::subsurface));
  check(modelledBall(), Term::direct, techniquesAnswering(Term::surface));
  const scene::Scene bumps = seen(floorUnder({1, 1, 0.5f}, {groove()}));
  check(bumps, Term::direct, techniquesAnswering(Term::relief));
  std::vector<std::string> betweenBumps = techniquesAnswering(Term::indirect);
  std::erase_if(betweenBumps, [](const std::string& name) { return !lightsBumpsAlone(name); });
  check(bumps, Term::indirect, betweenBumps);
}

TEST_F(PassRoleTest, OfShadowMapsAreMapsAndWhatIsDerivedFromThemFilters) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  for (const std::string name :
       {"hard_shadow_map", "pcf", "savsm", "vssm", "cssm", "moment_soft_shadow_map"}) {
    SCOPED_TRACE(name);
    const auto passes = passesOf(renderer, settings(64, 48, Term::direct, {quick(name)}));
    std::set<PassRole> expected{PassRole::map};
    if (name != "hard_shadow_map") expected.insert(PassRole::filter);
    EXPECT_EQ(rolesOf(passes, "shadow"), expected);
    EXPECT_EQ(rolesOf(passes, name), std::set{PassRole::technique});
    EXPECT_EQ(rolesOf(passes, "core"), std::set{PassRole::core});
  }
}

TEST_F(PassRoleTest, TimesAreSplitByThemIntoAllOfTheFrame) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  renderer.configure(settings(64, 48, Term::direct, {quick("savsm")}));
  renderer.setCamera(renderer.pose().cameras.at(0));
  const render::FrameStats stats = render::measure(renderer, 1, 1);
  const bench::CostSplit split = bench::costSplit(stats);
  for (const double part : {split.maps, split.filters, split.technique, split.rest}) EXPECT_GT(part, 0);
  EXPECT_NEAR(split.maps + split.filters + split.technique + split.rest, stats.passSumMs, 1e-9);
}

}  // namespace
}  // namespace limn
