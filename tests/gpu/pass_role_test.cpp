// What passes say they are for, which the cost of a frame is split by.
#include <gmock/gmock.h>

#include <set>

#include "core/bench/cost_split.h"
#include "tests/gpu/render_test.h"

namespace limn {
namespace {

using frame::PassRole;

class PassRoleTest : public RenderTest {
 protected:
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
  const scene::Scene plain = asset("cornell_box"), glass = asset("glass_sphere");
  render::Renderer plainRenderer(device(), plain), glassRenderer(device(), glass);
  const auto check = [&](render::Renderer& renderer, const std::string& name, Term output) {
    SCOPED_TRACE(name);
    for (const frame::PassReport& pass : passesOf(renderer, settings(48, 32, output, {quick(name, 16)}))) {
      SCOPED_TRACE(pass.name);
      EXPECT_EQ(pass.role == PassRole::core, pass.technique == "core");
      if (pass.role == PassRole::core) continue;
      EXPECT_EQ(pass.role == PassRole::map, pass.triangles > 0);
    }
  };
  for (const std::string& name : techniquesAnswering(Term::visibility))
    check(plainRenderer, name, Term::direct);
  for (const std::string& name : techniquesAnswering(Term::indirect))
    check(plainRenderer, name, Term::indirect);
  for (const std::string& name : techniquesAnswering(Term::caustic))
    check(glassRenderer, name, Term::caustic);
  for (const std::string& name : techniquesAnswering(Term::specular))
    check(glassRenderer, name, Term::specular);
}

TEST_F(PassRoleTest, OfShadowMapsAreMapsAndWhatIsDerivedFromThemFilters) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  for (const std::string name :
       {"hard_shadow_map", "pcf", "savsm", "vssm", "cssm", "moment_soft_shadow_map"}) {
    SCOPED_TRACE(name);
    const auto passes = passesOf(renderer, settings(48, 32, Term::direct, {quick(name)}));
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
  renderer.configure(settings(48, 32, Term::direct, {quick("savsm")}));
  renderer.setCamera(renderer.pose().cameras.at(0));
  const render::FrameStats stats = render::measure(renderer, 1, 1);
  const bench::CostSplit split = bench::costSplit(stats);
  for (const double part : {split.maps, split.filters, split.technique, split.rest}) EXPECT_GT(part, 0);
  EXPECT_NEAR(split.maps + split.filters + split.technique + split.rest, stats.passSumMs, 1e-9);
}

}  // namespace
}  // namespace limn
