// Techniques that are asked for some of their terms, beside others for the rest.
#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/shading/environment_decomposition.h"
#include "tests/gpu/render_test.h"

namespace limn {
namespace {

class RestrictedTermsTest : public RenderTest {
 protected:
  static render::TechniqueUse bounces(TermSet terms = termSet(Term::indirect)) {
    render::TechniqueUse use = technique("implicit_visibility", {{"bins", "8"}, {"longest_edge", "0.2"}});
    use.terms = terms;
    return use;
  }
  static render::TechniqueUse shadows() { return technique("vssm", {{"shadow_map_size", "256"}}); }
  static Image shown(render::Renderer& renderer, Term term, std::vector<render::TechniqueUse> techniques,
                     int light = -1) {
    return picture(renderer, settings(48, 36, term, std::move(techniques), light));
  }
  static scene::Scene underTwoLightsOfTheSky() {
    scene::Scene scene = coarse("balls_sky");
    scene.environment.lights =
        shading::decomposeEnvironment(scene.environment, {.threshold = 0.1, .resolution = 24}).lights;
    scene.environment.lights.resize(2);
    return scene;
  }
  static bool alike(const Image& a, const Image& b) { return std::ranges::equal(a.data(), b.data()); }
  /// Of the last frame.
  static std::set<std::string> passesOf(const render::Renderer& renderer, const char* technique) {
    std::set<std::string> names;
    for (const frame::PassReport& pass : renderer.explain())
      if (pass.technique == technique) names.insert(pass.name);
    return names;
  }
};

TEST_F(RestrictedTermsTest, EachTermIsThatOfTheTechniqueAskedForIt) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const std::vector<render::TechniqueUse> both{shadows(), bounces()};
  EXPECT_TRUE(
      alike(shown(renderer, Term::visibility, both, 0), shown(renderer, Term::visibility, {shadows()}, 0)));
  EXPECT_TRUE(alike(shown(renderer, Term::direct, both), shown(renderer, Term::direct, {shadows()})));
  const Image indirect = shown(renderer, Term::indirect, {bounces(kAnswerableTerms)});
  EXPECT_TRUE(alike(shown(renderer, Term::indirect, both), indirect));
  const Image lit = shown(renderer, Term::final, {shadows()}), final = shown(renderer, Term::final, both);
  for (size_t i = 0; i < final.data().size(); ++i)
    ASSERT_FLOAT_EQ(final.data()[i], lit.data()[i] + indirect.data()[i]) << i;
  EXPECT_GT(mean(indirect), 0);
}

TEST_F(RestrictedTermsTest, NothingIsDoneForOtherTerms) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  shown(renderer, Term::indirect, {bounces(kAnswerableTerms)});
  const auto ofIndirect = passesOf(renderer, "implicit_visibility");
  shown(renderer, Term::final, {bounces(kAnswerableTerms)});
  const auto ofAll = passesOf(renderer, "implicit_visibility");
  EXPECT_TRUE(ofAll.contains("visibility"));
  shown(renderer, Term::final, {shadows(), bounces()});
  EXPECT_EQ(passesOf(renderer, "implicit_visibility"), ofIndirect);
  EXPECT_FALSE(ofIndirect.contains("visibility"));
  shown(renderer, Term::direct, {shadows(), bounces()});
  EXPECT_TRUE(passesOf(renderer, "implicit_visibility").empty());
}

TEST_F(RestrictedTermsTest, StatsNameTheTerms) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  shown(renderer, Term::final, {shadows(), bounces()});
  EXPECT_EQ(renderer.describe().technique, "vssm,implicit_visibility:indirect");
}

TEST_F(RestrictedTermsTest, OtherTermsOfATechniqueHaveNoPicture) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  EXPECT_THROW(renderer.configure(settings(48, 36, Term::visibility, {bounces()}, 0)), UsageError);
  EXPECT_THROW(renderer.configure(settings(48, 36, Term::final, {shadows(), bounces(kAnswerableTerms)})),
               UsageError);
}

/// Bounces of lights that stand for the environment do not hold its map as well.
TEST_F(RestrictedTermsTest, TheEnvironmentIsNotReflectedBesideItsLights) {
  const scene::Scene scene = underTwoLightsOfTheSky();
  scene::Scene black = scene;
  std::ranges::fill(black.environment.texels, glm::vec3(0));
  render::Renderer own(device(), scene), without(device(), black);
  for (const int light : {-1, 0}) {
    const Image reflected = shown(own, Term::indirect, {shadows(), bounces()}, light);
    EXPECT_TRUE(alike(reflected, shown(without, Term::indirect, {shadows(), bounces()}, light))) << light;
    EXPECT_GT(mean(reflected), 0) << light;
  }
}

/// A technique that answers the environment takes the place of the lights that stand for it in direct light
/// alone: over surfaces and in the medium their light comes as without it, and once.
TEST_F(RestrictedTermsTest, LightsOfTheEnvironmentAreReplacedInDirectLightAlone) {
  scene::Scene scene = underTwoLightsOfTheSky();
  scene.medium.sigmaS = glm::vec3(0.05f);
  scene::Scene bare = scene;
  bare.environment.lights.clear();
  render::Renderer renderer(device(), scene), withoutLights(device(), bare);
  const render::TechniqueUse sky =
      technique("sampled_environment_light", {{"samples", "4"}, {"shadow_map_size", "128"}});
  const std::vector<std::pair<Term, render::TechniqueUse>> others{
      {Term::indirect, technique("reflective_shadow_map", {{"vpls", "64"}, {"rsm_size", "64"}})},
      {Term::media, technique("airlight", {{"shadow_map_size", "128"}})}};
  for (const auto& [term, other] : others) {
    const Image alone = shown(renderer, term, {other});
    EXPECT_GT(mean(alone), mean(shown(withoutLights, term, {other}))) << name(term);
    EXPECT_TRUE(alike(shown(renderer, term, {sky, other}), alone)) << name(term);
  }
  EXPECT_TRUE(alike(shown(renderer, Term::direct, {sky}), shown(withoutLights, Term::direct, {sky})));
  EXPECT_TRUE(alike(shown(renderer, Term::indirect, {bounces(kAnswerableTerms)}),
                    shown(renderer, Term::indirect, {bounces()})))
      << "whether or not it answers the environment, too";
}

}  // namespace
}  // namespace limn
