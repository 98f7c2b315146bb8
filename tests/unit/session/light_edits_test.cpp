// Lights changed from outside the scene's file.
#include "core/session/light_edits.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/base/error.h"

namespace limn::session {
namespace {

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

/// Files may call their lights as they like, and a window undoes and redoes what it printed of them.
TEST(LightEdits, NamesMayHoldWhatLooksLikeAProperty) {
  LightEdits edits;
  for (const char* name : {"lamp.position=left", "lamp.size=1", "a.colour=b.position=", ".intensity="}) {
    LightEdit& edit = edits[name];
    edit.position = glm::dvec3(1, 2, 3);
    edit.rotation = glm::vec3(10, 20, 30);
    edit.size = glm::vec2(0.5f, 2);
    edit.colour = glm::vec3(1, 0.5f, 0);
    edit.intensity = 4.f;
  }
  EXPECT_EQ(parseLightEdits(printed(edits)), edits);
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
  EXPECT_EQ(pose.lights[1].position, glm::vec3(4, 5, 6));
  EXPECT_NEAR(pose.lights[1].direction.y, -1, 1e-6f) << "pitched down";
  EXPECT_EQ(pose.lights[1].length_u, 0.5f);
  EXPECT_EQ(pose.lights[1].length_v, 0.5f);
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

/// What hangs on a lamp, and its own mesh, keep their place and size where the light keeps its own.
TEST(LightEdits, KeepTheScaleOfTheNode) {
  scene::Scene scene = twoLights();
  scene.nodes[1].transform.scale = glm::vec3(0.01f, -0.02f, 0.03f);
  scene.nodes[1].transform.rotation = glm::quat(rotationOf({20, 30, -40}));
  scene::Node bulb;
  bulb.parent = 1;
  bulb.transform.translation = {100, 0, 0};
  scene.nodes.push_back(bulb);
  const scene::Pose before = scene::evaluate(scene, 0);
  scene::Scene moved = scene;
  LightEdits edits;
  edits["right"].rotation = describeLight(scene, before, 1).rotation;
  applyLightEdits(scene, before, edits);
  const scene::Pose pose = scene::evaluate(scene, 0);
  for (const size_t node : {1u, 2u})
    for (int c = 0; c < 4; ++c)
      EXPECT_LT(glm::distance(pose.nodeToWorld[node][c], before.nodeToWorld[node][c]), 1e-5f) << node << c;
  applyLightEdits(moved, before, parseLightEdits({"right.position=4,5,6"}));
  const scene::Pose there = scene::evaluate(moved, 0);
  EXPECT_EQ(there.lights[1].position, glm::vec3(4, 5, 6));
  const glm::vec4 step = glm::vec4(4, 5, 6, 1) - before.nodeToWorld[1][3];
  EXPECT_LT(glm::distance(there.nodeToWorld[2][3], before.nodeToWorld[2][3] + step), 1e-5f);
}

/// A node without extent shows nothing, but its light can be turned.
TEST(LightEdits, TurnLightsOfFlatNodes) {
  scene::Scene scene = twoLights();
  scene.nodes[1].transform.scale = glm::vec3(1, 1, 0);
  applyLightEdits(scene, scene::evaluate(scene, 0), parseLightEdits({"right.rotation=-90,0,0"}));
  EXPECT_NEAR(scene::evaluate(scene, 0).lights[1].direction.y, -1, 1e-6f);
}

/// Two lamps, whose meshes share a material: an emissive quad each, turned and scaled by its node.
class MeshLights : public testing::Test {
 protected:
  MeshLights() {
    scene_.materials.emplace_back().emission = {4, 2, 0};
    for (const char* name : {"left", "right"}) {
      scene::Primitive quad;
      quad.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
      quad.normals.assign(4, {0, 0, 1});
      quad.indices = {0, 1, 2, 0, 2, 3};
      quad.material = 0;
      quad.bounds = {{-1, -1, 0}, {1, 1, 0}};
      quad.emissiveParts = {{{.sideU = {2, 0, 0}, .sideV = {0, 2, 0}}}};
      scene_.meshes.push_back({name, {quad}, {}});
      scene::Node node;
      node.name = name;
      node.mesh = static_cast<int>(scene_.meshes.size()) - 1;
      node.transform.translation = {1, 3, 2};
      node.transform.rotation = glm::angleAxis(0.5f, glm::vec3(1, 0, 0));
      node.transform.scale = {0.5f, 0.25f, 1};
      scene_.nodes.push_back(node);
    }
    giveOwnMaterials(scene_);
  }
  scene::Pose edited(const std::vector<std::string>& settings) {
    applyLightEdits(scene_, scene::evaluate(scene_, 0), parseLightEdits(settings));
    return scene::evaluate(scene_, 0);
  }
  scene::Scene scene_;
};

TEST_F(MeshLights, AreDescribedAsRectangles) {
  const scene::Pose pose = scene::evaluate(scene_, 0);
  ASSERT_TRUE(isEditable(scene_, pose, 1));
  const LightEdit now = describeLight(scene_, pose, 1);
  EXPECT_EQ(now.position, glm::dvec3(1, 3, 2));
  EXPECT_NEAR(now.size->x, 1, 1e-6f);
  EXPECT_NEAR(now.size->y, 0.5f, 1e-6f);
  EXPECT_EQ(now.colour, glm::vec3(1, 0.5f, 0));
  EXPECT_NEAR(*now.intensity, 4 * 0.5f, 1e-5f) << "radiance times area";
}

TEST_F(MeshLights, AreMovedTurnedAndResizedAlone) {
  const scene::Pose before = scene::evaluate(scene_, 0);
  const scene::Pose pose =
      edited({"right.position=-1,2,0.5", "right.rotation=-90,0,0", "right.size=2,0.25", "right.intensity=3"});
  EXPECT_EQ(pose.lights[0].position, before.lights[0].position);
  EXPECT_EQ(pose.lights[0].emission, before.lights[0].emission);
  const glsl::Light& light = pose.lights[1];
  EXPECT_LT(glm::distance(light.position, glm::vec3(-1, 2, 0.5f)), 1e-6f);
  EXPECT_NEAR(light.direction.y, -1, 1e-6f) << "shines down";
  EXPECT_NEAR(light.length_u, 2, 1e-5f);
  EXPECT_NEAR(light.length_v, 0.25f, 1e-5f);
  EXPECT_LT(glm::distance(light.emission, glm::vec3(6, 3, 0)), 1e-5f) << "3 W/sr over 0.5 m2";
  EXPECT_EQ(pose.instances[0].objectToWorld, before.instances[0].objectToWorld);
}

/// Smaller lights are brighter: what they send stays the same.
TEST_F(MeshLights, KeepTheirIntensityWhenResized) {
  const scene::Pose pose = edited({"left.size=0.5,0.5"});
  EXPECT_NEAR(*describeLight(scene_, pose, 0).intensity, 2, 1e-5f);
  EXPECT_LT(glm::distance(pose.lights[0].emission, glm::vec3(8, 4, 0)), 1e-4f);
}

/// Where an animated lamp was put by hand, it stays, and is the same whenever that was done.
TEST_F(MeshLights, StayWhereTheyArePutWhateverAnimationsSay) {
  scene::Animation& animation = scene_.animations.emplace_back();
  animation.duration = 2;
  animation.channels = {{scene::AnimationChannel::Path::translation,
                         scene::AnimationChannel::Interpolation::linear,
                         1,
                         {0, 2},
                         {1, 3, 2, 5, 3, 2}}};
  const LightEdits edits =
      parseLightEdits({"right.position=-1,2,0.5", "right.rotation=-80,5,0", "right.size=2,0.25"});
  scene::Scene later = scene_;
  applyLightEdits(scene_, scene::evaluate(scene_, 0.25), edits);
  applyLightEdits(later, scene::evaluate(later, 1.5), edits);
  EXPECT_EQ(scene::evaluate(scene_, 1).instances[1].objectToWorld,
            scene::evaluate(later, 1).instances[1].objectToWorld);
}

/// Of several animations the start of the one that is shown says how large a lamp is.
TEST_F(MeshLights, AreAtRestAtTheStartOfTheirAnimation) {
  for (const float scale : {0.5f, 1.f}) {
    scene::Animation& animation = scene_.animations.emplace_back();
    animation.duration = 2;
    animation.channels = {{scene::AnimationChannel::Path::scale,
                           scene::AnimationChannel::Interpolation::linear,
                           1,
                           {0, 2},
                           {scale, scale, 1, 2, 2, 1}}};
  }
  const int shown = 1;
  applyLightEdits(scene_, scene::evaluate(scene_, 1, shown), parseLightEdits({"right.intensity=3"}), shown);
  EXPECT_NEAR(*describeLight(scene_, scene::evaluate(scene_, 0, shown), 1).intensity, 3, 1e-5f);
}

/// Whichever way they are named.
TEST_F(MeshLights, AreToldFromLampsThatChangeNoMaterial) {
  scene_.lights.push_back({.name = "lamp", .type = glsl::light_point, .intensity = 3});
  scene_.nodes.emplace_back().light = 0;
  const scene::Pose pose = scene::evaluate(scene_, 0);
  ASSERT_EQ(pose.lights.size(), 3u) << "lamps are the first ones";
  const auto change = [&](const char* setting) { return changeMeshes(pose, parseLightEdits({setting})); };
  for (const char* setting : {"right.intensity=5", "#2.intensity=5", "left.position=0,1,0", "#1.colour=1"})
    EXPECT_TRUE(change(setting)) << setting;
  for (const char* setting : {"lamp.intensity=5", "#0.intensity=5"}) EXPECT_FALSE(change(setting)) << setting;
  EXPECT_FALSE(changeMeshes(pose, {}));
  EXPECT_THROW(change("#3.intensity=5"), UsageError);
}

TEST_F(MeshLights, OfSharedMeshesCanOnlyBeMoved) {
  scene_.nodes.push_back(scene_.nodes[1]);
  scene_.nodes.back().name = "third";
  const LightEdit now = describeLight(scene_, scene::evaluate(scene_, 0), 2);
  EXPECT_TRUE(now.position && now.rotation);
  EXPECT_FALSE(now.size || now.colour || now.intensity);
  EXPECT_LT(glm::distance(glm::vec3(edited({"third.position=0,1,0"}).lights[2].position), glm::vec3(0, 1, 0)),
            1e-6f);
  EXPECT_THROW(edited({"third.intensity=1"}), UsageError);
  scene_.nodes.back().name = "right";
  EXPECT_FALSE(isEditable(scene_, scene::evaluate(scene_, 0), 2)) << "the name is another's";
}

TEST_F(MeshLights, OfSeveralPartsAreLeftAlone) {
  scene_.meshes[1].primitives[0].emissiveParts.push_back(scene_.meshes[1].primitives[0].emissiveParts[0]);
  EXPECT_FALSE(isEditable(scene_, scene::evaluate(scene_, 0), 1));
  EXPECT_THROW(edited({"right#1.intensity=1"}), UsageError);
  scene_.nodes[1].transform.scale = glm::vec3(0);
  EXPECT_THROW(edited({"right#1.intensity=1"}), UsageError) << "whether or not it has an area now";
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
  EXPECT_THAT(refusal({"left.position=1,2,3,"}), HasSubstr("3 numbers"));
  EXPECT_THAT(refusal({"left.colour=1,2"}), HasSubstr("3 numbers")) << "one stands for all, two do not";
  EXPECT_THAT(refusal({"left.size=1,"}), HasSubstr("a number is wrong"));
  EXPECT_THAT(refusal({"left.size=1,2,3"}), HasSubstr("2 numbers"));
  EXPECT_THAT(refusal({"left.intensity=1,"}), HasSubstr("one number"));
  EXPECT_THAT(refusal({"left.size=0"}), HasSubstr("above 0"));
  EXPECT_THAT(refusal({"left.size=1,1e-25"}), HasSubstr("at least 1e-9"));
  EXPECT_THAT(refusal({"left.intensity=-1"}), HasSubstr("not negative"));
  EXPECT_THAT(refusal({"middle.intensity=1"}), HasSubstr("left"));
}

}  // namespace
}  // namespace limn::session
