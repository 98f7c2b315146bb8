// Lights and cameras of nodes, and the lights that emissive quads are, against values worked out by hand.
#include <cmath>
#include <utility>

#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using json = nlohmann::json;
using scene::evaluate;
using scene::Pose;
using scene::Scene;

TEST(SceneEvaluate, Lights) {
  GltfBuilder b;
  const double s = std::sqrt(0.5);
  b.light({{"type", "point"}, {"color", {1, 0.5, 0.25}}, {"intensity", 8}, {"range", 4}},
          {{"name", "lamp"}, {"translation", {1, 2, 3}}, {"scale", {5, 6, 7}}});
  b.light({{"type", "spot"}, {"intensity", 2}, {"spot", {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.6}}}},
          {{"rotation", {-s, 0, 0, s}}});  // -90 degrees about X: -Z becomes -Y
  b.light({{"type", "directional"}, {"name", "sun"}, {"extras", {{"limn_angle", 0.009}}}});
  b.light({{"type", "spot"}, {"intensity", 12}, {"spot", {{"outerConeAngle", 1}}}},
          {{"extras", {{"limn_area", {2, 3}}}}, {"scale", {9, 9, 9}}});
  const Pose pose = evaluate(loadBuilt(b), 0);
  ASSERT_EQ(pose.lights.size(), 4u);
  EXPECT_THAT(pose.lightNames, testing::ElementsAre("lamp", "#1", "sun", "#3"));
  EXPECT_EQ(pose.lights[0].type, glsl::light_point);
  expectNear(pose.lights[0].position, {1, 2, 3});
  expectNear(pose.lights[0].emission, {8, 4, 2});
  EXPECT_EQ(pose.lights[0].range, 4);
  EXPECT_EQ(pose.lights[0].own_instance, glsl::no_instance);
  EXPECT_EQ(pose.lights[1].type, glsl::light_spot);
  EXPECT_EQ(pose.lights[1].flags, glsl::light_flag_cone);
  EXPECT_EQ(pose.lights[1].index, 1u);
  expectNear(pose.lights[1].direction, {0, -1, 0});
  EXPECT_NEAR(pose.lights[1].cos_inner, std::cos(0.3), 1e-6);
  EXPECT_NEAR(pose.lights[1].cos_outer, std::cos(0.6), 1e-6);
  EXPECT_EQ(pose.lights[2].type, glsl::light_directional);
  expectNear(pose.lights[2].direction, {0, 0, -1});
  EXPECT_NEAR(pose.lights[2].angular_diameter, 0.009, 1e-7);
  const glsl::Light& area = pose.lights[3];
  EXPECT_EQ(area.type, glsl::light_rectangle);
  EXPECT_EQ(area.flags, glsl::light_flag_cone);
  expectNear(area.emission, glm::vec3(2));  // 12 W/sr over 6 m^2, whatever the scale
  EXPECT_EQ(area.length_u, 2);
  EXPECT_EQ(area.length_v, 3);
  expectNear(glm::cross(area.axis_u, area.axis_v), -area.direction);
}

/// The cosines of a cone of half a degree and of its axis differ by 4e-5.
TEST(SceneEvaluate, NarrowSpotsHaveTheirWholeLightOnTheAxis) {
  for (const double outer : {0.3, 0.01, 0.004}) {
    GltfBuilder b;
    b.light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5 * outer}, {"outerConeAngle", outer}}}});
    const glsl::Light light = evaluate(loadBuilt(b), 0).lights[0];
    const auto factor = [&](double angle) {
      return glsl::spot_cone_factor(light, glm::vec3(std::sin(angle), 0, -std::cos(angle)));
    };
    EXPECT_EQ(factor(0), 1) << outer;
    EXPECT_EQ(factor(1.1 * outer), 0) << outer;
    // The ramp is linear in the cosine, squared.
    const double ramp = (std::cos(0.8 * outer) - std::cos(outer)) / (std::cos(0.5 * outer) - std::cos(outer));
    EXPECT_NEAR(factor(0.8 * outer), ramp * ramp, 0.04) << outer;
  }
}

GltfBuilder quad(const std::vector<glm::vec3>& corners, json material, json node = json::object()) {
  GltfBuilder b;
  b.triangle();
  const int m = b.append("materials", std::move(material));
  node["mesh"] = b.mesh({{"POSITION", b.vec3(corners)}}, b.indices({0, 1, 2, 0, 2, 3}), m);
  b.node(node);
  return b;
}
const std::vector<glm::vec3> kQuad = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
const json kGlow = {{"emissiveFactor", {1, 0.5, 0}},
                    {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 10}}}}}};

TEST(SceneEvaluate, EmissiveQuadIsALight) {
  const Pose pose = evaluate(loadBuilt(quad(kQuad, kGlow, {{"name", "panel"}, {"scale", {1, 3, 1}}})), 0);
  ASSERT_EQ(pose.lights.size(), 1u);
  const glsl::Light& light = pose.lights[0];
  EXPECT_EQ(pose.lightNames[0], "panel");
  EXPECT_EQ(light.type, glsl::light_rectangle);
  EXPECT_EQ(light.flags, glsl::light_flag_geometry);
  EXPECT_EQ(light.own_instance, 1u);  // the second draw instance
  expectNear(light.emission, {10, 5, 0});
  expectNear(light.position, {1, 1.5f, 0});
  expectNear(light.direction, {0, 0, 1});
  EXPECT_NEAR(light.length_u * light.length_v, 6, 1e-5);
  expectNear(glm::cross(light.axis_u, light.axis_v), -light.direction);
}

TEST(SceneEvaluate, EmissiveQuadVariants) {
  json both = kGlow;
  both["doubleSided"] = true;
  EXPECT_EQ(evaluate(loadBuilt(quad(kQuad, both)), 0).lights.at(0).flags,
            glsl::light_flag_geometry | glsl::light_flag_two_sided);
  // Mirrored: the winding turns around in the file's space, the front face stays where the normal points.
  const auto mirrored = evaluate(loadBuilt(quad(kQuad, kGlow, {{"scale", {-1, 1, 1}}})), 0).lights.at(0);
  expectNear(mirrored.direction, {0, 0, 1});
  expectNear(mirrored.position, {-1, 0.5f, 0});
  for (const auto& corners :
       {std::vector<glm::vec3>{{0, 0, 0}, {2, 0, 0}, {2.1f, 1, 0}, {0.1f, 1, 0}},  // skewed
        std::vector<glm::vec3>{{0, 0, 0}, {2, 0, 0}, {2, 1, 0.1f}, {0, 1, 0}},     // bent
        std::vector<glm::vec3>{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 1, 0}}}) {     // kite
    const Scene scene = loadBuilt(quad(corners, kGlow));
    EXPECT_TRUE(evaluate(scene, 0).lights.empty());
    EXPECT_THAT(scene.warnings, testing::ElementsAre(testing::HasSubstr("displayed but light nothing")));
  }
}

/// A turn below a scale that differs along its axes.
TEST(SceneEvaluate, EmissiveQuadsThatTheirNodesSkewLightNothingWithAWarning) {
  GltfBuilder b = quad(kQuad, kGlow, {{"rotation", {0, 0, std::sin(0.4), std::cos(0.4)}}});
  EXPECT_EQ(evaluate(loadBuilt(b), 0).lights.size(), 1u);
  EXPECT_TRUE(loadBuilt(b).warnings.empty());
  b.node({{"children", {1}}, {"scale", {1, 2, 1}}});
  EXPECT_TRUE(evaluate(loadBuilt(b), 0).lights.empty());
  EXPECT_THAT(loadBuilt(b).warnings, testing::ElementsAre(testing::HasSubstr("nodes skew")));
}

/// An animation may scale a lamp to nothing: it then gives no light, and no other light takes its number.
TEST(SceneEvaluate, LampsWithoutAreaGiveNoLightAndKeepTheirNumber) {
  for (const std::vector<float>& scale : {std::vector<float>{0, 0, 0}, {1, 0, 1}, {0, 2, 3}}) {
    GltfBuilder b = quad(kQuad, kGlow, {{"name", "panel"}, {"translation", {1, 2, 3}}, {"scale", scale}});
    const json mesh = b.root["nodes"].back()["mesh"];
    b.node({{"name", "other"}, {"mesh", mesh}});
    const Pose pose = evaluate(loadBuilt(b), 0);
    ASSERT_THAT(pose.lightNames, testing::ElementsAre("panel", "other"));
    const glsl::Light& light = pose.lights[0];
    expectNear(light.emission, glm::vec3(0));
    EXPECT_EQ(light.length_u, 0);
    EXPECT_EQ(light.length_v, 0);
    EXPECT_EQ(light.own_instance, 1u);
    for (const glm::vec3& axis :
         {glm::vec3(light.axis_u), glm::vec3(light.axis_v), glm::vec3(light.direction)})
      EXPECT_NEAR(glm::length(axis), 1, 1e-6);
    expectNear(glm::cross(light.axis_u, light.axis_v), -light.direction);
    EXPECT_EQ(pose.lights[1].index, 1u);
    expectNear(pose.lights[1].emission, {10, 5, 0});
  }
}

TEST(SceneEvaluate, Cameras) {
  GltfBuilder b;
  b.append("cameras",
           {{"type", "perspective"}, {"name", "lens"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.25}}}});
  b.append("cameras", {{"type", "orthographic"},
                       {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 1}, {"zfar", 2}}}});
  b.node({{"name", "front"}, {"camera", 0}, {"translation", {0, 0, 5}}, {"scale", {3, 3, 3}}});
  b.node({{"camera", 1}});
  b.node({{"camera", 0}});
  const Scene scene = loadBuilt(b);
  EXPECT_THAT(scene.warnings, testing::ElementsAre(testing::HasSubstr("orthographic cameras are ignored")));
  const Pose pose = evaluate(scene, 0);
  ASSERT_EQ(pose.cameras.size(), 2u);
  EXPECT_EQ(pose.cameras[0].name, "front");
  EXPECT_EQ(pose.cameras[1].name, "lens");
  EXPECT_EQ(pose.cameras[0].yfov, 0.7f);
  EXPECT_EQ(pose.cameras[0].near, 0.25f);
  expectNear(pose.cameras[0].worldToView * glm::vec4(1, 2, 0, 1), {1, 2, -5});
}

/// Programs with left-handed axes write a root that mirrors. No camera below it stands on its head, and no
/// texture that a spot shines through.
TEST(SceneEvaluate, NodesThatMirrorKeepTheirUp) {
  for (const std::vector<float>& scale : {std::vector<float>{1, 1, -1}, {-1, 1, 1}, {-2, -2, -2}}) {
    GltfBuilder b;
    b.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.25}}}});
    b.light({{"type", "spot"}, {"spot", json::object()}}, {{"camera", 0}});
    b.node({{"children", {0}}, {"scale", scale}});
    const Pose pose = evaluate(loadBuilt(b), 0);
    const glm::vec3 up(0, std::copysign(1.f, scale[1]), 0), ahead(0, 0, -std::copysign(1.f, scale[2]));
    const glm::mat3 toView(pose.cameras.at(0).worldToView);
    expectNear(toView * up, {0, 1, 0});
    expectNear(toView * ahead, {0, 0, -1});
    const glsl::Light& light = pose.lights.at(0);
    expectNear(light.axis_v, up);
    expectNear(light.direction, ahead);
    expectNear(glm::cross(light.axis_u, light.axis_v), -light.direction);
  }
}

/// The other two axes of a node say where the one without length points.
TEST(SceneEvaluate, LightsOfFlatNodesKeepTheirDirection) {
  const double s = std::sqrt(0.5);
  for (const std::vector<float>& scale : {std::vector<float>{1, 1, 0}, {0, 1, 1}, {1, 0, 1}}) {
    GltfBuilder b;
    b.light({{"type", "directional"}},
            {{"rotation", {0, s, 0, s}}, {"scale", scale}});  // 90 degrees about Y: -Z becomes -X
    const glsl::Light light = evaluate(loadBuilt(b), 0).lights.at(0);
    expectNear(light.direction, {-1, 0, 0});
    expectNear(light.axis_v, {0, 1, 0});
  }
}

}  // namespace
}  // namespace limn::test
