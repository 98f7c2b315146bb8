// The passes of media and caustics: which run, which are left out where there is nothing for them, and which
// keep what they have.
#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/gpu/media_harness.h"
#include "tests/support/environment_maps.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

class MediaPassesTest : public MediaHarness {
 protected:
  /// Of what the pass "caustic rays" writes.
  static int64_t bytesOfRays(const render::Renderer& renderer) {
    int64_t bytes = 0;
    for (const auto& pass : renderer.explain())
      for (const auto& access : pass.accesses)
        if (pass.name == "caustic rays" && access.write) bytes += access.bytes;
    return bytes;
  }

  /// The passes of `technique` that write geometric normals of specular objects.
  static std::vector<std::string> passesWithGeometricNormals(const render::Renderer& renderer,
                                                             const std::string& technique) {
    std::vector<std::string> names;
    for (const auto& pass : renderer.explain())
      for (const auto& access : pass.accesses)
        if (pass.technique == technique && access.write &&
            access.resource.starts_with("specular geometric normal"))
          names.push_back(pass.name);
    return names;
  }
};

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
  const Image both = lines("both");
  EXPECT_EQ(stateOf(renderer, "volume_caustics", "refracted rays"), "no specular surface lets light through");
  const int64_t bytes = bytesOfRays(renderer);
  EXPECT_TRUE(sameBits(both, lines("reflection")));
  EXPECT_EQ(stateOf(renderer, "volume_caustics", "refracted rays"), "unknown");
  EXPECT_GT(bytes, 0);
  EXPECT_EQ(bytes, bytesOfRays(renderer));
  expectWithin(lines("refraction"), 0, 0);
  EXPECT_EQ(stateOf(renderer, "volume_caustics", "caustic lines"), "no specular surface lets light through");
}

/// A spot beside the ball sends it nothing while it looks away. As soon as it looks at the ball, the picture
/// is that of a renderer that has never seen it look away, and when it looks away again, what it was before.
TEST_F(MediaPassesTest, LightsThatReachNoSpecularSurfaceHaveNoRays) {
  const scene::Scene one = asset("glass_sphere");
  scene::Scene two = one;
  test::shine(two, test::lamp(glsl::light_spot, 3), {-1.5f, 1.5f, 0}, {-1, 0, 0});
  const auto look = [&](render::Renderer& renderer, float x) {
    two.nodes.back().transform.rotation = glm::quatLookAt(glm::vec3(x, 0, 0), glm::vec3(0, 1, 0));
    renderer.setTime(0);
    renderer.render();
    return renderer.read();
  };
  // With one path a ray's number, which spreads lines over pixels, does not depend on later lights.
  render::Settings asked =
      settings(width, height, Term::media, {technique("volume_caustics", {{"paths", "refraction"}})});
  asked.dynamic = false;
  render::Renderer alone(device(), one), renderer(device(), two);
  const Image first = picture(alone, asked);
  ASSERT_GT(bytesOfRays(alone), 0);
  EXPECT_TRUE(sameBits(picture(renderer, asked), first));
  EXPECT_EQ(bytesOfRays(renderer), bytesOfRays(alone));
  EXPECT_EQ(stateOf(renderer, "caustics", "rays of light " + renderer.pose().lightNames.at(1)),
            "it reaches no specular surface");
  const Image turned = look(renderer, 1);
  EXPECT_EQ(bytesOfRays(renderer), 2 * bytesOfRays(alone));
  EXPECT_GT(mean(turned), mean(first));
  render::Renderer fresh(device(), two);
  EXPECT_TRUE(sameBits(turned, picture(fresh, asked)));
  EXPECT_TRUE(sameBits(look(renderer, -1), first));
}

/// Each fragment would read the corners of its triangle for them.
TEST_F(MediaPassesTest, GeometricNormalsOfSpecularObjectsAreMadeForThoseWhoReadThem) {
  using testing::ElementsAre, testing::IsEmpty;
  for (const auto& [name, refracts] : {std::pair("ring", false), std::pair("glass_sphere", true)}) {
    SCOPED_TRACE(name);
    const scene::Scene scene = asset(name);
    render::Renderer renderer(device(), scene);
    picture(renderer,
            settings(8, 6, Term::final, {quick("surface_caustics"), quick("image_space_refraction")}));
    EXPECT_EQ(stateOf(renderer, "image_space_refraction", "specular front"), "run");
    EXPECT_THAT(passesWithGeometricNormals(renderer, "image_space_refraction"), IsEmpty());
    const std::vector<std::string> ofRays = passesWithGeometricNormals(renderer, "caustics");
    if (refracts)
      EXPECT_THAT(ofRays, ElementsAre("specular front", "specular back"));
    else
      EXPECT_THAT(ofRays, ElementsAre("specular front"));
  }
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
