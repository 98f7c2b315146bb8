// What the table of questions says of each field's effect is true of the scene that is opened.
#include "core/session/view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/same_bytes.h"
#include "core/question/question_fields.h"
#include "core/scene_io/load.h"
#include "core/session/find.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/paths.h"
#include "tests/support/question_samples.h"

namespace limn::session {
namespace {

/// The content hash of the reference that answers the question.
std::string referenceHash(const SceneQuestion& question) {
  const View view = open(question);
  const reference::Request request = referenceRequest(view, view.pose, view.camera, parseTerm(question.term));
  return reference::contentHash(request);
}

/// The gem, with a second animation that turns another node.
std::string twoAnimations() {
  std::string glb = readTextFile(std::string(test::kBinaryDir) + "/assets/gem/gem.glb", 1 << 24);
  const auto word = [&](size_t at) {
    uint32_t value = 0;
    std::memcpy(&value, glb.data() + at, 4);
    return value;
  };
  nlohmann::json json = nlohmann::json::parse(glb.substr(20, word(12)));
  nlohmann::json second = json["animations"][0];
  second["name"] = "other";
  for (nlohmann::json& channel : second["channels"])
    channel["target"]["node"] = channel["target"]["node"] == 0 ? 1 : 0;
  json["animations"].push_back(second);
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  glb.replace(20, word(12), text);
  const auto put = [&](size_t at, size_t value) {
    const auto number = static_cast<uint32_t>(value);
    std::memcpy(glb.data() + at, &number, 4);
  };
  put(12, text.size());
  put(8, glb.size());
  const std::string file = testing::TempDir() + "two_animations.glb";
  writeTextFile(file, glb);
  return file;
}

/// A question in which the field matters, without and with it.
std::pair<SceneQuestion, SceneQuestion> exampleOf(const QuestionField& field) {
  const std::string key = field.key;
  SceneQuestion without;
  without.scene = "lights";
  without.width = without.height = 16;
  if (key != "environment") without.environment = "sky";
  if (field.approximates && key != "environment_lights") without.environmentLights = 0.05;
  if (key == "g" || key == "grid") without.sigmaS = "0.1";
  if (key == "eye" || key == "target") without.eye = "3,2,1", without.target = "0,0.5,0";
  if (key == "displaced") without.scene = "groove";
  if (key == "time") without.scene = "gem";
  if (key == "animation") without.scene = twoAnimations(), without.time = 0.5;
  SceneQuestion with = without;
  test::setSample(field, with);
  const std::map<std::string, std::string SceneQuestion::*> names{
      {"scene", &SceneQuestion::scene}, {"camera", &SceneQuestion::camera},
      {"eye", &SceneQuestion::eye},     {"target", &SceneQuestion::target},
      {"light", &SceneQuestion::light}, {"animation", &SceneQuestion::animation},
      {"grid", &SceneQuestion::grid},   {"environment", &SceneQuestion::environment}};
  const std::map<std::string, std::string> values{
      {"scene", "gem"}, {"camera", "close"},    {"eye", "0,1,3"},  {"target", "0,0,0"},
      {"light", "key"}, {"animation", "other"}, {"grid", "smoke"}, {"environment", "sky"}};
  if (const auto found = names.find(key); found != names.end()) with.*found->second = values.at(key);
  if (key == "default_lights") with.defaultLights = "on";
  if (key == "set_light") with.lightSettings = {"key.intensity=77"};
  if (key == "term") with.term = "direct";
  if (key == "light_size") with.lightSize = 0.3;
  if (key == "environment_rotation") with.environmentRotation = 90;
  if (key == "environment_lights") with.environmentLights = 0.05;
  if (key == "environment_resolution") with.environmentResolution = 32;
  if (key == "time") with.time = 0.5;
  return {without, with};
}

TEST(SceneQuestion, FieldsChangeTheReferenceUnlessTheyApproximate) {
  for (const QuestionField& field : questionFields()) {
    const auto [without, with] = exampleOf(field);
    EXPECT_EQ(referenceHash(without) == referenceHash(with), field.approximates) << field.key;
  }
}

/// Moving, lighting or looking again is enough where the table says so.
TEST(SceneQuestion, FieldsNeedNoMoreThanTheirEffect) {
  for (const QuestionField& field : questionFields()) {
    if (field.effect == QuestionEffect::scene || field.effect == QuestionEffect::view) continue;
    const auto [without, with] = exampleOf(field);
    View view = open(without);
    if (field.effect == QuestionEffect::lights)
      relight(view, with);
    else
      moveTo(view, with, with.time);
    EXPECT_EQ(reference::contentHash(referenceRequest(view, view.pose, view.camera, Term::final)),
              referenceHash(with))
        << field.key;
  }
}

/// An open view, to the bit, against what opening gives.
void expectShown(const View& view, const SceneQuestion& question, const std::string& what) {
  const View opened = open(question);
  const Term term = parseTerm(question.term);
  EXPECT_EQ(reference::contentHash(referenceRequest(view, view.pose, view.camera, term)),
            reference::contentHash(referenceRequest(opened, opened.pose, opened.camera, term)))
      << what;
  EXPECT_TRUE(sameBytes(view.pose.lights, opened.pose.lights)) << what;
  EXPECT_EQ(view.pose.lightNames, opened.pose.lightNames) << what;
  EXPECT_EQ(view.pose.instances, opened.pose.instances) << what;
  EXPECT_EQ(view.camera.worldToView, opened.camera.worldToView) << what;
  EXPECT_EQ(view.camera.yfov, opened.camera.yfov) << what;
  EXPECT_EQ(view.size, opened.size) << what;
  EXPECT_EQ(view.aa, opened.aa) << what;
  EXPECT_EQ(view.light, opened.light) << what;
}

/// What a bench changes in the scene that it has open; for everything else it opens it again.
TEST(OpenScene, ShowsOtherQuestionsAsOpeningDoes) {
  for (const QuestionField& field : questionFields()) {
    const auto [without, with] = exampleOf(field);
    const bool shown = field.effect == QuestionEffect::view || field.key == std::string_view("light_size");
    EXPECT_EQ(openedScene(without) == openedScene(with), shown) << field.key;
    if (!shown) continue;
    View view = open(without);
    show(view, without, with);
    expectShown(view, with, field.key);
    show(view, with, without);
    expectShown(view, without, std::string(field.key) + " taken back");
  }
}

/// With lights that follow the camera and lights that were edited, after any other size.
TEST(OpenScene, LightsHaveTheirSizeWhateverWasShownBefore) {
  SceneQuestion question;
  question.scene = "lights";
  for (const char* defaultLights : {"off", "on"}) {
    question.defaultLights = defaultLights;
    question.lightSettings = {"key.intensity=77", "key.position=1,2,3"};
    question.lightSize = 0;
    SceneQuestion before = question;
    View view = open(question);
    for (const double size : {0.3, 2.0, 0.0, 0.3}) {
      question.lightSize = size;
      EXPECT_TRUE(show(view, before, question));
      expectShown(view, question, std::string(defaultLights) + " " + std::to_string(size));
      before = question;
    }
  }
}

/// What is refused is refused as where the scene is opened.
TEST(OpenScene, RefusesWhatOpeningRefuses) {
  SceneQuestion question;
  question.scene = "cornell_box";  // its lamp is a mesh
  const SceneQuestion before = question;
  View view = open(question);
  question.lightSize = 0.3;
  EXPECT_THROW(open(question), UsageError);
  EXPECT_THROW(show(view, before, question), UsageError);
}

/// A triangle that nothing lights.
SceneQuestion unlit() {
  test::GltfBuilder builder;
  builder.triangle();
  SceneQuestion question;
  question.scene = testing::TempDir() + "unlit.glb";
  writeFile(question.scene, builder.glb());
  return question;
}

/// A scene without a camera is looked at from one place whatever its time, with a floor as without.
TEST(Framing, IsTheSameAtAllTimesAndWithAFloor) {
  SceneQuestion question = unlit();
  const View view = open(question);
  question.time = 0.5;
  EXPECT_EQ(open(question).camera.worldToView, view.camera.worldToView);
  question.floor = "on";
  const View floor = open(question);
  EXPECT_EQ(floor.camera.worldToView, view.camera.worldToView);
  EXPECT_EQ(floor.pose.instances.size(), view.pose.instances.size() + 1);
  EXPECT_LT(floor.pose.bounds.low.y, view.pose.bounds.low.y);
}

TEST(Find, KnowsTheNamesOfWhatCameWithLimn) {
  EXPECT_THAT(sceneNames(), testing::IsSupersetOf({"balls", "cornell_box", "robot"}));
  EXPECT_THAT(environmentNames(), testing::IsSupersetOf({"sky", "studio"}));
  const auto expectSuggestion = [](std::filesystem::path (*find)(const std::filesystem::path&),
                                   const char* name, const char* nearest) {
    try {
      find(name);
      ADD_FAILURE() << name << " was found";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(std::string("did you mean ") + nearest));
    }
  };
  expectSuggestion(findScene, "robt", "robot");
  expectSuggestion(findEnvironment, "studoi", "studio");
  expectSuggestion(findSuite, "quik", "quick");
}

/// Results often go into a folder that has the name of what they are of.
TEST(Find, AFolderOfTheNameIsPassedOver) {
  namespace fs = std::filesystem;
  const fs::path before = fs::current_path(),
                 here = fs::temp_directory_path() / ("limn_find_" + std::to_string(::getpid()));
  for (const char* name : {"balls", "sky", "quick"}) fs::create_directories(here / name);
  fs::current_path(here);
  const fs::path scene = findScene("balls"), environment = findEnvironment("sky"), suite = findSuite("quick");
  fs::current_path(before);
  fs::remove_all(here);
  EXPECT_TRUE(fs::is_regular_file(scene)) << scene;
  EXPECT_TRUE(fs::is_regular_file(environment)) << environment;
  EXPECT_TRUE(fs::is_regular_file(suite)) << suite;
  try {
    findSuite(before);
    ADD_FAILURE() << "a folder was found";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("suite '" + before.string() + "' is a folder"));
  }
}

TEST(Find, NamesThatRepeatAreFoundByTheirIndex) {
  const std::vector<std::string> names{"main", "side", "main", "#3", "main"};
  const std::vector<std::string> findable = findableNames(names);
  EXPECT_EQ(findable, (std::vector<std::string>{"main", "side", "#2", "#3", "#4"}));
  for (size_t i = 0; i < names.size(); ++i)
    EXPECT_EQ(findNamed("camera", findable[i], names), static_cast<int>(i));
}

TEST(DefaultLights, BringAnEnvironmentToScenesThatHaveNone) {
  std::string said;
  const View lit = open(unlit(), [&](const std::string& line) { said += line; });
  EXPECT_TRUE(lit.defaultLights);
  EXPECT_EQ(lit.pose.lightNames, (std::vector<std::string>{"key", "headlight"}));
  std::vector<std::string> warnings;
  const scene::Environment studio = scene::loadEnvironment(findEnvironment("studio"), warnings);
  EXPECT_EQ(lit.scene.environment.texels, studio.texels);
  EXPECT_NE(said.find("studio"), std::string::npos) << said;

  SceneQuestion off = unlit();
  off.defaultLights = "off";
  EXPECT_FALSE(open(off).scene.environment);
  EXPECT_NE(referenceHash(unlit()), referenceHash(off));
}

/// Coefficients are per metre: what is haze in a room hides a valley.
TEST(Medium, IsWarnedOfWhereItHidesTheScene) {
  SceneQuestion question;
  question.scene = "balls";
  const double diameter = 2 * open(question).pose.bounds.radius();
  const auto said = [&](double depth) {
    question.sigmaS = std::to_string(0.25 * depth / diameter);
    question.sigmaA = std::to_string(0.75 * depth / diameter);
    std::string lines;
    open(question, [&](const std::string& line) { lines += line; });
    return lines;
  };
  EXPECT_EQ(said(19).find("optical depth"), std::string::npos);
  EXPECT_THAT(said(40), testing::HasSubstr("optical depth is 40 over"));
  question.grid = "smoke";  // its density is less than 1 nearly everywhere
  EXPECT_EQ(said(40).find("optical depth"), std::string::npos);
}

TEST(Medium, CoefficientsPerSceneAreOpticalDepths) {
  SceneQuestion question;
  question.scene = "balls";
  const double diameter = 2 * open(question).pose.bounds.radius();
  question.sigmaS = "0.5/scene";
  question.sigmaA = "1,2,0/scene";
  const scene::Medium medium = open(question).scene.medium;
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(medium.sigmaS[i] * diameter, 0.5, 1e-6);
  EXPECT_NEAR(medium.sigmaA.x * diameter, 1, 1e-6);
  EXPECT_NEAR(medium.sigmaA.y * diameter, 2, 1e-6);
  EXPECT_EQ(medium.sigmaA.z, 0);
  for (const char* wrong : {"/scene", "1 /scene ", "-1/scene", "1/2/scene", "1,2/scene", "nan/scene"}) {
    question.sigmaS = wrong;
    EXPECT_THROW(open(question), UsageError) << wrong;
  }
}

/// Of several animations the one that is asked for says how wide the scene is.
TEST(Medium, CoefficientsPerSceneAndSmokeFollowTheAnimation) {
  test::GltfBuilder b;
  b.triangle();
  const int start = b.floats({0});
  for (const float size : {1.f, 10.f}) {
    const int scale = b.vec3({glm::vec3(size)});
    b.append("animations", {{"samplers", {{{"input", start}, {"output", scale}}}},
                            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}});
  }
  const std::string file = testing::TempDir() + "two_sizes.glb";
  writeFile(file, b.glb());
  SceneQuestion question;
  question.scene = file;
  question.defaultLights = "off";
  question.sigmaS = "0.5/scene";
  question.animation = "#1";
  question.grid = "smoke";
  const View view = open(question);
  const double diameter = 2 * view.pose.bounds.radius();
  EXPECT_NEAR(diameter, std::sqrt(200.0), 1e-5);
  EXPECT_NEAR(view.scene.medium.sigmaS.x * diameter, 0.5, 1e-6);
  EXPECT_GE(view.scene.medium.smoke.value().high.x, view.pose.bounds.high.x);
}

TEST(DefaultLights, LeaveScenesAsTheyAreLitUnlessAskedFor) {
  SceneQuestion gem;
  gem.scene = "gem";
  EXPECT_FALSE(open(gem).scene.environment);
  gem.defaultLights = "on";
  const View both = open(gem);
  EXPECT_EQ(both.pose.lights.size(), 3u);
  EXPECT_TRUE(both.scene.environment);
  gem.environment = "sky";
  const View sky = open(gem);
  EXPECT_EQ(sky.pose.lights.size(), 3u);
  EXPECT_NE(sky.scene.environment.texels, both.scene.environment.texels) << "one's own environment stays";
  SceneQuestion underSky = unlit();
  underSky.environment = "sky";
  EXPECT_FALSE(open(underSky).defaultLights);
}

/// The key light is a directional one like those of files.
TEST(DefaultLights, AreResizedAsOtherLights) {
  SceneQuestion question = unlit();
  question.lightSize = 0.3;
  EXPECT_EQ(open(question).pose.lights.at(0).angular_diameter, 0.3f);
  question.scene = "lights";
  question.defaultLights = "on";
  const View both = open(question);
  for (size_t i = 0; i < both.pose.lights.size(); ++i) {
    const glsl::Light& light = both.pose.lights[i];
    if (light.type == glsl::light_directional) {
      EXPECT_EQ(light.angular_diameter, 0.3f) << both.pose.lightNames[i];
    }
  }
}

/// The lights move with the camera; what metals mirror is turned and scaled as any environment, and not by
/// the camera.
TEST(DefaultLights, EnvironmentTurnsByItsOptionsAlone) {
  SceneQuestion question = unlit();
  View view = open(question);
  question.eye = "1,2,3";
  question.target = "0,0,0";
  moveTo(view, question, 0);
  EXPECT_EQ(view.scene.environment.rotation, 0);
  EXPECT_EQ(view.scene.environment.scale, 1);
  question.environmentRotation = 180;
  question.environmentScale = 0.5;
  relight(view, question);
  EXPECT_FLOAT_EQ(view.scene.environment.rotation, glsl::pi);
  EXPECT_EQ(view.scene.environment.scale, 0.5f);
}

}  // namespace
}  // namespace limn::session
