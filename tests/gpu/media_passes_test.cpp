// The passes of media and caustics: which run, which are left out where there is nothing for them, and which
// keep what they have.
#include "tests/gpu/media_harness.h"
#include "tests/support/environment_maps.h"

namespace limn {
namespace {

using MediaPassesTest = MediaHarness;

TEST_F(MediaPassesTest, AMediumThatScattersNothingCostsNothing) {
  scene::Scene scene = asset("glass_sphere");
  scene.medium.sigmaS = glm::vec3(0);
  render::Renderer renderer(device(), scene);
  const Image with =
      picture(renderer,
              settings(width, height, Term::final,
                       {technique("hard_shadow_map"), technique("volume_caustics"), technique("airlight")}));
  EXPECT_EQ(stateOf(renderer, "volume_caustics", "caustic lines"), "no medium scatters light");
  EXPECT_EQ(stateOf(renderer, "airlight", "airlight"), "no medium scatters light");
  EXPECT_EQ(stateOf(renderer, "core", "transmittance"), "run") << "it absorbs";
  const Image without =
      picture(renderer, settings(width, height, Term::final, {technique("hard_shadow_map")}));
  EXPECT_TRUE(sameBits(with, without));
}

TEST_F(MediaPassesTest, AirlightSaysWhyItLacksTheEnvironment) {
  scene::Scene scene = asset("glass_sphere");
  scene.environment = test::environmentOf(16, [](const glm::vec3&) { return glm::vec3(1); });
  render::Renderer renderer(device(), scene);
  const auto reason = [&](int light) {
    picture(renderer, settings(8, 6, Term::media, {quick("airlight")}, light));
    return stateOf(renderer, "airlight", "airlight of the environment");
  };
  EXPECT_EQ(reason(-1), "no lights stand for it (--environment-lights)");
  EXPECT_EQ(reason(0), "another light was chosen");
}

TEST_F(MediaPassesTest, NoMediumIsTheSamePictureBitForBit) {
  scene::Scene scene = asset("glass_sphere");
  scene.medium = {};
  render::Renderer renderer(device(), scene);
  const Image with = picture(
      renderer, settings(width, height, Term::final, {technique("volume_caustics"), technique("airlight")}));
  EXPECT_EQ(stateOf(renderer, "core", "transmittance"), "the scene has no medium");
  EXPECT_TRUE(sameBits(with, picture(renderer, settings(width, height, Term::final))));
}

TEST_F(MediaPassesTest, WithoutSpecularSurfacesThereAreNoLines) {
  scene::Scene scene = asset("balls");
  scene.medium.sigmaS = glm::vec3(0.1f);
  render::Renderer renderer(device(), scene);
  expectWithin(picture(renderer, settings(width, height, Term::media, {technique("volume_caustics")})), 0, 0);
  EXPECT_EQ(stateOf(renderer, "volume_caustics", "caustic lines"), "the scene has no specular surface");
  EXPECT_EQ(stateOf(renderer, "caustics", "specular front"), "unknown");
  for (const char* splat : {"screen", "light"})
    expectWithin(picture(renderer, settings(width, height, Term::caustic,
                                            {technique("surface_caustics", {{"splat", splat}})})),
                 0, 0);
  EXPECT_EQ(stateOf(renderer, "surface_caustics", "caustic map"), "the scene has no specular surface");
}

TEST_F(MediaPassesTest, WhereNothingIsTransparentNoRefractionIsTraced) {
  const scene::Scene scene = asset("ring");
  render::Renderer renderer(device(), scene);
  const auto lines = [&](const char* paths) {
    return picture(renderer,
                   settings(width, height, Term::media, {technique("volume_caustics", {{"paths", paths}})}));
  };
  const auto bytesOfRays = [&] {
    int64_t bytes = 0;
    for (const auto& pass : renderer.explain())
      for (const auto& access : pass.accesses)
        if (pass.name == "caustic rays" && access.write) bytes += access.bytes;
    return bytes;
  };
  const Image both = lines("both");
  EXPECT_EQ(stateOf(renderer, "volume_caustics", "refracted rays"), "no specular surface lets light through");
  const int64_t bytes = bytesOfRays();
  EXPECT_TRUE(sameBits(both, lines("reflection")));
  EXPECT_EQ(stateOf(renderer, "volume_caustics", "refracted rays"), "unknown");
  EXPECT_GT(bytes, 0);
  EXPECT_EQ(bytes, bytesOfRays());
  expectWithin(lines("refraction"), 0, 0);
  EXPECT_EQ(stateOf(renderer, "volume_caustics", "caustic lines"), "no specular surface lets light through");
}

/// A software renderer needs no barriers: the list itself is what is checked.
TEST_F(MediaPassesTest, TheLineRuleIsClearedBehindABarrierForClears) {
  const scene::Scene scene = asset("glass_sphere");
  render::Renderer renderer(device(), scene);
  picture(renderer, settings(8, 6, Term::media, {quick("volume_caustics")}));
  GLbitfield before = 0;
  for (const auto& pass : renderer.explain())
    if (pass.name == "clear line rule") before = pass.barriers;
  EXPECT_NE(before & GL_BUFFER_UPDATE_BARRIER_BIT, 0u);
}

TEST_F(MediaPassesTest, RaysAreTracedAgainOnlyWhereSomethingChanged) {
  const scene::Scene scene = asset("gem");
  render::Renderer renderer(device(), scene);
  render::Settings s = settings(width, height, Term::media, {technique("volume_caustics")});
  s.dynamic = false;
  const Image first = picture(renderer, s);
  EXPECT_GT(mean(first), 0);
  renderer.render();
  for (const auto& pass : renderer.explain())
    if (pass.technique == "caustics") {
      EXPECT_EQ(pass.state, frame::PassState::cached) << pass.name;
    }
  EXPECT_LT(rmse(renderer.read(), first), 1e-5 * mean(first));
  renderer.setTime(0.5, 0);
  renderer.render();
  const Image turned = renderer.read();
  EXPECT_GT(rmse(turned, first), 0.01 * mean(first)) << "it turns";
  s.dynamic = true;
  EXPECT_LT(rmse(picture(renderer, s), turned), 1e-5 * mean(turned));
}

TEST_F(MediaPassesTest, TechniquesThatShareRaysTraceThemOnce) {
  const scene::Scene scene = asset("glass_sphere");
  render::Renderer renderer(device(), scene);
  picture(renderer, settings(width, height, Term::final,
                             {technique("volume_caustics"), technique("surface_caustics")}));
  int traced = 0;
  for (const auto& pass : renderer.explain()) traced += pass.name == "caustic rays";
  EXPECT_EQ(traced, 1);
}

TEST_F(MediaPassesTest, ATurningStoneKeepsItsGraph) {
  const scene::Scene scene = asset("gem");
  render::Renderer renderer(device(), scene);
  picture(renderer, settings(width, height, Term::media, {technique("volume_caustics")}));
  const int64_t compiled = device().counters().programsCompiled;
  std::vector<double> means;
  for (int frame = 0; frame < 8; ++frame) {
    renderer.setTime(frame / 30.0);
    renderer.render();
    means.push_back(mean(renderer.read()));
    EXPECT_GT(means.back(), 0);
  }
  EXPECT_EQ(device().counters().programsCompiled, compiled);
  EXPECT_NE(means.front(), means.back()) << "it turns";
}

}  // namespace
}  // namespace limn
