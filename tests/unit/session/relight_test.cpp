// Lights changed from outside the scene's file, over time.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/scene/camera.h"
#include "core/session/light_edits.h"
#include "core/session/view.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/paths.h"
#include "tests/support/skewed_lamp.h"

namespace limn::session {
namespace {

/// What --set-light leaves of a light goes on with its animation, whenever the scene was opened.
TEST(Relight, HalvesThatAreNotSetFollowTheirAnimation) {
  test::GltfBuilder b;
  b.triangle();
  const int lamp =
      b.light({{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}, {"intensity", 2}}, {{"name", "lamp"}});
  const int times = b.floats({0, 2}), places = b.vec3({{0, 0, 0}, {2, 0, 0}});
  const float s = std::sqrt(0.5f);
  const int turns = b.vec4({{0, 0, 0, 1}, {0, s, 0, s}});
  b.append("animations",
           {{"samplers", {{{"input", times}, {"output", places}}, {{"input", times}, {"output", turns}}}},
            {"channels",
             {{{"sampler", 0}, {"target", {{"node", lamp}, {"path", "translation"}}}},
              {{"sampler", 1}, {"target", {{"node", lamp}, {"path", "rotation"}}}}}}});
  SceneQuestion question;
  question.scene = testing::TempDir() + "moving_lamp.glb";
  writeFile(question.scene, b.glb());
  for (const char* setting : {"lamp.rotation=-90,0,0", "lamp.position=3,4,5"}) {
    question.lightSettings = {setting};
    View view = open(question);
    moveTo(view, question, 1);
    SceneQuestion later = question;
    later.time = 1;
    const View opened = open(later);
    ASSERT_EQ(view.pose.lights.size(), 1u);
    EXPECT_EQ(view.pose.lights[0].position, opened.pose.lights[0].position) << setting;
    EXPECT_EQ(view.pose.lights[0].direction, opened.pose.lights[0].direction) << setting;
    if (question.lightSettings[0].starts_with("lamp.rotation"))
      EXPECT_EQ(view.pose.lights[0].position, glm::vec3(1, 0, 0));
    else
      EXPECT_NEAR(view.pose.lights[0].direction.x, -s, 1e-5f);
  }
}

/// An emissive quad of 2 x 2 m in a node whose scale is that at 0, 1 and 2 seconds, turned about z by those
/// angles (degrees), below a node that is twice as wide as high.
SceneQuestion scaledLamp(const std::string& file, const std::vector<float>& scales,
                         const std::vector<float>& angles = {0, 0, 0}) {
  test::GltfBuilder b;
  b.triangle();
  const int glow = b.append("materials", {{"emissiveFactor", {1, 0.5, 0.25}}});
  const int quad = b.mesh({{"POSITION", b.vec3({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}})}},
                          b.indices({0, 1, 2, 0, 2, 3}), glow);
  const int holder = b.node({{"scale", {2, 1, 1}}, {"translation", {0, 1, 0}}});
  const int lamp = b.node({{"name", "lamp"}, {"mesh", quad}});
  b.root["nodes"][static_cast<size_t>(holder)]["children"] = test::GltfBuilder::json::array({lamp});
  std::vector<glm::vec3> sizes;
  std::vector<glm::vec4> turns;
  for (const float s : scales) sizes.emplace_back(s);
  for (const float a : angles)
    turns.emplace_back(0, 0, std::sin(glm::radians(a) / 2), std::cos(glm::radians(a) / 2));
  const int times = b.floats({0, 1, 2});
  b.append("animations",
           {{"samplers",
             {{{"input", times}, {"output", b.vec3(sizes)}}, {{"input", times}, {"output", b.vec4(turns)}}}},
            {"channels",
             {{{"sampler", 0}, {"target", {{"node", lamp}, {"path", "scale"}}}},
              {{"sampler", 1}, {"target", {{"node", lamp}, {"path", "rotation"}}}}}}});
  SceneQuestion question;
  question.scene = testing::TempDir() + file;
  writeFile(question.scene, b.glb());
  question.light = "lamp";
  return question;
}

void expectAsOpened(const View& view, SceneQuestion question, const std::string& what) {
  question.time = view.time;
  const View opened = open(question);
  ASSERT_EQ(view.pose.lights.size(), 1u) << what;
  ASSERT_EQ(opened.pose.lights.size(), 1u) << what;
  const glsl::Light &light = view.pose.lights[0], &wanted = opened.pose.lights[0];
  EXPECT_EQ(light.emission, wanted.emission) << what;
  EXPECT_EQ(light.length_u, wanted.length_u) << what;
  EXPECT_EQ(light.length_v, wanted.length_v) << what;
  EXPECT_EQ(light.position, wanted.position) << what;
  EXPECT_EQ(light.direction, wanted.direction) << what;
  EXPECT_EQ(light.axis_u, wanted.axis_u) << what;
}

/// A sequence goes on while an animation scales a lamp to nothing, and edits hold from when it has an area.
TEST(Relight, LampsWithoutAreaGiveNoLightUntilTheyHaveOne) {
  SceneQuestion question = scaledLamp("growing_lamp.glb", {0, 1, 2});
  question.lightSettings = {"lamp.position=3,4,5", "lamp.rotation=0,0,0", "lamp.intensity=16"};
  View view = open(question);
  ASSERT_EQ(view.pose.lights.size(), 1u);
  EXPECT_EQ(view.pose.lights[0].emission, glm::vec3(0));
  EXPECT_FALSE(isEditable(view.scene, view.pose, 0));
  moveTo(view, question, 1);
  ASSERT_EQ(view.pose.lights.size(), 1u);
  EXPECT_LT(glm::distance(glm::vec3(view.pose.lights[0].position), glm::vec3(3, 4, 5)), 1e-5f);
  EXPECT_LT(glm::distance(glm::vec3(view.pose.lights[0].emission), glm::vec3(2, 1, 0.5f)), 1e-5f)
      << "16 W/sr over 8 m2";
}

/// A lamp that an animation shrinks to nothing is dark then, unless it was placed: it keeps its size at rest.
TEST(Relight, LampsThatShrinkToNothingKeepTheirSizeWherePlaced) {
  SceneQuestion question = scaledLamp("shrinking_lamp.glb", {1, 0, 1});
  const View rest = open(question);
  ASSERT_EQ(rest.pose.lights.size(), 1u);
  question.time = 1;
  question.lightSettings = {"lamp.intensity=16"};
  const View dark = open(question);
  ASSERT_EQ(dark.pose.lights.size(), 1u);
  EXPECT_EQ(dark.pose.lights[0].emission, glm::vec3(0));
  question.lightSettings.push_back("lamp.position=3,4,5");
  const View lit = open(question);
  ASSERT_EQ(lit.pose.lights.size(), 1u);
  EXPECT_LT(glm::distance(glm::vec3(lit.pose.lights[0].position), glm::vec3(3, 4, 5)), 1e-5f);
  EXPECT_NEAR(lit.pose.lights[0].length_u, rest.pose.lights[0].length_u, 1e-5f);
  EXPECT_NEAR(lit.pose.lights[0].length_v, rest.pose.lights[0].length_v, 1e-5f);
  EXPECT_NEAR(lit.pose.lights[0].length_u * lit.pose.lights[0].length_v, 8, 1e-4f);
  EXPECT_LT(glm::distance(glm::vec3(lit.pose.lights[0].emission), glm::vec3(2, 1, 0.5f)), 1e-5f);
}

/// Whatever was shown before, a time shows what opening at it shows.
TEST(Relight, LampsThatComeAndGoAreTheSameHoweverTheirTimeWasReached) {
  SceneQuestion growing = scaledLamp("coming_lamp.glb", {0, 1, 2});
  SceneQuestion shrinking = scaledLamp("going_lamp.glb", {1, 0, 1});
  for (SceneQuestion* question : {&growing, &shrinking}) {
    for (const std::vector<std::string>& settings : std::vector<std::vector<std::string>>{
             {"lamp.intensity=8"},
             {"lamp.position=3,4,5"},
             {"lamp.size=1,2"},
             {"lamp.position=3,4,5", "lamp.rotation=-80,5,0", "lamp.intensity=8"}}) {
      question->lightSettings = settings;
      for (const double start : {0., 1.}) {
        question->time = start;
        View view = open(*question);
        for (const double time : {1 / 30., 1., 1.75, 2., 0.}) {
          moveTo(view, *question, time);
          expectAsOpened(view, *question,
                         question->scene + " " + settings.back() + " at " + std::to_string(time));
        }
      }
    }
  }
}

/// At 45 degrees below a node of unequal scale the quad is no rectangle, and therefore no light.
TEST(Relight, LampsThatAreNoLightsAtRestAreTheSameHoweverTheirTimeWasReached) {
  SceneQuestion question = scaledLamp("turning_lamp.glb", {1, 1, 3}, {45, 0, 90});
  question.time = 1;
  question.lightSettings = {"lamp.intensity=8"};
  View view = open(question);
  moveTo(view, question, std::nextafter(2., 1.));
  expectAsOpened(view, question, "turned by 90 degrees");
}

/// A lamp that is turned below a node that stretches is skewed, and no rectangle.
TEST(Relight, TheChosenLightIsTheSameOneWhereALampBeforeItIsNone) {
  test::GltfBuilder b;
  test::addSkewedLamp(b, true);
  SceneQuestion question;
  question.scene = testing::TempDir() + "skewed_lamp.glb";
  writeFile(question.scene, b.glb());
  question.light = "chosen";
  View view = open(question);
  EXPECT_EQ(view.light, 1);
  moveTo(view, question, 0.5);
  chooseLight(view, question);
  EXPECT_EQ(view.light, 0);
  question.light = "lamp";
  EXPECT_THROW(chooseLight(view, question), UsageError);
}

/// Default lights stand where the command's camera stands, however it was reached.
TEST(Relight, DefaultLightsFollowTheCamera) {
  SceneQuestion options;
  options.scene = std::string(test::kBinaryDir) + "/assets/gem/gem.glb";
  options.defaultLights = "on";
  View view = open(options);
  options.eye = "1,2,3";
  options.target = "0,0,0";
  moveTo(view, options, 0.25);
  options.time = 0.25;
  const View opened = open(options);
  ASSERT_EQ(view.pose.lights.size(), opened.pose.lights.size());
  for (size_t i = 0; i < view.pose.lights.size(); ++i) {
    EXPECT_EQ(view.pose.lights[i].position, opened.pose.lights[i].position);
    EXPECT_EQ(view.pose.lights[i].direction, opened.pose.lights[i].direction);
    EXPECT_EQ(view.pose.lights[i].emission, opened.pose.lights[i].emission);
  }
  EXPECT_EQ(glm::vec3(view.pose.lights.back().position), glm::vec3(1, 2, 3)) << "the headlight";
}

}  // namespace
}  // namespace limn::session
