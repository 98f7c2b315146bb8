// Lights changed from outside the scene's file.
#include "core/session/light_edits.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/scene/camera.h"
#include "core/session/view.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/paths.h"

namespace limn::session {
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
