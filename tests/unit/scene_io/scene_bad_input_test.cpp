// Every broken file ends in one line that names the place.
#include <limits>

#include "tests/support/png.h"
#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using json = nlohmann::json;

TEST(SceneBadInput, TruncatedGlbAtEveryByte) {
  GltfBuilder b;
  b.triangle();
  const std::vector<std::byte> whole = b.glb();
  ASSERT_EQ(loadError(whole), "");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<std::byte> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    ASSERT_NE(loadError(part), "") << size << " of " << whole.size() << " bytes";
  }
}

TEST(SceneBadInput, NotGltf) {
  EXPECT_THAT(loadError(std::vector<std::byte>{}), HasSubstr("not a glTF 2.0 file"));
  EXPECT_THAT(loadError(GltfBuilder::toBytes("v 0 0 0\nf 1 1 1\n")), HasSubstr("assimp"));
  EXPECT_THAT(loadError(GltfBuilder::toBytes("{\"asset\": [}")), HasSubstr("not valid JSON"));
  EXPECT_THAT(loadError(GltfBuilder::toBytes("{\"a\":\"\xff\"}")), HasSubstr("not valid JSON"));
}

TEST(SceneBadInput, WrongVersion) {
  EXPECT_THAT(loadError(GltfBuilder::toBytes(R"({"asset":{"version":"1.0"}})")),
              AllOf(HasSubstr("version '1.0'"), HasSubstr("2.0 is accepted")));
  EXPECT_THAT(loadError(GltfBuilder::toBytes("{}")), HasSubstr("asset.version"));
  std::vector<std::byte> glb = GltfBuilder().glb();
  glb[4] = std::byte{1};
  EXPECT_THAT(loadError(glb), HasSubstr("GLB version 1"));
}

TEST(SceneBadInput, DeeplyNested) {
  const std::string deep(100'000, '[');
  EXPECT_THAT(loadError(GltfBuilder::toBytes("{\"extras\":" + deep)), HasSubstr("nested deeper"));
}

TEST(SceneBadInput, HugeVertexCountsAreNoLicenceToAllocate) {
  GltfBuilder b;
  b.triangle();
  b.root["accessors"][0]["count"] = 1'000'000'000;
  EXPECT_THAT(loadError(b.glb()), AllOf(HasSubstr("mesh 0 'm' primitive 0 POSITION (accessor 0)"),
                                        HasSubstr("1000000000 elements"), HasSubstr("do not fit")));
  b.root["accessors"][0]["count"] = std::uint64_t{1} << 62;
  EXPECT_THAT(loadError(b.glb()), HasSubstr("too large"));
}

TEST(SceneBadInput, AccessorWithoutDataIsNoLicenceToAllocate) {
  GltfBuilder b;
  b.triangle();
  b.root["accessors"][0].erase("bufferView");
  b.root["accessors"][0]["count"] = 1'000'000'000;
  EXPECT_THAT(loadError(b.glb()), HasSubstr("has no buffer view"));
  const glm::vec3 value(7, 8, 9);
  b.root["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", b.view("\x01", 1)}, {"componentType", 5121}}},
      {"values", {{"bufferView", b.view(&value, 12)}}}};
  EXPECT_THAT(loadError(b.glb()), HasSubstr("has no buffer view"));
}

TEST(SceneBadInput, VertexLimit) {
  GltfBuilder b;
  b.triangle();
  scene::LoadLimits limits;
  limits.vertices = 5;
  EXPECT_THAT(loadError(b.glb(), limits), HasSubstr("exceed the limit of 5"));
}

TEST(SceneBadInput, MorphWeightsOfAllNodesAreLimited) {
  GltfBuilder b;
  b.triangle();
  b.root["meshes"][0]["primitives"][0]["targets"] = json::array_t(3, json::object());
  for (int copy = 1; copy < 4; ++copy) b.meshNode(0);
  scene::LoadLimits limits;
  limits.instances = 12;
  EXPECT_EQ(loadError(b.glb(), limits), "");
  limits.instances = 10;
  EXPECT_THAT(loadError(b.glb(), limits), HasSubstr("12 morph weights; at most 10"));
}

/// Each copy of a rectangle with an emissive texture is many lights.
TEST(SceneBadInput, LightsOfEmissiveRectanglesAreLimited) {
  GltfBuilder b;
  const std::vector<std::byte> image = png(2, 1, {255, 255, 255, 255, 9, 9, 9, 255});
  b.append("images", {{"bufferView", b.view(image.data(), image.size())}, {"mimeType", "image/png"}});
  b.append("textures", {{"source", 0}});
  b.append("materials", {{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", 0}}}});
  const int positions = b.vec3({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  const int uvs = b.vec2({{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  b.meshNode(b.mesh({{"POSITION", positions}, {"TEXCOORD_0", uvs}}, b.indices({0, 1, 2, 0, 2, 3}), 0));
  b.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {
      {"attributes", {{"TRANSLATION", b.vec3({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}})}}}};
  const std::size_t lights = scene::evaluate(loadBuilt(b), 0).lights.size();
  ASSERT_GT(lights, 3u) << "more than there are rectangles";
  scene::LoadLimits limits;
  limits.instances = lights;
  EXPECT_EQ(loadError(b.glb(), limits), "");
  limits.instances = lights - 1;
  EXPECT_THAT(loadError(b.glb(), limits),
              HasSubstr(std::to_string(lights) + " lights of emissive rectangles"));
}

TEST(SceneBadInput, AccessorOutOfRange) {
  GltfBuilder b;
  b.triangle();
  const json root = b.root;
  b.root["accessors"][0]["byteOffset"] = 4;
  EXPECT_THAT(loadError(b.glb()), AllOf(HasSubstr("POSITION (accessor 0)"), HasSubstr("do not fit")));
  b.root = root;
  b.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 77;
  EXPECT_THAT(loadError(b.glb()),
              AllOf(HasSubstr("NORMAL"), HasSubstr("accessor 77 does not exist; there are 3")));
  b.root = root;
  b.root["accessors"][1]["bufferView"] = 9;
  EXPECT_THAT(loadError(b.glb()), HasSubstr("buffer view 9 does not exist"));
  b.root = root;
  b.root["bufferViews"][0]["byteOffset"] = 100000;
  EXPECT_THAT(loadError(b.glb()), HasSubstr("buffer view 0 covers 36 bytes from 100000"));
  b.root = root;
  b.root["bufferViews"][0]["buffer"] = 3;
  EXPECT_THAT(loadError(b.glb()), HasSubstr("buffer 3 does not exist"));
  b.root = root;
  b.root["accessors"][1]["count"] = 2;
  EXPECT_THAT(loadError(b.glb()), AllOf(HasSubstr("NORMAL"), HasSubstr("2 elements where 3 are needed")));
  b.root = root;
  b.root["accessors"][0]["componentType"] = 5124;
  EXPECT_THAT(loadError(b.glb()), HasSubstr("accessors[0].componentType is 5124; 5120, 5121,"));
  b.root = root;
  b.root["accessors"][0]["type"] = "VEC2";
  EXPECT_THAT(loadError(b.glb()), HasSubstr("2 components per element; 3 are accepted"));
}

TEST(SceneBadInput, BufferLongerThanItsData) {
  GltfBuilder b;
  b.triangle();
  b.root["buffers"] = {{{"byteLength", 1'000'000'000}}};
  EXPECT_THAT(loadError(b.glb()),
              AllOf(HasSubstr("buffer 0 declares 1000000000 bytes"), HasSubstr("are there")));
}

TEST(SceneBadInput, NotFinite) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (const char* attribute : {"POSITION", "NORMAL"}) {
      GltfBuilder b;
      b.triangle();
      b.root["meshes"][0]["primitives"][0]["attributes"][attribute] =
          b.vec3({{0, 0, 0}, {1, bad, 0}, {0, 1, 0}});
      EXPECT_THAT(loadError(b.glb()), AllOf(HasSubstr("mesh 0 'm' primitive 0"), HasSubstr(attribute),
                                            HasSubstr("element 1 is not a finite number")));
    }
  }
}

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

TEST(SceneBadInput, IndexOutOfRange) {
  GltfBuilder b;
  b.triangle();
  b.root["meshes"][0]["primitives"][0]["indices"] = b.indices({0, 1, 3});
  EXPECT_THAT(loadError(b.glb()), AllOf(HasSubstr("mesh 0 'm' primitive 0 indices (accessor 3)"),
                                        HasSubstr("index 3 at 2; there are 3")));
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

TEST(SceneBadInput, RequiredExtensions) {
  for (const char* name : {"KHR_texture_basisu", "KHR_materials_sheen"}) {
    GltfBuilder b;
    b.root["extensionsRequired"] = {name};
    EXPECT_THAT(loadError(b.glb()), AllOf(HasSubstr(name), HasSubstr("not supported")));
    b.root["extensionsUsed"] = {name};
    b.root.erase("extensionsRequired");
    EXPECT_EQ(loadError(b.glb()), "");
    EXPECT_THAT(loadBuilt(b).warnings, testing::Contains(HasSubstr("not read: " + std::string(name))));
  }
}

TEST(SceneBadInput, ExtensionsThatAreUsedAndNotReadAreNamedInOneLine) {
  GltfBuilder b;
  b.triangle();
  b.root["extensionsUsed"] = {"KHR_materials_sheen", "KHR_materials_unlit", "KHR_materials_clearcoat"};
  EXPECT_THAT(loadBuilt(b).warnings,
              testing::ElementsAre(testing::EndsWith("KHR_materials_sheen, KHR_materials_clearcoat")));
  for (int i = 0; i < 20; ++i) b.root["extensionsUsed"].push_back("VENDOR_" + std::to_string(i));
  EXPECT_THAT(loadBuilt(b).warnings, testing::ElementsAre(testing::EndsWith("VENDOR_5 and others")));
  for (const nlohmann::json& odd : {nlohmann::json(7), nlohmann::json::array({1, nullptr, {{"a", 2}}})}) {
    b.root["extensionsUsed"] = odd;
    EXPECT_THAT(loadError(b.glb()), testing::Not(HasSubstr("not read")));
  }
}

TEST(SceneBadInput, Images) {
  GltfBuilder huge;
  huge.texturedMaterial(png(100000, 100000, {1, 2, 3, 4}));
  EXPECT_THAT(loadError(huge.glb()), AllOf(HasSubstr("image 0"), HasSubstr("100000x100000")));
  GltfBuilder damaged;
  std::vector<std::byte> bytes = png(2, 2, std::vector<std::uint8_t>(16));
  bytes[50] ^= std::byte{1};
  damaged.texturedMaterial(bytes);
  EXPECT_THAT(loadBuilt(damaged).warnings, testing::Contains(HasSubstr("image 0")));
  GltfBuilder none;
  none.texturedMaterial(GltfBuilder::toBytes("GIF89a........"));
  EXPECT_THAT(loadBuilt(none).warnings, testing::Contains(HasSubstr("not a picture")));
  GltfBuilder many;
  many.texturedMaterial(png(2, 2, std::vector<std::uint8_t>(16)));
  scene::LoadLimits limits;
  limits.imageTexels = 3;
  EXPECT_THAT(loadError(many.glb(), limits), HasSubstr("2x2 texels"));
  GltfBuilder webp;  // lossless, 16384 x 4096
  webp.texturedMaterial(GltfBuilder::toBytes(
      std::string("RIFF\x16\0\0\0WEBPVP8L\x0a\0\0\0/\xff\xff\xff\x03", 25) + std::string(5, '\0')));
  EXPECT_THAT(loadError(webp.glb(), limits), AllOf(HasSubstr("image 0"), HasSubstr("16384x4096 texels")));
}

TEST(SceneBadInput, WrongTypes) {
  for (const char* list : {"accessors", "buffers", "bufferViews", "images", "materials", "meshes", "nodes",
                           "scenes", "skins", "textures", "animations", "cameras", "samplers"}) {
    for (const char* value : {"5", "[5]", "[null]", "\"x\"", "{}", "[[]]"}) {
      const std::string text = std::string(R"({"asset":{"version":"2.0"},")") + list + "\":" + value + "}";
      EXPECT_NE(loadError(GltfBuilder::toBytes(text)), "") << text;
    }
    const std::string text = std::string(R"({"asset":{"version":"2.0"},")") + list + "\":[{}]}";
    loadError(GltfBuilder::toBytes(text));  // some may be empty objects; none may crash
  }
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

TEST(SceneBadInput, SparseRanges) {
  GltfBuilder b;
  b.triangle();
  const glm::vec3 value(0);
  json& sparse = b.root["accessors"][0]["sparse"];
  sparse = {{"count", 1},
            {"indices", {{"bufferView", b.view("\x09", 1)}, {"componentType", 5121}}},
            {"values", {{"bufferView", b.view(&value, 12)}}}};
  EXPECT_THAT(loadError(b.glb()), HasSubstr("sparse index 9 of 3 elements"));
  b.root["accessors"][0]["sparse"]["count"] = 2;
  EXPECT_THAT(loadError(b.glb()), HasSubstr("sparse data of 2 bytes"));
  b.root["accessors"][0]["sparse"]["count"] = 1'000'000;
  EXPECT_THAT(loadError(b.glb()), HasSubstr("1000000 sparse elements for 3 elements"));
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

TEST(SceneBadInput, MessagesStayOnOneLine) {
  GltfBuilder b;
  b.triangle();
  b.root["meshes"][0]["name"] = "two\nlines";
  b.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 50;
  EXPECT_THAT(loadError(b.glb()), HasSubstr("two?lines"));
}

/// What is read of the document afterwards is to be UTF-8 still.
TEST(SceneBadInput, LongNamesAreCutBetweenCharacters) {
  std::string name = "a";
  while (name.size() < 1000) name += "\xc3\xa9";
  GltfBuilder b;
  b.triangle(b.append("materials", {{"name", name}}));
  EXPECT_EQ(loadBuilt(b).materials[0].name, name.substr(0, 599) + "...");
}

TEST(SceneBadInput, NamesStayOnOneLine) {
  const std::string name = "two\nlines\x1b[2J";
  GltfBuilder b;
  b.triangle(b.append("materials", {{"name", name}}));
  b.root["meshes"][0]["name"] = b.root["nodes"][0]["name"] = name;
  b.light({{"type", "point"}, {"name", name}});
  b.append("cameras",
           {{"type", "perspective"}, {"name", name}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
  b.append("animations", {{"name", name}, {"samplers", json::array()}, {"channels", json::array()}});
  const scene::Scene loaded = loadBuilt(b);
  ASSERT_EQ(loaded.animations.size(), 1u);
  for (const std::string& shown : {loaded.materials[0].name, loaded.meshes[0].name, loaded.nodes[0].name,
                                   loaded.lights[0].name, loaded.cameras[0].name, loaded.animations[0].name})
    EXPECT_EQ(shown, "two?lines?[2J");
}

}  // namespace
}  // namespace limn::test
