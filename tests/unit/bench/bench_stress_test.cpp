// What the stress table asks of techniques, and how a case of several terms is written and read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/bench/private/stress_scene.h"
#include "core/bench/stress.h"
#include "core/scene/subsurface.h"
#include "glsl/caustics/specular_view.glsl"
#include "glsl/materials/model.glsl"

namespace limn::bench {
namespace {

using testing::ElementsAre;

std::vector<std::string> asked(TermSet answered, StressChange change = StressChange::none) {
  return StressRun::terms(answered, change);
}

TEST(BenchStress, AsksForEveryTermByItsPicture) {
  for (const TermInfo& info : kTerms) {
    if (!info.answerable) continue;
    EXPECT_THAT(asked(termSet(info.term)), ElementsAre(info.name));
  }
  EXPECT_THAT(asked(Term::visibility | Term::indirect | Term::environment),
              ElementsAre("visibility", "indirect", "environment"));
  EXPECT_THAT(asked(Term::visibility | Term::direct), ElementsAre("visibility", "direct"));
  EXPECT_THAT(asked(Term::visibility | Term::media), ElementsAre("visibility", "media"));
}

TEST(BenchStress, AsksForLightWhereVisibilityKnowsNothingOfTheCase) {
  for (const StressChange change : {StressChange::radiance, StressChange::albedo}) {
    EXPECT_THAT(asked(Term::visibility | Term::direct, change), ElementsAre("direct"));
    EXPECT_THAT(asked(Term::visibility | Term::indirect | Term::environment, change),
                ElementsAre("direct", "indirect", "environment"));
    EXPECT_THAT(asked(termSet(Term::specular), change), ElementsAre("specular"));
    EXPECT_THAT(asked(termSet(Term::subsurface), change), ElementsAre("subsurface"));
  }
  EXPECT_THAT(asked(Term::visibility | Term::indirect | Term::environment, StressChange::noLight),
              ElementsAre("final"));
  EXPECT_THAT(asked(Term::visibility | Term::media, StressChange::noLight), ElementsAre("final", "media"));
}

TEST(BenchStress, CasesOfNoSceneShowATechniqueWhatItAnswersFor) {
  const auto scene = [](TermSet terms, bool places, const StressCase& c) {
    TechniqueInfo info{};
    info.terms = terms;
    info.places = places;
    return std::string(stressCaseFor(info, c).scene);
  };
  const StressCase common = commonStressCases()[0], foliage{.name = "foliage", .scene = "plant"};
  EXPECT_EQ(scene(termSet(Term::visibility), false, common), "balls");
  EXPECT_EQ(scene(termSet(Term::relief), true, common), "bump_wall");
  EXPECT_EQ(scene(termSet(Term::indirect), true, common), "bump_wall");
  EXPECT_EQ(scene(termSet(Term::subsurface), false, common), "translucent_head");
  EXPECT_EQ(scene(termSet(Term::subsurface), false, foliage), "plant");
}

TEST(BenchStress, MaterialsAndLightBelowSurfacesAreShownWithShadows) {
  const auto beside = [](Term term, const char* given) {
    TechniqueInfo info{};
    info.terms = termSet(term);
    return std::string(stressCaseFor(info, {.name = "any", .beside = given}).beside);
  };
  EXPECT_EQ(beside(Term::surface, ""), "ray_traced_area_light");
  EXPECT_EQ(beside(Term::subsurface, ""), "ray_traced_area_light");
  EXPECT_EQ(beside(Term::surface, "vssm"), "vssm");
  EXPECT_EQ(beside(Term::direct, ""), "");
}

/// A factor of 0 on their lobes would make all pictures black and all errors 0.
TEST(StressedScene, ModelsReflectLight) {
  scene::Scene scene;
  scene.materials.resize(2);
  scene.materials[1].transmission = 1;
  const scene::Scene copper = withModels(scene);
  ASSERT_TRUE(copper.materials[0].model);
  const glm::vec3 albedo = glsl::model_albedo(*copper.materials[0].model);
  EXPECT_GT(std::min({albedo.x, albedo.y, albedo.z}), 0.3f);
  EXPECT_FALSE(copper.materials[1].model) << "glass stays glass";
}

TEST(StressedScene, WhatScattersFollowsItsSurface) {
  scene::Scene scene;
  scene.materials.resize(2);
  for (scene::Material& material : scene.materials)
    material.subsurface = {.extinction = {800, 900, 1000}, .absorption = {0.1f, 0.2f, 0.3f}};
  scene.materials[1].subsurface->albedoFromBaseColour = true;
  scene.materials[1].baseColour = {0.5f, 0.6f, 0.7f, 1};

  EXPECT_EQ(stressed(scene, StressChange::sceneScale, 100).materials[0].subsurface->extinction,
            glm::vec3(8, 9, 10));
  for (const scene::Material& m : stressed(scene, StressChange::albedo, 0.25).materials) {
    EXPECT_EQ(m.baseColour, glm::vec4(0.25f, 0.25f, 0.25f, 1));
    EXPECT_EQ(m.subsurface->absorption, scene::subsurfaceAbsorption(glm::vec3(0.25f), m.ior));
  }
  const scene::Scene bent = stressed(scene, StressChange::refraction, 3);
  EXPECT_EQ(bent.materials[0].subsurface->absorption, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(glm::vec3(bent.materials[0].baseColour), scene::subsurfaceAlbedo(glm::vec3(0.1f, 0.2f, 0.3f), 3));
  EXPECT_EQ(bent.materials[1].baseColour, scene.materials[1].baseColour);
  EXPECT_EQ(bent.materials[1].subsurface->absorption,
            scene::subsurfaceAbsorption(glm::vec3(0.5f, 0.6f, 0.7f), 3));
}

TEST(StressedScene, BodiesAbsorbAsMuchAtEveryScale) {
  scene::Scene scene;
  scene.nodes.resize(1);
  scene.materials.resize(2);
  scene.materials[0].thickness = 0.5f;
  scene.materials[0].attenuationDistance = 0.25f;
  const scene::Scene scaled = stressed(scene, StressChange::sceneScale, 1024);
  const float root = glsl::body_scale(glm::mat3(scene::evaluate(scaled, 0).nodeToWorld.at(1)));
  EXPECT_NEAR(root * scaled.materials[0].thickness, 512, 0.01) << "metres in the world";
  EXPECT_EQ(scaled.materials[0].attenuationDistance, 256);
  EXPECT_EQ(scaled.materials[1].thickness, 0) << "a sheet stays one";
  EXPECT_EQ(scaled.materials[1].attenuationDistance, 0) << "without absorption";
}

StressResult severalTerms() {
  return {.technique = "t",
          .name = "three bounces",
          .scene = "box",
          .settings = "bounces=3",
          .own = true,
          .allowed = 4,
          .answers = {{.term = "indirect", .error = 0.5, .benign = 0.25, .factor = 2},
                      {.term = "visibility", .error = 0.1, .benign = 0.1, .factor = 1}}};
}

TEST(BenchStress, ARowShowsTheWorstTermAndNamesTheOthers) {
  const StressResult results[] = {severalTerms()};
  EXPECT_THAT(toMarkdown(results),
              testing::EndsWith("| t | three bounces (bounces=3) | box | pass | indirect (visibility 1.00) "
                                "| 0.5 | 0.25 | 2.00 | 4.0 |\n"));
  StressResult refused = severalTerms();
  refused.answers[0].verdict = StressVerdict::refused;
  refused.answers[0].message = "too much";
  const StressResult others[] = {refused};
  EXPECT_THAT(toMarkdown(others),
              testing::HasSubstr("| refused: too much | indirect (visibility 1.00) | - |"));
  EXPECT_EQ(StressResult{}.worst().verdict, StressVerdict::pass) << "nothing was asked";
  StressResult accompanied = severalTerms();
  accompanied.beside = "airlight";
  StressResult unset = accompanied;
  unset.settings.clear();
  const StressResult two[] = {accompanied, unset};
  EXPECT_THAT(toMarkdown(two), testing::HasSubstr("| three bounces (bounces=3, beside airlight) |"));
  EXPECT_THAT(toMarkdown(two), testing::HasSubstr("| three bounces (beside airlight) |"));
}

TEST(BenchStress, ResultsOfAnotherProgramAreMarked) {
  StressResult results[] = {severalTerms(), severalTerms()};
  results[0].technique = "old";
  EXPECT_THAT(toMarkdown(results), testing::Not(testing::HasSubstr("\u2020"))) << "none records it";
  for (StressResult& result : results) result.provenance.program = "1";
  EXPECT_THAT(toMarkdown(results), testing::Not(testing::HasSubstr("\u2020")));
  results[1].provenance.program = "2";
  EXPECT_THAT(
      toMarkdown(results),
      testing::AllOf(testing::HasSubstr("| old \u2020 |"), testing::HasSubstr("| t |"),
                     testing::EndsWith("\n\n\u2020 measured with another version of the program, of a "
                                       "technique or of the scene than the newest case\n")));
}

TEST(BenchStress, ResultsOfAnotherTechniqueAreMarked) {
  StressResult results[] = {severalTerms(), severalTerms(), severalTerms()};
  results[1].technique = "other";
  for (StressResult& result : results)
    result.provenance = {"1", "scene", {{result.technique, result.technique + ".so", "old"}}};
  EXPECT_THAT(toMarkdown(results), testing::Not(testing::HasSubstr("\u2020")));
  results[2].provenance.modules[0].hash = "new";
  EXPECT_THAT(toMarkdown(results),
              testing::AllOf(testing::HasSubstr("| t \u2020 |"), testing::HasSubstr("| t |"),
                             testing::HasSubstr("| other |")));
}

TEST(BenchStress, JsonKeepsEveryTermAndLeavesOutResultsOfOne) {
  StressResult results[] = {severalTerms()};
  results[0].beside = "airlight";
  const std::string text = toJson(results, "gpu");
  const std::vector<StressResult> read = stressFromJson(text, "gpu");
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(toJson(read, "gpu"), text);
  EXPECT_EQ(read[0].worst().term, "indirect");
  EXPECT_EQ(read[0].beside, "airlight");
  StressResult origin = severalTerms();
  origin.provenance = {"program", "scene", {{"t", "t.so", "hash"}}};
  const StressResult known[] = {origin};
  EXPECT_EQ(staleness(stressFromJson(toJson(known, "gpu"), "gpu").at(0).provenance, origin.provenance), "");
  EXPECT_THROW(stressFromJson(text, "another"), Error);
  auto json = nlohmann::json::parse(text);
  json["results"][0].erase("answers");
  json["results"][0]["verdict"] = "pass";
  EXPECT_TRUE(stressFromJson(json.dump(), "gpu").empty()) << "as versions wrote it that asked for one term";
  EXPECT_THROW(stressFromJson("{}", "gpu"), Error);
}

}  // namespace
}  // namespace limn::bench
