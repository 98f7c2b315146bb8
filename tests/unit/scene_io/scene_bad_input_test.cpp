// Every broken file ends in one line that names the place: documents, accessors, pictures and limits.
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

TEST(SceneBadInput, IndexOutOfRange) {
  GltfBuilder b;
  b.triangle();
  b.root["meshes"][0]["primitives"][0]["indices"] = b.indices({0, 1, 3});
  EXPECT_THAT(loadError(b.glb()), AllOf(HasSubstr("mesh 0 'm' primitive 0 indices (accessor 3)"),
                                        HasSubstr("index 3 at 2; there are 3")));
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

/// A decoder may take as long for them as for sound ones.
TEST(SceneBadInput, DamagedImagesCountWithTheSizeThatTheyState) {
  std::vector<std::byte> damaged = png(2, 2, std::vector<std::uint8_t>(16));
  damaged[50] ^= std::byte{1};
  GltfBuilder b;
  for (int i = 0; i < 3; ++i) b.texturedMaterial(damaged);
  scene::LoadLimits limits;
  limits.imageTexels = 12;
  EXPECT_EQ(loadError(b.glb(), limits), "");
  limits.imageTexels = 11;
  EXPECT_THAT(loadError(b.glb(), limits), HasSubstr("image 2: 2x2 texels"));
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
