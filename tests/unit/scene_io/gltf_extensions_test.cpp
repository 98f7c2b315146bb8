// glTF extensions that change what a file holds: compressed buffers, and materials of other models.
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "glsl/numeric/srgb.glsl"
#include "tests/support/paths.h"
#include "tests/support/png.h"
#include "tests/support/scene_files.h"
#include "tests/support/webp.h"

namespace limn::test {
namespace {

using json = nlohmann::json;
using scene::Material;
using scene::Primitive;
using scene::Scene;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const Primitive& firstPrimitive(const Scene& s) {
  return s.meshes.at(0).primitives.at(0);
}

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

/// Compresses the view of an accessor; the plain bytes stay where they are, and nothing points at them.
json& compress(GltfBuilder& b, int accessor, const std::vector<unsigned char>& bytes, std::size_t count,
               std::size_t stride, const char* mode, const char* filter = nullptr) {
  const int view = b.view(bytes.data(), bytes.size());
  const json source = b.root["bufferViews"][at(view)];
  json extension = {{"buffer", source["buffer"]},
                    {"byteOffset", source["byteOffset"]},
                    {"byteLength", bytes.size()},
                    {"byteStride", stride},
                    {"count", count},
                    {"mode", mode}};
  if (filter != nullptr) extension["filter"] = filter;
  json& plain = b.root["bufferViews"][b.root["accessors"][at(accessor)]["bufferView"].get<std::size_t>()];
  plain["byteLength"] = count * stride;
  plain["extensions"]["EXT_meshopt_compression"] = extension;
  return plain;
}

template <class T>
std::vector<unsigned char> encodedVertices(const std::vector<T>& values) {
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(values.size(), sizeof(T)));
  bytes.resize(
      meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values.data(), values.size(), sizeof(T)));
  return bytes;
}

const std::vector<glm::vec3> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.25f}};
const std::vector<std::uint32_t> kCornerIndices{0, 1, 2, 2, 1, 3};

/// Two triangles whose positions and indices are compressed.
GltfBuilder compressedQuad(const char* mode = "TRIANGLES") {
  GltfBuilder b;
  const int positions = b.vec3(kCorners), indices = b.indices(kCornerIndices);
  b.meshNode(b.mesh({{"POSITION", positions}}, indices));
  compress(b, positions, encodedVertices(kCorners), kCorners.size(), sizeof(glm::vec3), "ATTRIBUTES");
  const bool triangles = std::string(mode) == "TRIANGLES";
  std::vector<unsigned char> bytes(
      triangles ? meshopt_encodeIndexBufferBound(kCornerIndices.size(), kCorners.size())
                : meshopt_encodeIndexSequenceBound(kCornerIndices.size(), kCorners.size()));
  bytes.resize(triangles ? meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), kCornerIndices.data(),
                                                     kCornerIndices.size())
                         : meshopt_encodeIndexSequence(bytes.data(), bytes.size(), kCornerIndices.data(),
                                                       kCornerIndices.size()));
  compress(b, indices, bytes, kCornerIndices.size(), 4, mode);
  b.root["extensionsRequired"] = {"EXT_meshopt_compression"};
  return b;
}

TEST(MeshoptCompression, GivesBackWhatWasCompressed) {
  for (const char* mode : {"TRIANGLES", "INDICES"}) {
    const Scene scene = loadBuilt(compressedQuad(mode));
    EXPECT_EQ(scene.triangles(), 2u) << mode;
    // Without normals the triangles are split: six vertices, in the order of the indices but for its
    // rotation.
    const Primitive& p = firstPrimitive(scene);
    ASSERT_EQ(p.positions.size(), 6u) << mode;
    for (const glm::vec3& corner : kCorners) EXPECT_THAT(p.positions, Contains(corner)) << mode;
    EXPECT_TRUE(scene.warnings.empty());
  }
}

TEST(MeshoptCompression, FiltersAreUndone) {
  GltfBuilder b;
  const std::vector<glm::vec3> normals{{0, 0, 1}, {0.6f, 0, 0.8f}, {0, -0.6f, 0.8f}};
  const int positions = b.vec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  std::vector<glm::vec4> wide;
  for (const glm::vec3& n : normals) wide.emplace_back(n, 0);
  std::vector<glm::i8vec4> octahedral(3);
  meshopt_encodeFilterOct(octahedral.data(), 3, 4, 8, &wide[0].x);
  const int normal = b.accessor(octahedral, GltfBuilder::kByte, "VEC3");
  b.root["accessors"][at(normal)]["normalized"] = true;
  b.meshNode(b.mesh({{"POSITION", positions}, {"NORMAL", normal}}));
  compress(b, normal, encodedVertices(octahedral), 3, 4, "ATTRIBUTES", "OCTAHEDRAL")["byteStride"] = 4;
  std::vector<glm::vec3> places{{0, 0, 0}, {1.5f, 0, 0}, {0, 1024, 0}};
  std::vector<glm::uvec3> exponential(3);
  meshopt_encodeFilterExp(exponential.data(), 3, 12, 15, &places[0].x);
  compress(b, positions, encodedVertices(exponential), 3, 12, "ATTRIBUTES", "EXPONENTIAL");
  const Primitive p = firstPrimitive(loadBuilt(b));
  for (std::size_t i = 0; i < 3; ++i) {
    expectNear(p.normals[i], normals[i], 0.02f);
    expectNear(p.positions[i], places[i], 0.05f);
  }
}

/// A buffer that stands for what is decoded has no bytes of its own.
TEST(MeshoptCompression, FallbackBuffersNeedNoBytes) {
  GltfBuilder b = compressedQuad();
  std::size_t bytes = 0;
  for (json& view : b.root["bufferViews"])
    bytes = std::max(bytes, view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>());
  b.root["buffers"] = {
      {{"byteLength", bytes}},
      {{"byteLength", 1000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  for (json& view : b.root["bufferViews"])
    if (view.contains("extensions")) view["buffer"] = 1;
  EXPECT_EQ(loadBuilt(b).triangles(), 2u);
  // Without the extension such a view has nothing to show.
  for (json& view : b.root["bufferViews"]) view.erase("extensions");
  EXPECT_THAT(loadError(b.glb()), HasSubstr("buffer 1 has 0"));
}

TEST(MeshoptCompression, RefusesWhatDoesNotFit) {
  const auto refusal = [](const char* key, const json& value, std::size_t view = 0) {
    GltfBuilder b = compressedQuad();
    b.root["bufferViews"][view]["extensions"]["EXT_meshopt_compression"][key] = value;
    return loadError(b.glb());
  };
  const std::string place = "buffer view 0 EXT_meshopt_compression";
  EXPECT_THAT(refusal("buffer", 7), HasSubstr(place + ": buffer 7 does not exist"));
  EXPECT_THAT(refusal("byteLength", 1 << 20), HasSubstr(place + " covers 1048576 bytes"));
  EXPECT_THAT(refusal("byteStride", 10), HasSubstr("byteStride 10 with mode ATTRIBUTES; a multiple of 4"));
  EXPECT_THAT(refusal("byteStride", 512), HasSubstr("byteStride is 512; a whole number in 1 .. 256"));
  EXPECT_THAT(refusal("count", 5), HasSubstr("5 elements of 12 bytes; the view has 48 bytes"));
  EXPECT_THAT(refusal("count", 100'000'000), HasSubstr("cannot hold 100000000 elements"));
  EXPECT_THAT(refusal("count", std::int64_t{9'000'000'000'000'000}), HasSubstr("exceed the limit"));
  EXPECT_THAT(refusal("mode", "POINTS"), HasSubstr("mode is \"POINTS\"; ATTRIBUTES, TRIANGLES or INDICES"));
  EXPECT_THAT(refusal("filter", "QUATERNION"), HasSubstr("byteStride 12 with filter QUATERNION; 8"));
  EXPECT_THAT(refusal("filter", "OCTAHEDRAL"), HasSubstr("4 or 8"));
  EXPECT_THAT(refusal("mode", "TRIANGLES"), HasSubstr("byteStride 12 with mode TRIANGLES; 2 or 4"));
  EXPECT_THAT(refusal("filter", "EXPONENTIAL", 1), HasSubstr("filters are for ATTRIBUTES"));
  EXPECT_THAT(refusal("count", 4, 1), HasSubstr("a multiple of 3"));
  EXPECT_THAT(refusal("byteLength", 20), HasSubstr("cannot be decoded"));
}

TEST(UnlitMaterials, ShowTheirBaseColourAndLightNothing) {
  GltfBuilder b;
  const int material = b.texturedMaterial(png(1, 1, {10, 20, 30, 40}));
  b.root["materials"][0].update({{"extensions", {{"KHR_materials_unlit", json::object()}}},
                                 {"alphaMode", "MASK"},
                                 {"doubleSided", true}});
  b.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.25, 1, 0.75};
  // A rectangle, which would be a light if it emitted.
  const int positions = b.vec3({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  const int normals = b.vec3(std::vector<glm::vec3>(4, glm::vec3(0, 0, 1)));
  const int uvs = b.vec2({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  b.meshNode(b.mesh({{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}},
                    b.indices({0, 1, 2, 0, 2, 3}), material));
  b.root["extensionsRequired"] = {"KHR_materials_unlit"};
  const Scene scene = loadBuilt(b);
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.emission, glm::vec3(0.5f, 0.25f, 1));
  EXPECT_EQ(m.baseColour, glm::vec4(0, 0, 0, 0.75f));
  EXPECT_EQ(m.emissiveTexture.image, m.baseColourTexture.image);
  EXPECT_GE(m.emissiveTexture.image, 0);
  EXPECT_TRUE(m.lambertian()) << "nothing is mirrored";
  EXPECT_EQ(m.alphaCutoff, 0.5f);
  EXPECT_TRUE(m.doubleSided);
  EXPECT_TRUE(evaluate(scene, 0).lights.empty());
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(UnlitMaterials, SayWhatTheyLeaveOut) {
  GltfBuilder b;
  b.append("materials", {{"extensions",
                          {{"KHR_materials_unlit", json::object()},
                           {"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
  b.triangle(0);
  EXPECT_THAT(loadBuilt(b).warnings, ElementsAre(HasSubstr("KHR_materials_unlit")));
}

TEST(UnlitMaterials, AreTintedByVertexColours) {
  GltfBuilder b;
  b.append("materials", {{"extensions", {{"KHR_materials_unlit", json::object()}}}});
  b.append("materials", {{"emissiveFactor", {1, 1, 1}}});
  const std::vector<glm::vec3> colours{{1, 0.5f, 0}, {0, 1, 0.5f}, {0.5f, 0, 1}};
  for (const int material : {0, 1}) {
    b.triangle(material);
    b.root["meshes"].back()["primitives"][0]["attributes"]["COLOR_0"] = b.vec3(colours);
  }
  const Scene scene = loadBuilt(b);
  EXPECT_TRUE(scene.materials.at(0).unlit);
  EXPECT_FALSE(scene.materials.at(1).unlit) << "colours are a factor on the base colour alone";
  expectNear(glm::vec3(firstPrimitive(scene).colours.at(0)), colours[0]);
}

/// A material of that KHR_materials_specular colour and index, and what other extensions say.
Scene withSpecularColour(const json& colour, double ior, json extensions = json::object()) {
  GltfBuilder b;
  extensions["KHR_materials_specular"]["specularColorFactor"] = colour;
  extensions["KHR_materials_ior"]["ior"] = ior;
  b.triangle(b.append("materials", {{"extensions", extensions}}));
  return loadBuilt(b);
}

/// At normal incidence a surface reflects min(((n - 1) / (n + 1))^2 colour, 1), says the extension; both
/// renderers hold colours up to 1.
TEST(SpecularColours, AboveOneReflectAsMuchByAHigherIndex) {
  const std::pair<glm::vec3, glm::vec3> cases[] = {{{2, 1, 0.5f}, {0.08f, 0.04f, 0.02f}},
                                                   {{0, 30, 10}, {0, 1, 0.4f}}};
  for (const auto& [colour, reflected] : cases) {
    const Scene scene = withSpecularColour(json::array({colour.x, colour.y, colour.z}), 1.5);
    const Material& m = scene.materials.at(0);
    for (int c = 0; c < 3; ++c) EXPECT_LE(m.specularColour[c], 1);
    const float ratio = (m.ior - 1) / (m.ior + 1);
    expectNear(ratio * ratio * m.specularColour, reflected, reflected.y == 1 ? 0.005f : 1e-6f);
    EXPECT_TRUE(scene.warnings.empty());
  }
  const Material none = withSpecularColour(json::array({5, 1, 1}), 1).materials.at(0);
  EXPECT_EQ(none.ior, 1) << "reflects nothing";
  EXPECT_EQ(none.specularColour, glm::vec3(1));
}

TEST(SpecularColours, AboveOneAreClampedWithAWarningWhereLightIsRefracted) {
  const Scene glass = withSpecularColour(json::array({2, 1, 0.5}), 1.5,
                                         {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}});
  EXPECT_EQ(glass.materials.at(0).ior, 1.5f) << "light is refracted by it";
  EXPECT_EQ(glass.materials.at(0).specularColour, glm::vec3(1, 1, 0.5f));
  EXPECT_THAT(glass.warnings, ElementsAre(HasSubstr("material 0: specularColorFactor 2 is clamped to 1")));
}

TEST(ExtensionColours, OutOfRangeAreClampedWithAWarning) {
  const Scene scene = withSpecularColour(json::array({-1, 1, 1}), 1.5,
                                         {{"KHR_materials_volume", {{"attenuationColor", {2, 0.5, 0.25}}}}});
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.specularColour, glm::vec3(0, 1, 1));
  EXPECT_EQ(m.attenuationColour, glm::vec3(1, 0.5f, 0.25f));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("material 0 specularColorFactor: -1 is clamped to 0"),
                                          HasSubstr("material 0 attenuationColor: 2 is clamped to 1")));
}

/// Something that is left out, as a JSON patch of a file, and what is said of it; null: nothing.
struct LeftOut {
  const char* name;
  const char* patch;
  const char* warning;
};

class LeftOutOfFiles : public testing::TestWithParam<LeftOut> {};

TEST_P(LeftOutOfFiles, IsSaidAndTakesNothingElseWithIt) {
  GltfBuilder b;
  const int times = b.floats({0, 1}), places = b.vec3({{0, 0, 0}, {1, 0, 0}});
  b.triangle(b.texturedMaterial(png(1, 1, {10, 20, 30, 255})));
  b.root["materials"][0]["extensions"] = json::object();
  b.append("animations",
           {{"samplers", {{{"input", times}, {"output", places}}}},
            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
  b.root = b.root.patch(json::parse(GetParam().patch));
  const Scene scene = loadBuilt(b);
  if (GetParam().warning == nullptr) {
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
  } else {
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr(GetParam().warning)));
  }
  EXPECT_EQ(scene.triangles(), 1u);
  EXPECT_EQ(scene.images.size(), 1u) << "of the base colour alone";
  EXPECT_EQ(scene.animations.at(0).channels.size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(
    Gltf, LeftOutOfFiles,
    testing::Values(LeftOut{"SpecularTexture",
                            R"([{"op": "add", "path": "/materials/0/extensions/KHR_materials_specular",
                     "value": {"specularTexture": {"index": 0}}}])",
                            "material 0: textures of KHR_materials_specular are ignored"},
                    LeftOut{"SpecularColourTexture",
                            R"([{"op": "add", "path": "/materials/0/extensions/KHR_materials_specular",
                     "value": {"specularColorTexture": {"index": 0}}}])",
                            "material 0: textures of KHR_materials_specular are ignored"},
                    LeftOut{"TransmissionTexture",
                            R"([{"op": "add", "path": "/materials/0/extensions/KHR_materials_transmission",
                     "value": {"transmissionFactor": 0.5, "transmissionTexture": {"index": 0}}}])",
                            "material 0: the transmission texture is ignored"},
                    LeftOut{"ThicknessTexture",
                            R"([{"op": "add", "path": "/materials/0/extensions/KHR_materials_volume",
                     "value": {"thicknessFactor": 0.5, "thicknessTexture": {"index": 0}}}])",
                            "material 0: the thickness texture is ignored"},
                    LeftOut{
                        "OcclusionTexture",
                        R"([{"op": "add", "path": "/materials/0/occlusionTexture", "value": {"index": 0}}])",
                        nullptr},
                    LeftOut{"AnimationPointer",
                            R"([{"op": "add", "path": "/extensionsUsed", "value": ["KHR_animation_pointer"]},
                    {"op": "add", "path": "/animations/0/channels/-",
                     "value": {"sampler": 0, "target": {"path": "pointer", "extensions":
                       {"KHR_animation_pointer": {"pointer": "/nodes/0/scale"}}}}}])",
                            "what these extensions add is not read: KHR_animation_pointer"}),
    [](const auto& made) { return made.param.name; });

/// A material whose texture is one in WebP, `webp`, and, where `other` is not empty, one for programs that
/// read none.
GltfBuilder webpMaterial(const std::vector<std::byte>& webp, const std::vector<std::byte>& other = {}) {
  GltfBuilder b;
  json texture = {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
  b.append("images", {{"bufferView", b.view(webp.data(), webp.size())}, {"mimeType", "image/webp"}});
  if (!other.empty()) {
    b.append("images", {{"bufferView", b.view(other.data(), other.size())}, {"mimeType", "image/png"}});
    texture["source"] = 1;
  }
  b.append("textures", std::move(texture));
  b.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  return b;
}

TEST(WebpTextures, AreReadAsTheyAreStored) {
  const std::vector<std::uint8_t> rgba = {200, 100, 50, 3, 1, 2, 3, 255};
  GltfBuilder b = webpMaterial(losslessWebp(2, 1, rgba));
  b.root["extensionsRequired"] = {"EXT_texture_webp"};
  const Scene scene = loadBuilt(b);
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(scene.images.at(at(m.baseColourTexture.image)).levels[0].rgba, rgba);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(WebpTextures, AreReadFromDataUris) {
  GltfBuilder b = webpMaterial(losslessWebp(1, 1, {1, 2, 3, 4}));
  b.root["images"][0] = {
      {"uri", "data:image/webp;base64,UklGRh4AAABXRUJQVlA4TBEAAAAvAAAAEAdQiirUoyiBiOh/AAA="}};
  const Scene scene = loadBuilt(b);
  EXPECT_TRUE(scene.warnings.empty());
  const int image = scene.materials.at(0).baseColourTexture.image;
  ASSERT_NE(image, scene::kNone);
  EXPECT_THAT(scene.images.at(at(image)).levels[0].rgba, ElementsAre(10, 20, 30, 40));
  b.root["images"][0]["uri"] = "data:image/webp,RIFF";
  EXPECT_THAT(loadBuilt(b).warnings,
              ElementsAre(AllOf(HasSubstr("the data URI cannot be decoded"), HasSubstr("goes without it"))));
}

TEST(WebpTextures, OthersStandInWhereTheyCannotBeRead) {
  const std::vector<std::byte> webp = losslessWebp(1, 1, {10, 20, 30, 40}),
                               other = png(1, 1, {50, 60, 70, 80});
  const auto shown = [](const Scene& scene) {
    return scene.images.at(at(scene.materials.at(0).baseColourTexture.image)).levels[0].rgba;
  };
  EXPECT_THAT(shown(loadBuilt(webpMaterial(webp, other))), ElementsAre(10, 20, 30, 40))
      << "WebP is preferred";
  std::vector<std::byte> damaged = webp;
  damaged.resize(20);
  const Scene scene = loadBuilt(webpMaterial(damaged, other));
  EXPECT_THAT(shown(scene), ElementsAre(50, 60, 70, 80));
  EXPECT_THAT(scene.warnings,
              ElementsAre(AllOf(HasSubstr("truncated or damaged WebP"), HasSubstr("takes its other image"))));
  const Scene none = loadBuilt(webpMaterial(damaged));
  EXPECT_EQ(none.materials.at(0).baseColourTexture.image, scene::kNone);
  EXPECT_THAT(none.warnings, ElementsAre(HasSubstr("goes without it")));
}

TEST(WebpTextures, OtherFormatsWithoutAnImageToFallBackOnAreLeftOut) {
  GltfBuilder b = webpMaterial(losslessWebp(1, 1, {10, 20, 30, 40}));
  b.root["textures"][0]["extensions"] = {{"KHR_texture_basisu", {{"source", 0}}}};
  EXPECT_THAT(loadBuilt(b).warnings, ElementsAre(HasSubstr("no PNG, JPEG or WebP image")));
  b.root["textures"][0]["extensions"] = {{"EXT_texture_webp", {{"source", 7}}}};
  EXPECT_THAT(loadError(b.glb()), HasSubstr("image 7 does not exist"));
}

GltfBuilder glossy(json extension) {
  GltfBuilder b;
  b.append("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}},
                         {"extensions", {{"KHR_materials_pbrSpecularGlossiness", std::move(extension)}}}});
  b.root["extensionsRequired"] = {"KHR_materials_pbrSpecularGlossiness"};
  b.triangle(0);
  return b;
}

TEST(SpecularGlossiness, FactorsBecomeMetallicRoughness) {
  const Scene scene = loadBuilt(glossy({{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}},
                                        {"specularFactor", {0.9, 0.6, 0.3}},
                                        {"glossinessFactor", 0.75}}));
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.baseColour, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.metallic, 0);
  EXPECT_EQ(m.roughness, 0.25f);
  EXPECT_EQ(m.specularColour, glm::vec3(0.9f, 0.6f, 0.3f));
  const float reflected = std::pow((m.ior - 1) / (m.ior + 1), 2.f);
  EXPECT_GT(reflected, 0.995f) << "the specular colour is what is mirrored";
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("is converted")));
  const Material standard = loadBuilt(glossy(json::object())).materials.at(0);
  EXPECT_EQ(standard.baseColour, glm::vec4(1));
  EXPECT_EQ(standard.roughness, 0);
  EXPECT_EQ(standard.specularColour, glm::vec3(1));
}

TEST(SpecularGlossiness, TexturesBecomeRoughnessAndAMean) {
  GltfBuilder b =
      glossy({{"diffuseTexture", {{"index", 0}}},
              {"specularGlossinessTexture",
               {{"index", 1}, {"extensions", {{"KHR_texture_transform", {{"scale", {2, 1.5}}}}}}}},
              {"glossinessFactor", 0.5},
              {"specularFactor", {1, 0.5, 1}}});
  const std::vector<std::byte> diffuse = png(1, 1, {10, 20, 30, 40});
  const std::vector<std::byte> specular = png(2, 1, {255, 255, 0, 255, 0, 255, 0, 0});
  for (const auto& image : {diffuse, specular})
    b.append("images", {{"bufferView", b.view(image.data(), image.size())}, {"mimeType", "image/png"}});
  b.append("textures", {{"source", 0}});
  b.append("textures", {{"source", 1}});
  const Scene scene = loadBuilt(b);
  const Material& m = scene.materials.at(0);
  EXPECT_TRUE(scene.images.at(at(m.baseColourTexture.image)).srgb);
  EXPECT_THAT(scene.images.at(at(m.baseColourTexture.image)).levels[0].rgba, ElementsAre(10, 20, 30, 40));
  const scene::TextureImage& rough = scene.images.at(at(m.metalRoughTexture.image));
  EXPECT_FALSE(rough.srgb);
  EXPECT_THAT(rough.levels[0].rgba, ElementsAre(0, 128, 0, 255, 0, 255, 0, 255));
  EXPECT_EQ(m.roughness, 1);
  expectNear(m.specularColour, {0.5f, 0.5f, 0});
  EXPECT_THAT(scene.warnings,
              AllOf(Contains(HasSubstr("is converted")), Contains(HasSubstr("the mean of its")),
                    Contains(HasSubstr("texture coordinates differ"))));
}

TEST(SpecularGlossiness, OneImageOfSeveralMaterialsIsReadOnce) {
  GltfBuilder b = glossy({{"specularGlossinessTexture", {{"index", 0}}}, {"glossinessFactor", 0.5}});
  const std::vector<std::byte> image = png(2, 1, {255, 255, 255, 255, 0, 0, 0, 0});
  b.append("images", {{"bufferView", b.view(image.data(), image.size())}, {"mimeType", "image/png"}});
  b.append("textures", {{"source", 0}});
  json& materials = b.root["materials"];
  for (int copy = 1; copy < 3; ++copy) materials.push_back(json(materials[0]));
  materials[2]["extensions"]["KHR_materials_pbrSpecularGlossiness"]["glossinessFactor"] = 1;
  scene::LoadLimits limits;
  limits.imageTexels = 4;
  const Scene scene = scene::loadMemory(b.glb(), limits);
  EXPECT_EQ(scene.images.size(), 2u) << "one for each factor";
  EXPECT_EQ(scene.materials.at(1).metalRoughTexture.image, scene.materials.at(0).metalRoughTexture.image);
  EXPECT_NE(scene.materials.at(2).metalRoughTexture.image, scene.materials.at(0).metalRoughTexture.image);
  for (const Material& m : scene.materials) expectNear(m.specularColour, glm::vec3(0.5f));
  EXPECT_EQ(std::ranges::count_if(scene.warnings,
                                  [](const std::string& w) { return w.find("the mean of its") < w.size(); }),
            3)
      << "each material says so";
}

TEST(SpecularGlossiness, WarnsOfTheMeanWhereColoursVary) {
  const auto warnings = [](const std::vector<std::uint8_t>& texels) {
    GltfBuilder b = glossy({{"specularGlossinessTexture", {{"index", 0}}}});
    const std::vector<std::byte> image = png(2, 1, texels);
    b.append("images", {{"bufferView", b.view(image.data(), image.size())}, {"mimeType", "image/png"}});
    b.append("textures", {{"source", 0}});
    return loadBuilt(b).warnings;
  };
  const auto mean = HasSubstr("the mean of its");
  EXPECT_THAT(warnings({56, 56, 56, 128, 56, 56, 56, 128}), Not(Contains(mean)));
  EXPECT_THAT(warnings({56, 56, 56, 128, 56, 56, 56, 0}), Not(Contains(mean)));
  // The second colour is what the first texel holds as roughness.
  EXPECT_THAT(warnings({200, 10, 10, 255, 0, 0, 0, 255}), Contains(mean));
}

TEST(SpecularGlossiness, RefusesWhatDoesNotExist) {
  EXPECT_THAT(loadError(glossy({{"specularGlossinessTexture", {{"index", 3}}}}).glb()),
              HasSubstr("texture 3 does not exist"));
  EXPECT_THAT(loadError(glossy({{"diffuseFactor", {1, 2}}}).glb()),
              HasSubstr("diffuseFactor has 2 elements"));
}

}  // namespace
}  // namespace limn::test
