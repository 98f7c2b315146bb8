// Laws that every technique obeys, whichever are installed: adding a folder adds it here.
#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/bench/private/stress_scene.h"
#include "tests/gpu/render_test.h"

namespace limn {
namespace {

using TechniqueTest = RenderTest;

TEST_F(TechniqueTest, EveryTechniqueAnswersEveryLightAlone) {
  const scene::Scene scene = asset("lights");
  render::Renderer renderer(device(), scene);
  for (const std::string& name : techniquesAnswering(Term::visibility)) {
    for (size_t light = 0; light < renderer.pose().lights.size(); ++light) {
      SCOPED_TRACE(name + ", light " + renderer.pose().lightNames[light]);
      const Image v = picture(renderer, settings(64, 48, Term::visibility, {smallest(name)}, int(light)));
      expectWithin(v, 0, 1);
      EXPECT_GT(mean(v), 0.3) << "mostly lit";
      EXPECT_LT(mean(v), 0.9999) << "something casts a shadow";
    }
  }
}

TEST_F(TechniqueTest, IndirectLightOfEveryLightAloneAndTogether) {
  const scene::Scene scene = asset("lights");
  render::Renderer renderer(device(), scene);
  constexpr int virtualLights = 256;  // of all lights together: few for each
  for (const std::string& name : techniquesAnswering(Term::indirect)) {
    if (lightsBumpsAlone(name)) continue;  // BumpInterreflectionTest adds up lights on bumps
    double sum = 0;
    for (size_t light = 0; light < renderer.pose().lights.size(); ++light) {
      SCOPED_TRACE(name + ", light " + renderer.pose().lightNames[light]);
      const Image alone =
          picture(renderer, settings(64, 48, Term::indirect, {quick(name, virtualLights)}, int(light)));
      expectWithin(alone, 0, 1e6f);
      EXPECT_GT(mean(alone), 0);
      sum += mean(alone);
    }
    // What virtual lights there are depends on how many share them.
    const Image together = picture(renderer, settings(64, 48, Term::indirect, {quick(name, virtualLights)}));
    EXPECT_NEAR(mean(together) / sum, 1, 0.1) << name;
  }
}

TEST_F(TechniqueTest, LightsTogetherAreTheSumOfTheLightsAlone) {
  const scene::Scene scene = asset("lights");
  render::Renderer renderer(device(), scene);
  std::vector<std::string> names = techniquesAnswering(Term::visibility);
  for (const std::string& name : techniquesAnswering(Term::direct))
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    const Image together = picture(renderer, settings(64, 48, Term::direct, {smallest(name)}));
    Image sum(64, 48, {"R", "G", "B"});
    for (size_t light = 0; light < renderer.pose().lights.size(); ++light) {
      const Image alone = picture(renderer, settings(64, 48, Term::direct, {smallest(name)}, int(light)));
      for (size_t i = 0; i < sum.data().size(); ++i) sum.data()[i] += alone.data()[i];
    }
    expectWithin(together, 0, 1e6f);
    EXPECT_GT(mean(together), 0);
    EXPECT_LT(rmse(together, sum), 1e-3 * mean(sum));
  }
}

TEST_F(TechniqueTest, ShadowsOnlyTakeLightAway) {
  const scene::Scene scene = asset("lights");
  render::Renderer renderer(device(), scene);
  const Image unshadowed = picture(renderer, settings(64, 48, Term::direct));
  for (const std::string& name : techniquesAnswering(Term::visibility)) {
    if (contains(registry().find(name).info->terms, Term::direct)) continue;  // does not use core's L_u
    const Image shadowed = picture(renderer, settings(64, 48, Term::direct, {smallest(name)}));
    int brighter = 0;
    for (size_t i = 0; i < shadowed.data().size(); ++i)
      brighter += shadowed.data()[i] > unshadowed.data()[i] * (1 + 1e-5f);
    EXPECT_EQ(brighter, 0) << name;
  }
}

TEST_F(TechniqueTest, ScaleOfTheSceneDoesNotMatter) {
  for (const bool cut : {false, true}) {
    const scene::Scene scene = cut ? coarse("balls") : asset("balls");
    const scene::Scene small = bench::stressed(scene, StressChange::sceneScale, 1e-4f),
                       large = bench::stressed(scene, StressChange::sceneScale, 1e4f);
    render::Renderer renderer(device(), scene), smallRenderer(device(), small),
        largeRenderer(device(), large);
    for (const auto& [name, term] : techniquesAndTerms()) {
      if (cutsSurfaces(name) != cut) continue;
      const auto answer = [&](render::Renderer& of) {
        return picture(of, settings(128, 96, term, {quick(name)}, 0));
      };
      const auto whole = [&](render::Renderer& of) {
        return picture(of, settings(128, 96, Term::final, {quick(name)}));
      };
      // Of a technique that answers both terms the whole picture is the same each time.
      const bool again =
          term == Term::indirect && contains(registry().find(name).info->terms, Term::visibility);
      const Image answered = answer(renderer), shown = again ? Image() : whole(renderer);
      for (render::Renderer* scaled : {&smallRenderer, &largeRenderer}) {
        SCOPED_TRACE(name + (scaled == &smallRenderer ? " at scale 1e-4" : " at scale 1e4"));
        EXPECT_LT(rmse(answered, answer(*scaled)), 1e-3);
        if (!again) {
          EXPECT_LT(rmse(shown, whole(*scaled)), 1e-3);
        }
      }
    }
  }
}

TEST_F(TechniqueTest, ExtremeResolutionsGiveFinitePictures) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  for (const auto& [width, height] :
       {std::pair(1, 1), std::pair(4096, 1), std::pair(1, 4096), std::pair(17, 3)})
    for (const std::string& name : techniquesWithPictures()) {
      SCOPED_TRACE(name);
      expectWithin(picture(renderer, settings(width, height, Term::final, {smallest(name)})), 0, 1e6f);
    }
}

TEST_F(TechniqueTest, RadianceScalesLinearlyOverTwelveDecades) {
  constexpr float kFactors[] = {1e-6f, 1e6f};
  const scene::Scene scene = coarse("balls");
  scene::Scene dim = scene, bright = scene;
  for (scene::LightSource& light : dim.lights) light.intensity *= kFactors[0];
  for (scene::LightSource& light : bright.lights) light.intensity *= kFactors[1];
  render::Renderer renderer(device(), scene), dimRenderer(device(), dim), brightRenderer(device(), bright);
  for (const auto& [name, term] : techniquesAndTerms()) {
    if (lightsBumpsAlone(name)) continue;  // BumpInterreflectionTest scales light on bumps
    SCOPED_TRACE(name);
    const Term shown = term == Term::visibility ? Term::direct : term;
    const auto light = [&](render::Renderer& of) {
      return mean(picture(of, settings(64, 48, shown, {quick(name)})));
    };
    const double one = light(renderer);
    EXPECT_NEAR(light(dimRenderer) / one / kFactors[0], 1.0, 1e-4);
    EXPECT_NEAR(light(brightRenderer) / one / kFactors[1], 1.0, 1e-4);
  }
}

TEST_F(TechniqueTest, CameraInsideAnObjectGivesAFinitePicture) {
  const scene::Scene scene = coarse("balls");
  render::Renderer renderer(device(), scene);
  scene::CameraPose camera = renderer.pose().cameras.at(0);
  for (const std::string& name : techniquesWithPictures()) {
    renderer.configure(settings(64, 48, Term::final, {smallest(name)}));
    camera.worldToView = glm::mat4(1);
    camera.worldToView[3] = glm::vec4(-renderer.pose().bounds.centre(), 1);
    renderer.setCamera(camera);
    renderer.render();
    expectWithin(renderer.read(), 0, 1e6f);
  }
}

/// With the same maps: what is fitted to the view depends on the light's size. Kernels of lights that are all
/// but points are narrower than places in a map resolve, and still hold the receiver's texel.
TEST_F(TechniqueTest, LightsOfSizeZeroGiveTheHardShadowBitForBitAndTinyOnesNearly) {
  for (const char* name : {"balls", "lights"}) {
    const scene::Scene scene = asset(name);
    render::Renderer renderer(device(), scene);
    const Image hard = picture(
        renderer,
        settings(128, 96, Term::visibility, {technique("hard_shadow_map", {{"shadow_map_size", "512"}})}, 0));
    for (const std::string& soft : techniquesAnswering(Term::visibility)) {
      const auto declares = [&](std::string_view parameter) {
        return std::ranges::any_of(registry().find(soft).info->parameters,
                                   [&](const Parameter& p) { return p.name == parameter; });
      };
      if (!declares("light_size") || !declares("shadow_map_size")) continue;
      SCOPED_TRACE(soft + " on " + name);
      const auto ofSize = [&](const char* side) {
        std::vector<std::pair<std::string, std::string>> values{{"light_size", side},
                                                                {"shadow_map_size", "512"}};
        if (declares("shadow_map_fit")) values.emplace_back("shadow_map_fit", "scene");
        return picture(renderer, settings(128, 96, Term::visibility, {technique(soft, values)}, 0));
      };
      const Image point = ofSize("0");
      EXPECT_TRUE(std::equal(hard.data().begin(), hard.data().end(), point.data().begin()));
      EXPECT_LT(rmse(hard, ofSize("1e-8")), 0.15) << "no shadow at all: 0.23 and more";
    }
  }
}

TEST_F(TechniqueTest, TwoAnswersToDirectLightAreRefused) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  EXPECT_THROW(
      renderer.configure(settings(8, 8, Term::final, {technique("pcss"), technique("hard_shadow_map")})),
      UsageError);
}

TEST_F(TechniqueTest, AnEmptySceneCompilesNothingAndAllocatesOnlyTheOutput) {
  const scene::Scene scene;
  for (const std::string& name : techniquesWithPictures()) {
    SCOPED_TRACE(name);
    render::Renderer renderer(device(), scene);
    renderer.configure(settings(64, 48, Term::final, {technique(name)}));
    const gpu::Counters before = device().counters();
    renderer.render();
    EXPECT_EQ(device().counters().programsCompiled, before.programsCompiled);
    EXPECT_EQ(device().counters().textures, before.textures + 1);
    EXPECT_EQ(device().counters().textureBytes - before.textureBytes, 64 * 48 * 16);
    expectWithin(renderer.read(), 0, 0);
  }
}

TEST_F(TechniqueTest, NoLightGivesNoIndirectLightAndNoPassForIt) {
  const scene::Scene scene = bench::stressed(asset("cornell_box"), StressChange::noLight, 0);
  render::Renderer renderer(device(), scene);
  for (const std::string& name : techniquesAnswering(Term::indirect)) {
    SCOPED_TRACE(name);
    expectWithin(picture(renderer, settings(32, 24, Term::indirect, {quick(name)})), 0, 0);
    for (const auto& pass : renderer.explain())
      if (pass.technique == name) {
        EXPECT_EQ(pass.state, frame::PassState::leftOut) << pass.name;
      }
  }
}

TEST_F(TechniqueTest, StaticShadowMapsAreNotRedrawn) {
  const scene::Scene scene = asset("balls");
  render::Renderer renderer(device(), scene);
  for (const bool dynamic : {false, true}) {
    render::Settings s = settings(64, 48, Term::final, {technique("hard_shadow_map")});
    s.dynamic = dynamic;
    picture(renderer, s);
    renderer.render();
    int cached = 0;
    for (const auto& pass : renderer.explain()) cached += pass.state == frame::PassState::cached;
    EXPECT_EQ(cached > 0, !dynamic);
  }
}

}  // namespace
}  // namespace limn
