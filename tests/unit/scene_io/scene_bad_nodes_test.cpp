// Nodes, skins, animations, lights and extras that are broken end in one line that names the place.
#include <utility>
#include <vector>

#include "tests/support/png.h"
#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using json = nlohmann::json;

TEST(SceneBadInput, NotFiniteTransforms) {
  GltfBuilder b;
  b.node({{"translation", {1e300, 0, 0}}});
  EXPECT_THAT(loadError(b.glb()), AllOf(HasSubstr("node 0 translation"), HasSubstr("not a finite number")));
  GltfBuilder c;
  c.node({{"rotation", {0, 0, 0, 0}}});
  EXPECT_THAT(loadError(c.glb()), HasSubstr("node 0 rotation is not a rotation"));
  GltfBuilder d;
  d.triangle();
  d.root["nodes"][0]["scale"] = {3e38, 3e38, 3e38};
  d.node({{"children", {0}}, {"scale", {3e38, 3e38, 3e38}}});
  EXPECT_THAT(loadError(d.glb()), HasSubstr("extent is not a finite number"));
  GltfBuilder e;
  e.light({{"type", "point"}}, {{"name", "lamp"}, {"translation", {0, 0, 100}}});
  e.node({{"children", {0}}, {"scale", {1, 1, 3e38}}});
  EXPECT_THAT(loadError(e.glb()), HasSubstr("the place of light 'lamp' is not finite"));
  GltfBuilder f;
  f.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
  f.node({{"name", "eye"}, {"camera", 0}, {"translation", {100, 0, 0}}});
  f.node({{"children", {0}}, {"scale", {3e38, 1, 1}}});
  EXPECT_THAT(loadError(f.glb()), HasSubstr("the place of camera 'eye' is not finite"));
  // Flat triangles, whose depth of 0 hides the infinite scale from their bounds.
  for (const bool skin : {false, true}) {
    GltfBuilder g;
    g.triangle();
    if (skin) {
      const int mesh =
          g.mesh({{"POSITION", g.vec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})},
                  {"JOINTS_0", g.accessor(std::vector<glm::u8vec4>(3), GltfBuilder::kUbyte, "VEC4")},
                  {"WEIGHTS_0", g.vec4(std::vector<glm::vec4>(3, glm::vec4(1, 0, 0, 0)))}});
      g.append("skins", {{"joints", {1}}});
      g.node({{"scale", {1, 1, 3e38}}});
      g.node({{"children", {1}}, {"scale", {1, 1, 3e38}}});
      g.node({{"mesh", mesh}, {"skin", 0}});
    } else {
      g.node({{"mesh", 0}, {"scale", {1, 1, 3e38}}});
      g.node({{"children", {1}}, {"scale", {1, 1, 3e38}}});
    }
    EXPECT_THAT(loadError(g.glb()), HasSubstr("extent is not a finite number")) << skin;
  }
}

/// Numbers each of which is accepted, and of which something is made that is none.
TEST(SceneBadInput, NotFiniteLight) {
  const auto lit = [](json source, json node) {
    GltfBuilder b;
    b.light(std::move(source), std::move(node));
    return loadError(b.glb());
  };
  EXPECT_THAT(lit({{"type", "point"}, {"intensity", 1e30}, {"color", {0, 1e30, 0}}}, json::object()),
              AllOf(HasSubstr("light 0 color * intensity"), HasSubstr("not a finite number")));
  for (const double side : {1e-20, 1e-30})  // the area of the second is 0 in single precision
    EXPECT_THAT(lit({{"type", "point"}, {"intensity", 1e9}}, {{"extras", {{"limn_area", {side, side}}}}}),
                AllOf(HasSubstr("node 0 limn_area: intensity / area"), HasSubstr("not a finite number")));
  GltfBuilder material;
  material.append("materials",
                  {{"emissiveFactor", {1e20, 1, 1}},
                   {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1e20}}}}}});
  EXPECT_THAT(loadError(material.glb()), AllOf(HasSubstr("material 0 emissiveFactor * emissiveStrength"),
                                               HasSubstr("not a finite number")));
  GltfBuilder medium;
  medium.append("scenes", {{"extras", {{"limn_medium", {{"sigma_a", 3e38}, {"sigma_s", 3e38}}}}}});
  EXPECT_THAT(loadError(medium.glb()),
              AllOf(HasSubstr("limn_medium sigma_a + sigma_s"), HasSubstr("not a finite number")));
}

TEST(SceneBadInput, NodeGraph) {
  GltfBuilder cycle;
  cycle.node({{"name", "a"}, {"children", {1}}});
  cycle.node({{"name", "b"}, {"children", {0}}});
  EXPECT_THAT(loadError(cycle.glb()), AllOf(HasSubstr("cycle"), HasSubstr("node 0 'a'")));
  GltfBuilder self;
  self.node({{"children", {0}}});
  EXPECT_THAT(loadError(self.glb()), HasSubstr("cycle"));
  GltfBuilder parents;
  parents.node({{"children", {2}}});
  parents.node({{"children", {2}}});
  parents.node(json::object());
  EXPECT_THAT(loadError(parents.glb()), HasSubstr("node 2 has two parents, 0 and 1"));
  GltfBuilder child;
  child.node({{"children", {5}}});
  EXPECT_THAT(loadError(child.glb()), HasSubstr("child 5 does not exist; there are 1"));
}

TEST(SceneBadInput, LongChainOfNodesNeedsNoRecursion) {
  GltfBuilder b;
  for (int i = 0; i < 50'000; ++i) b.node(i == 0 ? json::object() : json{{"children", {i - 1}}});
  EXPECT_EQ(loadError(b.glb()), "");
}

TEST(SceneBadInput, References) {
  const std::pair<json, const char*> nodes[] = {
      {{{"mesh", 4}}, "node 0: mesh 4 does not exist; there are 0"},
      {{{"skin", 4}}, "node 0: skin 4 does not exist"},
      {{{"camera", 4}}, "node 0: camera 4 does not exist"},
      {{{"mesh", -7}}, "nodes[0].mesh is -7; a whole number in 0 .. "},
      {{{"extensions", {{"KHR_lights_punctual", {{"light", 4}}}}}}, "node 0: light 4 does not exist"}};
  for (const auto& [node, message] : nodes) {
    GltfBuilder b;
    b.node(node);
    EXPECT_THAT(loadError(b.glb()), HasSubstr(message));
  }
  GltfBuilder light;
  light.light({{"type", "directional"}}, {{"extras", {{"limn_angle", 0.1}}}});
  light.node({{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  EXPECT_THAT(loadError(light.glb()), HasSubstr("node 1: light 1 does not exist; there are 1"))
      << "a node's own angle adds none";
  GltfBuilder material;
  material.triangle(6);
  EXPECT_THAT(loadError(material.glb()), HasSubstr("material 6 does not exist; there are 0"));
  GltfBuilder texture;
  texture.append("materials", {{"normalTexture", {{"index", 3}}}});
  EXPECT_THAT(loadError(texture.glb()), HasSubstr("texture 3 does not exist"));
  GltfBuilder scenes;
  scenes.append("scenes", {{"nodes", {8}}});
  EXPECT_THAT(loadError(scenes.glb()), HasSubstr("node 8 does not exist"));
  scenes.root["scene"] = 5;
  EXPECT_THAT(loadError(scenes.glb()), HasSubstr("scene 5 does not exist"));
}

TEST(SceneBadInput, SkinsAndAnimations) {
  GltfBuilder b;
  b.node(json::object());
  b.append("skins", {{"joints", {0, 9}}});
  EXPECT_THAT(loadError(b.glb()), HasSubstr("skin 0: joint node 9 does not exist"));
  GltfBuilder few;
  few.node(json::object());
  const int bind = few.accessor(std::vector<glm::mat4>(1, glm::mat4(1)), GltfBuilder::kFloat, "MAT4");
  few.append("skins", {{"joints", {0, 0}}, {"inverseBindMatrices", bind}});
  EXPECT_THAT(loadError(few.glb()), HasSubstr("1 inverse bind matrices for 2 joints"));
  GltfBuilder times;
  times.node(json::object());
  const int input = times.floats({0, 1, 1}), output = times.vec3(std::vector<glm::vec3>(3));
  times.append("animations",
               {{"samplers", {{{"input", input}, {"output", output}}}},
                {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}});
  EXPECT_THAT(loadError(times.glb()), HasSubstr("key times must increase; 1 follows 1"));
  times.root["animations"][0]["channels"][0]["sampler"] = 4;
  EXPECT_THAT(loadError(times.glb()), HasSubstr("sampler 4 does not exist"));
}

TEST(SceneBadInput, JointOutsideTheSkin) {
  GltfBuilder b;
  const int mesh = b.mesh({{"POSITION", b.vec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})},
                           {"JOINTS_0", b.accessor(std::vector<glm::u8vec4>(3, glm::u8vec4(2, 0, 0, 0)),
                                                   GltfBuilder::kUbyte, "VEC4")},
                           {"WEIGHTS_0", b.vec4(std::vector<glm::vec4>(3, glm::vec4(1, 0, 0, 0)))}});
  b.node({{"mesh", mesh}, {"skin", 0}});
  b.append("skins", {{"joints", {0}}});
  EXPECT_THAT(loadError(b.glb()), HasSubstr("names joint 2; skin 0 has 1"));
}

TEST(SceneBadInput, BoundsOfJointsThatNoVertexNamesTakeNoMemory) {
  GltfBuilder b;
  b.meshNode(b.mesh({{"POSITION", b.vec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})},
                     {"JOINTS_0", b.accessor(std::vector<glm::u16vec4>(3, glm::u16vec4(65535, 7, 0, 0)),
                                             GltfBuilder::kUshort, "VEC4")},
                     {"WEIGHTS_0", b.vec4(std::vector<glm::vec4>(3, glm::vec4(0.5f, 0.5f, 0, 0)))}}));
  const scene::Primitive primitive = scene::loadMemory(b.glb()).meshes[0].primitives[0];
  EXPECT_THAT(primitive.jointBounds, testing::ElementsAre(testing::Pair(7, primitive.bounds),
                                                          testing::Pair(65535, primitive.bounds)));
}

TEST(SceneBadInput, JointsWhoseWeightVanishesNeedNotExist) {
  GltfBuilder b;
  const glm::vec4 tiny(1e-45f, 3e38f, 0, 0);
  const int mesh = b.mesh({{"POSITION", b.vec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})},
                           {"JOINTS_0", b.accessor(std::vector<glm::u8vec4>(3, glm::u8vec4(9, 0, 9, 9)),
                                                   GltfBuilder::kUbyte, "VEC4")},
                           {"WEIGHTS_0", b.vec4(std::vector<glm::vec4>(3, tiny))}});
  b.node({{"mesh", mesh}, {"skin", 0}});
  b.append("skins", {{"joints", {0}}});
  const scene::Scene loaded = scene::loadMemory(b.glb());
  for (const glm::u16vec4& joints : loaded.meshes[0].primitives[0].joints) EXPECT_EQ(joints, glm::u16vec4(0));
}

TEST(SceneBadInput, Extras) {
  GltfBuilder area;
  area.light({{"type", "point"}}, {{"extras", {{"limn_area", {0, 1}}}}});
  EXPECT_THAT(loadError(area.glb()), AllOf(HasSubstr("limn_area"), HasSubstr("two positive lengths")));
  GltfBuilder medium;
  medium.append("scenes", {{"extras", {{"limn_medium", {{"sigma_s", -1}}}}}});
  EXPECT_THAT(loadError(medium.glb()), HasSubstr("must not be negative"));
  medium.root["scenes"][0]["extras"]["limn_medium"] = {{"g", 1.5}};
  EXPECT_THAT(loadError(medium.glb()), HasSubstr("limn_medium g: 1.5"));
  auto& smoke = medium.root["scenes"][0]["extras"]["limn_medium"] = {{"sigma_s", 1}, {"smoke", 3}};
  EXPECT_THAT(loadError(medium.glb()), HasSubstr("smoke: an object {low, high,"));
  smoke["smoke"] = {{"low", {0, 0, 0}}, {"high", {1, 0, 1}}};
  EXPECT_THAT(loadError(medium.glb()), HasSubstr("each number of high is larger"));
  for (const double side : {1e-30, 1e30}) {
    smoke["smoke"] = {{"low", {0, 0, 0}}, {"high", {side, side, side}}};
    EXPECT_THAT(loadError(medium.glb()), HasSubstr("each number of high is larger")) << side;
  }
  smoke["smoke"] = {{"low", {0, 0, 0}}};
  EXPECT_THAT(loadError(medium.glb()), HasSubstr("smoke high: 3 numbers are accepted"));
  smoke["smoke"] = {{"low", {0, 0, 0}}, {"high", {1, 1, 1}}, {"rise", "fast"}};
  EXPECT_THAT(loadError(medium.glb()), HasSubstr("smoke rise: a number is accepted"));
  smoke["grid"] = "cloud.vdb";
  EXPECT_THAT(loadError(medium.glb()), HasSubstr("both a grid and smoke"));
  GltfBuilder texture;
  texture.light({{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}, {"extras", {{"limn_texture", 2}}}});
  EXPECT_THAT(loadError(texture.glb()), HasSubstr("limn_texture: the index of one of the 0 textures"));
  texture.texturedMaterial(png(1, 1, {1, 2, 3, 4}));
  texture.root["extensions"]["KHR_lights_punctual"]["lights"][0]["extras"]["limn_texture"] = 0.5;
  EXPECT_THAT(loadError(texture.glb()), HasSubstr("limn_texture: the index of one of the 1 textures"));
  GltfBuilder light;
  light.light({{"type", "disk"}});
  EXPECT_THAT(loadError(light.glb()), HasSubstr("type is \"disk\"; point, spot or directional is accepted"));
  GltfBuilder camera;
  camera.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 4}, {"znear", 0.1}}}});
  EXPECT_THAT(loadError(camera.glb()), HasSubstr("yfov 4 rad"));
}

}  // namespace
}  // namespace limn::test
