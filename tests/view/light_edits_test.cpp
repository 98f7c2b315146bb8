// Lights changed from outside the scene's file.
#include "apps/limn/light_edits.h"

#include <gmock/gmock.h>

#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/scene/camera.h"
#include "tests/support/paths.h"

namespace limn::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

scene::Scene twoLights() {
  scene::Scene scene;
  scene.lights.push_back({.name = "shared", .type = glsl::light_spot, .intensity = 3});
  for (const char* name : {"left", "right"}) {
    scene::Node node;
    node.name = name;
    node.light = 0;
    node.limnArea = {1, 2};
    node.transform.translation = {1, 2, 3};
    scene.nodes.push_back(node);
  }
  return scene;
}

std::string refusal(const std::vector<std::string>& settings) {
  try {
    scene::Scene scene = twoLights();
    applyLightEdits(scene, scene::evaluate(scene, 0), parseLightEdits(settings));
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(LightEdits, AreReadAsTheyArePrinted) {
  const std::vector<std::string> settings{"a.b.position=0.1,-2,1e-05", "a.b.rotation=-90,0,45.5",
                                          "a.b.size=0.25,0.5", "a.b.colour=1,0.5,0", "a.b.intensity=12.5"};
  const LightEdits edits = parseLightEdits(settings);
  ASSERT_EQ(edits.size(), 1u);
  EXPECT_EQ(edits.begin()->first, "a.b") << "names may have dots";
  EXPECT_EQ(printed(edits), settings);
}

TEST(LightEdits, ChangeOneLightAlone) {
  scene::Scene scene = twoLights();
  const scene::Pose before = scene::evaluate(scene, 0);
  applyLightEdits(scene, before,
                  parseLightEdits({"right.position=4,5,6", "right.rotation=-90,0,0", "right.size=0.5",
                                   "right.colour=0.25", "right.intensity=2"}));
  const scene::Pose pose = scene::evaluate(scene, 0);
  EXPECT_EQ(pose.lights[0].position, before.lights[0].position);
  EXPECT_EQ(pose.lights[0].emission, before.lights[0].emission);
  EXPECT_EQ(pose.lights[1].position, glm::vec4(4, 5, 6, 1));
  EXPECT_NEAR(pose.lights[1].direction.y, -1, 1e-6f) << "pitched down";
  EXPECT_EQ(pose.lights[1].axis_u.w, 0.5f);
  EXPECT_EQ(pose.lights[1].axis_v.w, 0.5f);
  EXPECT_EQ(pose.lights[1].emission.x, 0.25f * 2 / 0.25f);
  EXPECT_EQ(pose.lightNames, before.lightNames);
}

TEST(LightEdits, DescribeWhatIs) {
  scene::Scene scene = twoLights();
  const LightEdits edits = parseLightEdits({"left.position=1,0,2", "left.rotation=20,30,-40", "left.size=1,3",
                                            "left.colour=1,2,3", "left.intensity=7"});
  applyLightEdits(scene, scene::evaluate(scene, 0), edits);
  const LightEdit now = describeLight(scene, scene::evaluate(scene, 0), 0), wanted = edits.at("left");
  EXPECT_EQ(now.position, wanted.position);
  EXPECT_EQ(now.size, wanted.size);
  EXPECT_EQ(now.colour, wanted.colour);
  EXPECT_EQ(now.intensity, wanted.intensity);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR((*now.rotation)[c], (*wanted.rotation)[c], 1e-3f);
}

TEST(LightEdits, AnglesAreThoseOfTheRotation) {
  for (const glm::vec3& angles :
       {glm::vec3(0), glm::vec3(-90, 35, 0), glm::vec3(90, -120, 0), glm::vec3(10, 170, -60)}) {
    const glm::mat3 r = rotationOf(angles), again = rotationOf(anglesOf(r));
    for (int c = 0; c < 3; ++c)
      for (int row = 0; row < 3; ++row) EXPECT_NEAR(r[c][row], again[c][row], 1e-5f) << angles.x;
  }
}

TEST(LightEdits, RefusalsSayWhatIsAccepted) {
  EXPECT_THAT(refusal({"left"}), testing::AllOf(HasSubstr("'left'"), HasSubstr("position=x,y,z")));
  EXPECT_THAT(refusal({"left.position=1,2"}), HasSubstr("3 numbers"));
  EXPECT_THAT(refusal({"left.position=1,2,x"}), HasSubstr("a number is wrong"));
  EXPECT_THAT(refusal({"left.size=0"}), HasSubstr("above 0"));
  EXPECT_THAT(refusal({"left.intensity=-1"}), HasSubstr("not negative"));
  EXPECT_THAT(refusal({"middle.intensity=1"}), HasSubstr("left"));
}

/// Default lights stand where the command's camera stands, however it was reached.
TEST(Relight, DefaultLightsFollowTheCamera) {
  SceneOptions options;
  options.scene = std::string(test::binaryDir) + "/assets/gem/gem.glb";
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
}  // namespace limn::app
