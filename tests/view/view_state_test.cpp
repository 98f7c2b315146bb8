// What the viewer saves says what it shows.

#include "apps/view/view_state.h"

#include <gmock/gmock.h>

#include <CLI/CLI.hpp>
#include <limits>
#include <sstream>

#include "apps/view/difference.h"
#include "apps/view/display_image.h"
#include "core/bench/suite.h"
#include "core/scene/camera.h"
#include "core/session/technique_choice.h"
#include "core/session/view.h"
#include "glsl/numeric/srgb.glsl"

namespace limn::app {
namespace {

class ViewStateTest : public ::testing::Test {
 protected:
  ViewStateTest() : registry_(TechniqueRegistry::defaultFolders()) { state_.scene.scene = "cornell_box"; }
  void use(const char* techniques, std::vector<std::string> settings = {}) {
    session::TechniqueChoice options;
    options.techniques = techniques;
    options.settings = std::move(settings);
    state_.techniques = options.resolve(registry_);
  }
  TechniqueRegistry registry_;
  ViewState state_;
};

TEST_F(ViewStateTest, CommandsSayOnlyWhatIsNotTheDefault) {
  state_.scene.width = 320;
  state_.scene.height = 200;
  EXPECT_EQ(renderCommand(state_, "a.png"), "limn render cornell_box --size 320x200 --out a.png");
  use("pcss,clustered_visibility", {"pcss.filter_samples=16", "clustered_visibility.vals=5"});
  state_.tone = {-1.5f, ToneCurve::agx};
  state_.scene.term = "direct";
  EXPECT_EQ(
      renderCommand(state_, "a.png"),
      "limn render cornell_box --technique pcss,clustered_visibility --set pcss.filter_samples=16 --set "
      "clustered_visibility.vals=5 --size 320x200 --output-term direct --exposure -1.5 --tonemap agx --out "
      "a.png");
}

TEST_F(ViewStateTest, SamplesFloorAndAutomaticExposureAreInTheCommand) {
  state_.scene.aa = 3;
  state_.scene.floor = "on";
  state_.tone.exposureEv = 2;
  state_.automaticExposure = true;
  EXPECT_EQ(renderCommand(state_, "a.png"),
            "limn render cornell_box --aa 3 --floor on --exposure auto --out a.png");
}

/// Other shaders render another picture.
TEST_F(ViewStateTest, ShadersAreInTheCommand) {
  state_.shaders = "my shaders";
  EXPECT_EQ(renderCommand(state_, "a.png"), "limn render cornell_box --shaders 'my shaders' --out a.png");
}

TEST_F(ViewStateTest, TypedNumbersAreMovedIntoTheFieldsRange) {
  EXPECT_EQ(accepted(questionField("environment_scale"), -1), 0);
  EXPECT_EQ(accepted(questionField("environment_scale"), 20), 20);
  EXPECT_EQ(accepted(questionField("environment_rotation"), -1e9), -1e6);
  EXPECT_EQ(accepted(questionField("time"), std::numeric_limits<double>::infinity()), 1e6);
  EXPECT_EQ(accepted(questionField("light_size"), 1e-9f), 1e-9) << "the float is smaller";
}

/// The frames say the time.
TEST_F(ViewStateTest, SequencesHaveACommand) {
  state_.scene.time = 0.5;
  EXPECT_EQ(sequenceCommand(state_, "a.png", {3, 7}, 24),
            "limn render cornell_box --out a.png --frames 3:7 --fps 24");
}

/// What was changed while the same file was opened again stays; another file begins with its own.
TEST_F(ViewStateTest, ChangesWhileAFileIsOpenedStay) {
  SceneQuestion opened = state_.scene;
  opened.floor = "on";
  opened.environment = "sky";
  SceneQuestion now = state_.scene;
  now.eye = "0,1,3";
  now.target = "0,0,0";
  now.time = 2;
  now.lightSettings = {"key.intensity=3"};
  now.environment = "studio";
  now.aa = 3;
  now.width = 99;
  now.term = "direct";
  SceneQuestion expected = now;
  expected.floor = "on";
  expected.environment = "sky";
  EXPECT_EQ(carriedOver(now, opened, true), expected);
  expected = opened;
  expected.aa = 3;
  expected.width = 99;
  expected.term = "direct";
  EXPECT_EQ(carriedOver(now, opened, false), expected);
}

TEST_F(ViewStateTest, TheNextTechniqueIsAnother) {
  use("vssm,clustered_visibility");
  std::vector<render::TechniqueUse> others = state_.techniques;
  useNextTechnique(others, registry_);
  EXPECT_NE(namesOf(others), namesOf(state_.techniques));
  EXPECT_THAT(namesOf(others), testing::EndsWith(",clustered_visibility"));
}

TEST_F(ViewStateTest, NamesAreQuotedForTheShell) {
  state_.scene.scene = "it's my scene.glb";
  EXPECT_THAT(renderCommand(state_, "$HOME/a b.png"),
              testing::AllOf(testing::StartsWith("limn render 'it'\\''s my scene.glb' "),
                             testing::EndsWith(" --out '$HOME/a b.png'")));
}

/// The numbers of the command line are read as the same numbers.
TEST_F(ViewStateTest, CamerasSurviveTheCommandLine) {
  Orbit orbit(scene::lookAt({0.1f, 1.234567f, 3}, {0, 0.5f, 0}, 0.7f), {glm::vec3(-1), glm::vec3(1)});
  orbit.turn(0.1234f, 0.0567f);
  orbit.approach(1.0f / 3);
  setCamera(state_.scene, orbit, glm::dvec3(0));
  scene::Pose pose;
  pose.cameras.push_back(scene::lookAt({0, 0, 5}, glm::vec3(0), 0.7f));
  EXPECT_EQ(session::chooseCamera(state_.scene, pose, {}).worldToView,
            scene::lookAt(orbit.eye(), orbit.target(), 0.7f).worldToView);
}

TEST_F(ViewStateTest, TechniquesThatClaimTheSameReplaceEachOther) {
  use("pcss,clustered_visibility");
  const TechniquePlugin& vssm = registry_.find("vssm");
  state_.techniques.push_back({&vssm, ParameterValues("vssm", vssm.info->parameters)});
  dropRivals(state_.techniques, vssm);
  ASSERT_EQ(state_.techniques.size(), 2u);
  EXPECT_STREQ(state_.techniques[0].plugin->info->name, "clustered_visibility");
  EXPECT_STREQ(state_.techniques[1].plugin->info->name, "vssm");
}

TEST_F(ViewStateTest, TermsThatATechniqueIsAskedForAreKept) {
  use("vssm,implicit_visibility:indirect", {"implicit_visibility.bins=8"});
  EXPECT_THAT(
      renderCommand(state_, "a.png"),
      testing::HasSubstr("--technique vssm,implicit_visibility:indirect --set implicit_visibility.bins=8 "));
  EXPECT_EQ(bench::parseSuite(benchSuite(state_), "view.toml").cases.at(0).technique,
            "vssm,implicit_visibility:indirect");
  const TechniquePlugin& pcss = registry_.find("pcss");
  state_.techniques.push_back({&pcss, ParameterValues("pcss", pcss.info->parameters)});
  dropRivals(state_.techniques, pcss);
  EXPECT_EQ(namesOf(state_.techniques), "implicit_visibility:indirect,pcss");
}

/// What was measured for a term replaces what answers it.
TEST_F(ViewStateTest, MeasuredTechniquesLeaveThoseOfOtherTerms) {
  const auto after = [&](const char* shown, const char* measured, Term term) {
    use(shown);
    session::TechniqueChoice choice;
    choice.techniques = measured;
    takeMeasured(state_.techniques, choice.resolve(registry_), term);
    return namesOf(state_.techniques);
  };
  EXPECT_EQ(after("vssm,clustered_visibility", "pcss", Term::direct), "pcss,clustered_visibility");
  EXPECT_EQ(after("vssm,clustered_visibility", "vssm", Term::visibility), "vssm,clustered_visibility");
  EXPECT_EQ(after("vssm,clustered_visibility", "pcss", Term::final), "pcss");
  EXPECT_EQ(after("pcss,clustered_visibility", "implicit_visibility:indirect", Term::indirect),
            "implicit_visibility:indirect,pcss");
}

TEST_F(ViewStateTest, SuitesAreSuites) {
  use("vssm,clustered_visibility", {"vssm.shadow_map_size=512"});
  state_.scene.width = 96;
  state_.scene.height = 64;
  state_.scene.time = 0.5;
  state_.scene.lightSize = 0.25;
  state_.scene.term = "direct";
  const bench::Suite suite = bench::parseSuite(benchSuite(state_), "view.toml");
  ASSERT_EQ(suite.cases.size(), 1u);
  EXPECT_EQ(suite.cases[0].technique, "vssm,clustered_visibility");
  EXPECT_EQ(suite.cases[0].width, 96);
  EXPECT_EQ(suite.cases[0].lightSize, 0.25);
  EXPECT_EQ(suite.cases[0].time, 0.5);
}

/// All that the command says is in the suite.
TEST_F(ViewStateTest, SuitesKeepEverySetting) {
  use("pcss,clustered_visibility,image_space_refraction");
  SceneQuestion& s = state_.scene;
  s.camera = "front";
  s.eye = "0,1,3";
  s.target = "0,0.5,0";
  s.fov = 30;
  s.environment = "sky.exr";
  s.environmentRotation = 45;
  s.environmentScale = 0.5;
  s.environmentLights = 0.02;
  s.environmentResolution = 24;
  s.environmentShape = "rectangles";
  s.environmentReflection = "centre";
  s.environmentCombine = "ratio";
  s.animation = "walk";
  s.lightSettings = {"key.size=1,2", "key.intensity=3"};
  s.sigmaA = "0.1,0.2,0.3";
  s.sigmaS = "0.5";
  s.g = 0.25;
  s.grid = "smoke";
  s.defaultLights = "on";
  const bench::Suite suite = bench::parseSuite(benchSuite(state_), "view.toml");
  ASSERT_EQ(suite.cases.size(), 1u);
  const bench::Case& c = suite.cases[0];
  EXPECT_EQ(static_cast<const SceneQuestion&>(c), s);
  EXPECT_EQ(c.reference.bounces, 1) << "indirect light is in the picture";
  EXPECT_EQ(c.reference.interfaces, render::interfacesOf(Term::final, state_.techniques));
  EXPECT_GT(c.reference.interfaces, 0) << "glass is in the picture";
}

TEST(Orbit, StartsWhereTheCameraIs) {
  const scene::Bounds box{glm::vec3(-1), glm::vec3(1)};
  const scene::CameraPose camera = scene::lookAt({2, 3, 4}, {0.2f, 0.1f, 0}, 0.8f);
  const Orbit orbit(camera, box);
  const glm::mat4 again = scene::lookAt(orbit.eye(), orbit.target(), 0.8f).worldToView;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) EXPECT_NEAR(again[c][r], camera.worldToView[c][r], 2e-5f);
}

/// From the middle of a room, which lies neither before nor behind the camera, one gets on all the same.
TEST(Orbit, FliesInsideAScene) {
  Orbit orbit(scene::lookAt({0, 1, 0}, {0, 1, -1}, 0.8f), {glm::vec3(-10), glm::vec3(10)});
  const glm::vec3 before = orbit.eye();
  orbit.fly(0, 0, 0.6f);  // in a second
  EXPECT_GT(before.z - orbit.eye().z, 0.9f);
}

TEST(Orbit, NeverTurnsOver) {
  Orbit orbit(scene::lookAt({0, 0, 4}, glm::vec3(0), 0.8f), {glm::vec3(-1), glm::vec3(1)});
  for (int i = 0; i < 100; ++i) orbit.turn(0, 0.3f);
  EXPECT_GT(orbit.eye().y, 3.9f);
  for (int i = 0; i < 1000; ++i) orbit.approach(0.5f);
  EXPECT_GT(glm::distance(orbit.eye(), orbit.target()), 0);
}

/// A turn of the wheel is the same part of the distance in the smallest and in the largest scene.
TEST(Orbit, GoesNearerAndFartherAtAnyScale) {
  for (const float size : {1e-6f, 1.f, 1e12f}) {
    const scene::Bounds box{glm::vec3(-size), glm::vec3(size)};
    Orbit orbit(scene::lookAt({0, 0, 4 * size}, glm::vec3(0), 0.8f), box);
    orbit.approach(0.9f);
    EXPECT_NEAR(orbit.eye().z / size, 3.6f, 1e-3f) << size;
    orbit.approach(2);
    EXPECT_NEAR(orbit.eye().z / size, 7.2f, 1e-3f) << size;
  }
}

/// A file that is read again may lie elsewhere: the next drag goes on from where the camera is.
TEST(Orbit, StaysInTheWorldWhenTheOriginMoves) {
  const glm::dvec3 from(1e6, 0, -2e6), to(1e6 + 512, 64, -2e6);
  Orbit orbit(scene::lookAt({1, 2, 4}, glm::vec3(0), 0.8f), {glm::vec3(-1), glm::vec3(1)});
  SceneQuestion before, after;
  setCamera(before, orbit, from);
  orbit.recount(from, to);
  setCamera(after, orbit, to);
  const auto place = [](const std::string& text) {
    glm::dvec3 at(0);
    std::istringstream words(text);
    char comma = 0;
    words >> at.x >> comma >> at.y >> comma >> at.z;
    return at;
  };
  EXPECT_LT(glm::distance(place(after.eye), place(before.eye)), 1e-4);
  EXPECT_LT(glm::distance(place(after.target), place(before.target)), 1e-4);
}

TEST(Orbit, LookingAroundStaysInPlace) {
  Orbit orbit(scene::lookAt({1, 2, 4}, glm::vec3(0), 0.8f), {glm::vec3(-1), glm::vec3(1)});
  const glm::vec3 eye = orbit.eye();
  orbit.look(0.3f, -0.2f);
  EXPECT_LT(glm::distance(orbit.eye(), eye), 1e-5f);
}

TEST(Difference, IsSignedAndLogarithmic) {
  const DifferenceScale scale{.least = 0.01f, .most = 1};
  EXPECT_EQ(differencePosition(0.005f, scale), 0);
  EXPECT_NEAR(differencePosition(0.1f, scale), 0.5f, 1e-6f);
  EXPECT_NEAR(differencePosition(-0.1f, scale), -0.5f, 1e-6f);
  EXPECT_EQ(differencePosition(100, scale), 1);
  EXPECT_EQ(differencePosition(-100, scale), -1);
  EXPECT_GT(differenceColour(1).x, differenceColour(1).z) << "too bright: red";
  EXPECT_GT(differenceColour(-1).z, differenceColour(-1).x) << "too dark: blue";
}

TEST(Difference, ComparesPixelByPixel) {
  Image a = Image::rgb(2, 1), b = Image::rgb(2, 1);
  for (int c = 0; c < 3; ++c) a.at(0, 0, c) = 5;
  const Image8 picture = signedDifference(a, b, {});
  const glm::vec3 red = differenceColour(1), white = differenceColour(0);
  EXPECT_EQ(picture.data[0], std::lround(255 * red.x));
  EXPECT_EQ(picture.data[2], std::lround(255 * red.z));
  EXPECT_EQ(picture.data[4], std::lround(255 * white.x));
  EXPECT_THROW(signedDifference(a, Image::rgb(1, 1), {}), std::exception);
}

TEST(DisplayImage, IsWhatPngFilesHold) {
  Image image = Image::rgb(1, 1);
  image.at(0, 0, 0) = 0.25f;
  image.at(0, 0, 1) = 7;
  image.at(0, 0, 2) = -1;
  const Image8 shown = toneMapped(image, {1});
  EXPECT_EQ(shown.data[0], std::lround(255 * glsl::srgb_encode(0.5f)));
  EXPECT_EQ(shown.data[1], 255);
  EXPECT_EQ(shown.data[2], 0);
}

TEST(DisplayImage, WindowsAreReadFromBelow) {
  const std::vector<uint8_t> pixels{0, 0, 0, 255, 255, 255};
  const Image image = fromBottomFirst({1, 2}, pixels);
  EXPECT_EQ(image.at(0, 0, 0), 1);
  EXPECT_EQ(image.at(0, 1, 0), 0);
}

}  // namespace
}  // namespace limn::app
