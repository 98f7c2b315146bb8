// Animation, world matrices, skins, morph targets, instances and sources against values worked out by hand.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using json = nlohmann::json;
using scene::evaluate;
using scene::kNone;
using scene::Pose;
using scene::Scene;

/// One node with a channel on `path`.
GltfBuilder animated(const char* path, const char* interpolation, const std::vector<float>& times,
                     const std::vector<glm::vec3>& vectors, const std::vector<glm::vec4>& rotations = {}) {
  GltfBuilder b;
  b.node({{"name", "n"}});
  const int input = b.floats(times);
  const int output = rotations.empty() ? b.vec3(vectors) : b.vec4(rotations);
  b.append("animations",
           {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}});
  return b;
}

glm::vec3 translationAt(const Scene& s, double time) {
  return evaluate(s, time).nodeToWorld[0][3];
}

TEST(SceneEvaluate, LinearAndStep) {
  const Scene linear =
      loadBuilt(animated("translation", "LINEAR", {1, 3, 4}, {{0, 0, 0}, {2, 4, 6}, {0, 0, 0}}));
  EXPECT_EQ(linear.animations[0].duration, 4);
  expectNear(translationAt(linear, 0.5), {0, 0, 0});  // before the first key
  expectNear(translationAt(linear, 1.5), {0.5f, 1, 1.5f});
  expectNear(translationAt(linear, 3), {2, 4, 6});
  expectNear(translationAt(linear, 3.5), {1, 2, 3});
  expectNear(translationAt(linear, 4 + 1.5), {0.5f, 1, 1.5f});  // repeats
  expectNear(translationAt(linear, 1.5 - 4), {0.5f, 1, 1.5f});  // backwards too
  const Scene step = loadBuilt(animated("translation", "STEP", {0, 1, 2}, {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}));
  expectNear(translationAt(step, 0.999), {1, 0, 0});
  expectNear(translationAt(step, 1), {2, 0, 0});
  expectNear(translationAt(step, 1.999), {2, 0, 0});
}

TEST(SceneEvaluate, Slerp) {
  const float s = std::sqrt(0.5f);
  // From none to 90 degrees about Y; the second key's quaternion has the far sign.
  const Scene scene = loadBuilt(animated("rotation", "LINEAR", {0, 1}, {}, {{0, 0, 0, 1}, {0, -s, 0, -s}}));
  const glm::mat4 m = evaluate(scene, 1.0 / 3).nodeToWorld[0];
  const float angle = glm::radians(30.f);
  expectNear(m[0], {std::cos(angle), 0, -std::sin(angle)});
  expectNear(m[1], {0, 1, 0});
}

TEST(SceneEvaluate, CubicSpline) {
  // value 0 to 1 over two seconds, out-tangent 1 at the first, in-tangent -2 at the second key. At t = 1/4:
  // h00 = 0.84375, h10 = 0.140625, h01 = 0.15625, h11 = -0.046875; 2 * 0.140625 * 1 + 0.15625 * 1 + 2 *
  // -0.046875 * -2.
  const Scene scene =
      loadBuilt(animated("translation", "CUBICSPLINE", {0, 2},
                         {{9, 0, 0}, {0, 0, 0}, {1, 0, 0}, {-2, 0, 0}, {1, 0, 0}, {9, 0, 0}}));
  expectNear(translationAt(scene, 0.5), {0.28125f + 0.15625f + 0.1875f, 0, 0});
  expectNear(translationAt(scene, 0), {0, 0, 0});
}

TEST(SceneEvaluate, RotationSplineIsUnit) {
  const Scene scene = loadBuilt(
      animated("rotation", "CUBICSPLINE", {0, 1}, {},
               {{0, 0, 0, 0}, {0, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 0}}));
  const glm::mat4 m = evaluate(scene, 0.5).nodeToWorld[0];  // half way: 90 degrees about X
  expectNear(m[1], {0, 0, 1});
}

TEST(SceneEvaluate, HierarchyAndMatrices) {
  GltfBuilder b;
  b.node({{"name", "child"}, {"translation", {0, 0, 5}}});
  b.node({{"name", "root"},
          {"children", {0, 2}},
          {"translation", {1, 2, 3}},
          {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}},
          {"scale", {2, 2, 2}}});
  b.node({{"name", "matrix"}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 0, 0, 1}}});
  const Scene scene = loadBuilt(b);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) EXPECT_LT(scene.nodes[i].parent, static_cast<int>(i));
  const Pose pose = evaluate(scene, 0);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    // 90 degrees about Y takes +Z to +X and +X to -Z; then times 2.
    if (scene.nodes[i].name == "child") expectNear(pose.nodeToWorld[i][3], {1 + 10, 2, 3});
    if (scene.nodes[i].name == "matrix") expectNear(pose.nodeToWorld[i][3], {1, 2, 3 - 14});
  }
}

TEST(SceneEvaluate, UsageErrors) {
  const Scene scene = loadBuilt(animated("translation", "STEP", {0}, {{1, 0, 0}}));
  EXPECT_THROW(evaluate(scene, 0, 1), UsageError);
  EXPECT_THROW(evaluate(scene, 0, -2), UsageError);
  EXPECT_THROW(evaluate(scene, std::numeric_limits<double>::quiet_NaN()), UsageError);
  expectNear(translationAt(scene, 10), {1, 0, 0});  // one key: no duration
}

/// At rest the loader refuses them; animations may lead there.
TEST(SceneEvaluate, PlacesBeyondWhatFloatsHoldAreRefused) {
  const json above = {{"children", {0}}, {"scale", {100, 100, 100}}};
  GltfBuilder grown = animated("scale", "LINEAR", {0, 1}, {{1, 1, 1}, {3e38f, 3e38f, 3e38f}});
  grown.root["nodes"][0]["mesh"] = grown.mesh({{"POSITION", grown.vec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}});
  grown.node(above);
  GltfBuilder gone = animated("translation", "LINEAR", {0, 1}, {{0, 0, 0}, {3e38f, 0, 0}});
  gone.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  gone.root["extensions"]["KHR_lights_punctual"]["lights"].push_back(json{{"type", "point"}});
  gone.node(above);
  const auto refusal = [](const Scene& scene, double time) -> std::string {
    try {
      evaluate(scene, time);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  for (const auto& [builder, message] :
       {std::pair(grown, "at 0.5 s the scene's extent is not a finite number"),
        std::pair(gone, "at 0.5 s the place of light 'n' is not finite")}) {
    const Scene scene = loadBuilt(builder);
    EXPECT_EQ(refusal(scene, 0), "");
    EXPECT_THAT(refusal(scene, 0.5), testing::StartsWith(message));
  }
}

/// Weights between keys of which each is a number.
TEST(SceneEvaluate, MorphWeightsBeyondWhatFloatsHoldAreRefused) {
  GltfBuilder b;
  b.triangle();
  b.root["meshes"][0]["primitives"][0]["targets"] =
      json::array({{{"POSITION", b.vec3(std::vector<glm::vec3>(3, glm::vec3(0, 0, 2)))}}});
  const int input = b.floats({0, 1, 2}), output = b.floats({0, -3e38f, 3e38f});
  b.append("animations", {{"samplers", {{{"input", input}, {"output", output}}}},
                          {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
  const Scene scene = loadBuilt(b);
  EXPECT_THAT([&] { evaluate(scene, 1.5); },
              testing::ThrowsMessage<Error>(testing::AllOf(testing::StartsWith("at 1.5 s "),
                                                           testing::HasSubstr("is not a finite number"))));
}

GltfBuilder skinned() {
  GltfBuilder b;
  const int joints = b.accessor(std::vector<glm::u8vec4>{{0, 1, 0, 0}, {0, 1, 0, 0}, {0, 1, 0, 0}},
                                GltfBuilder::kUbyte, "VEC4");
  const int weights = b.vec4({{1, 0, 0, 0}, {0.5f, 0.5f, 0, 0}, {0, 2, 0, 0}});
  const int positions = b.vec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const int normals = b.vec3(std::vector<glm::vec3>(3, glm::vec3(0, 0, 1)));
  const int mesh =
      b.mesh({{"POSITION", positions}, {"NORMAL", normals}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
  b.node({{"mesh", mesh}, {"skin", 0}, {"translation", {100, 0, 0}}});  // ignored for skinned meshes
  b.node({{"translation", {0, 10, 0}}});
  b.node({{"translation", {4, 0, 0}}, {"scale", {1, 1, 2}}});
  glm::mat4 second(1);
  second[3] = glm::vec4(0, -1, 0, 1);
  const int bind = b.accessor(std::vector<glm::mat4>{glm::mat4(1), second}, GltfBuilder::kFloat, "MAT4");
  b.append("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", bind}});
  return b;
}

TEST(SceneEvaluate, Skin) {
  const Scene scene = loadBuilt(skinned());
  EXPECT_THAT(scene.warnings, testing::ElementsAre(testing::HasSubstr("skin weights do not sum to 1")));
  const Pose pose = evaluate(scene, 0);
  ASSERT_EQ(pose.instances.size(), 1u);
  ASSERT_EQ(pose.instances[0].deformed, 0);
  EXPECT_EQ(pose.instances[0].objectToWorld, glm::mat4(1));
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
  scene::deform(scene.meshes[0].primitives[0], pose.deformed[0], positions, normals, tangents);
  expectNear(positions[0], {0, 10, 0});
  expectNear(positions[1], {1 + 2, 5 - 0.5f, 0});  // the mean of (1, 10, 0) and (5, -1, 0)
  expectNear(positions[2], {4, 0, 0});
  for (const glm::vec3& n : normals) expectNear(n, {0, 0, 1});
  for (const glm::vec3& p : positions) {
    EXPECT_TRUE(glm::all(glm::lessThanEqual(pose.bounds.low, p + 1e-5f)));
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(pose.bounds.high, p - 1e-5f)));
  }
}

TEST(SceneEvaluate, NodesOfSkinnedMeshesDecideOnTheWinding) {
  Scene scene = loadBuilt(skinned());
  EXPECT_FALSE(evaluate(scene, 0).instances[0].mirroredSkin);
  for (scene::Node& node : scene.nodes)
    if (node.mesh != kNone) node.transform.scale = {-1, 1, 1};
  const Pose pose = evaluate(scene, 0);
  EXPECT_TRUE(pose.instances[0].mirroredSkin);
  EXPECT_EQ(pose.instances[0].objectToWorld, glm::mat4(1));
  scene.meshes[0].primitives[0].joints.clear();
  EXPECT_FALSE(evaluate(scene, 0).instances[0].mirroredSkin) << "rigid: objectToWorld says it";
}

TEST(SceneEvaluate, SkinNormalsFollowTheSurface) {
  const glm::mat4 m = glm::scale(glm::rotate(glm::mat4(1), 0.7f, glm::vec3(1, 2, 3)), glm::vec3(1, 3, -0.5f));
  const glm::vec3 n = glm::normalize(glm::vec3(1, 1, 1));
  const glm::vec3 expected = glm::normalize(glm::transpose(glm::inverse(glm::mat3(m))) * n);
  Scene scene = loadBuilt(skinned());
  scene::Primitive& primitive = scene.meshes[0].primitives[0];
  primitive.normals.assign(3, n);
  primitive.tangents.assign(3, glm::vec4(glm::normalize(glm::vec3(1, -1, 0)), -1));
  scene::Deformation state;
  state.joints.assign(2, m);
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
  scene::deform(primitive, state, positions, normals, tangents);
  for (int i = 0; i < 3; ++i) {
    expectNear(normals[static_cast<std::size_t>(i)], expected);
    EXPECT_NEAR(glm::dot(glm::vec3(tangents[static_cast<std::size_t>(i)]), expected), 0, 1e-5);
    EXPECT_EQ(tangents[static_cast<std::size_t>(i)].w, -1);
  }
}

TEST(SceneEvaluate, MorphTargets) {
  GltfBuilder b;
  b.triangle();
  const int up = b.vec3(std::vector<glm::vec3>(3, glm::vec3(0, 0, 2)));
  const int side = b.vec3({{1, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  b.root["meshes"][0]["primitives"][0]["targets"] =
      json::array({{{"POSITION", up}}, {{"POSITION", side}, {"NORMAL", side}}});
  b.root["meshes"][0]["weights"] = {0.5, 0};
  const int input = b.floats({0, 1}), output = b.floats({0, 0, 1, 1});
  b.append("animations", {{"samplers", {{{"input", input}, {"output", output}}}},
                          {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
  Scene scene = loadBuilt(b);
  Pose pose = evaluate(scene, 0.25);
  EXPECT_THAT(pose.deformed.at(0).morphWeights, testing::ElementsAre(0.25f, 0.25f));
  EXPECT_TRUE(pose.deformed[0].joints.empty());
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
  scene::deform(scene.meshes[0].primitives[0], pose.deformed[0], positions, normals, tangents);
  expectNear(positions[0], {0.25f, 0, 0.5f});
  expectNear(positions[2], {0, 1, 0.5f});
  expectNear(normals[0], glm::normalize(glm::vec3(0.25f, 0, 1)));
  EXPECT_NEAR(pose.bounds.high.z, 0.5f, 1e-5f);
  scene.animations.clear();
  EXPECT_THAT(evaluate(scene, 0.25).deformed[0].morphWeights, testing::ElementsAre(0.5f, 0.f));
}

TEST(SceneEvaluate, Instances) {
  GltfBuilder b;
  b.triangle();
  const int t = b.vec3({{0, 0, 0}, {10, 0, 0}}), s = b.vec3({{1, 1, 1}, {2, 2, 2}});
  const int r =
      b.accessor(std::vector<glm::i8vec4>{{0, 0, 0, 127}, {0, 0, 127, 0}}, GltfBuilder::kByte, "VEC4");
  b.root["accessors"][static_cast<std::size_t>(r)]["normalized"] = true;
  b.root["nodes"][0]["translation"] = {0, 1, 0};
  b.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", t}, {"ROTATION", r}, {"SCALE", s}};
  const Scene scene = loadBuilt(b);
  EXPECT_EQ(scene.triangles(), 2u);
  const Pose pose = evaluate(scene, 0);
  ASSERT_EQ(pose.instances.size(), 2u);
  expectNear(pose.instances[0].objectToWorld[3], {0, 1, 0});
  expectNear(pose.instances[1].objectToWorld * glm::vec4(1, 0, 0, 1), {10 - 2, 1, 0});  // half a turn about Z
  expectNear(pose.bounds.low, {0, -1, 0});
  expectNear(pose.bounds.high, {10, 2, 0});
}

/// The first primitive follows the skin alone, the second one morph targets alone.
TEST(SceneEvaluate, CopiesDeformAsTheirNodeDoes) {
  Scene scene = loadBuilt(skinned());
  std::vector<scene::Primitive>& primitives = scene.meshes[0].primitives;
  scene::Primitive morphed = primitives[0];
  morphed.joints.clear();
  morphed.weights.clear();
  morphed.jointBounds.clear();
  morphed.morphTargets.resize(1);
  primitives.push_back(std::move(morphed));
  scene.meshes[0].morphWeights = {0.5f};
  for (scene::Node& node : scene.nodes)
    if (node.mesh != kNone) node.instances = {{}, {.translation = {7, 0, 0}}};
  const Pose pose = evaluate(scene, 0);
  ASSERT_EQ(pose.instances.size(), 4u);
  EXPECT_EQ(pose.deformed.size(), 2u);
  for (const scene::DrawInstance& instance : pose.instances) {
    ASSERT_NE(instance.deformed, kNone);
    const scene::Deformation& state = pose.deformed.at(static_cast<std::size_t>(instance.deformed));
    EXPECT_EQ(state.primitive, instance.primitive);
    EXPECT_EQ(state.joints.empty(), instance.primitive == 1);
  }
  EXPECT_EQ(pose.instances[2].objectToWorld, glm::mat4(1)) << "a skin decides on the place";
  expectNear(pose.instances[3].objectToWorld[3], {107, 0, 0});
}

class Growing : public scene::GeometrySource {
 public:
  std::shared_ptr<const scene::Primitive> at(double time) override {
    if (time == 0) return nullptr;
    auto made = std::make_shared<scene::Primitive>();
    made->positions = {glm::vec3(-1), glm::vec3(static_cast<float>(time)), glm::vec3(0)};
    made->normals.assign(normals, glm::vec3(0, 0, 1));
    made->indices = {0, 1, last};
    made->tangents.resize(tangents);
    made->uvs.resize(uvs);
    made->colours.resize(colours);
    return made;
  }
  uint32_t last = 2;
  size_t normals = 3, tangents = 0, uvs = 0, colours = 0;
};

TEST(SceneEvaluate, DynamicGeometryComesLast) {
  GltfBuilder b;
  b.triangle();
  Scene scene = loadBuilt(b);
  const auto source = std::make_shared<Growing>();
  scene.dynamic.push_back({"surface", source, 0});
  const Pose pose = evaluate(scene, 7);
  ASSERT_EQ(pose.instances.size(), 2u);
  EXPECT_EQ(pose.instances[1].node, kNone);
  EXPECT_EQ(pose.instances[1].mesh, 0);
  expectNear(pose.bounds.low, glm::vec3(-1));
  expectNear(pose.bounds.high, glm::vec3(7));
  EXPECT_TRUE(evaluate(scene, 0).dynamic.at(0).bounds.empty());
  source->last = 3;
  EXPECT_THROW(evaluate(scene, 7), Error);
  source->last = 2;
  source->normals = 2;
  EXPECT_THROW(evaluate(scene, 7), Error);
  source->normals = 3;
  for (size_t Growing::*count : {&Growing::tangents, &Growing::uvs, &Growing::colours}) {
    (*source).*count = 3;
    EXPECT_NO_THROW(evaluate(scene, 7));
    (*source).*count = 2;
    EXPECT_THROW(evaluate(scene, 7), Error) << "one for each vertex, or none";
    (*source).*count = 0;
  }
}

TEST(SceneEvaluate, PoseFollowsAnotherScene) {
  Pose pose;
  evaluate(loadBuilt(skinned()), 0, kNone, pose);
  evaluate(Scene{}, 0, kNone, pose);
  EXPECT_TRUE(pose.instances.empty() && pose.deformed.empty() && pose.lights.empty() &&
              pose.lightNames.empty());
  EXPECT_TRUE(pose.bounds.empty());
}

}  // namespace
}  // namespace limn::test
