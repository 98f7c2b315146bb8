// What a loaded scene holds: geometry, materials, textures, extras.
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "core/image/image.h"
#include "tests/support/png.h"
#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using json = nlohmann::json;
using scene::kNone;
using scene::Primitive;
using scene::Scene;
using testing::ElementsAre;
using testing::HasSubstr;

class SceneFile : public SceneFiles {};

const Primitive& onlyPrimitive(const Scene& s) {
  return s.meshes.at(0).primitives.at(0);
}

TEST(SceneLoad, EmptyScenes) {
  const Scene scene = loadBuilt(GltfBuilder());
  EXPECT_TRUE(scene.nodes.empty() && scene.meshes.empty() && scene.images.empty() && scene.warnings.empty());
  EXPECT_EQ(scene.triangles(), 0u);
  EXPECT_TRUE(evaluate(scene, 0).bounds.empty());
  GltfBuilder zero;
  zero.append("scenes", {{"nodes", json::array()}});
  zero.append("meshes", {{"primitives", json::array()}});
  zero.append("skins", {{"joints", json::array()}});
  zero.append("animations", {{"samplers", json::array()}, {"channels", json::array()}});
  zero.node({{"mesh", 0}, {"skin", 0}});
  EXPECT_EQ(loadBuilt(zero).triangles(), 0u);
  GltfBuilder noVertex;
  noVertex.view("data", 4);
  noVertex.meshNode(noVertex.mesh({{"POSITION", noVertex.vec3({})}}));
  EXPECT_THAT(loadBuilt(noVertex).warnings, ElementsAre(HasSubstr("no triangle")));
}

TEST(SceneLoad, Triangle) {
  GltfBuilder b;
  b.triangle();
  const Scene scene = loadBuilt(b);
  const Primitive& p = onlyPrimitive(scene);
  EXPECT_EQ(scene.triangles(), 1u);
  EXPECT_THAT(p.indices, ElementsAre(0, 1, 2));
  EXPECT_TRUE(p.uvs.empty() && p.tangents.empty());  // no texture asks for them
  EXPECT_EQ(p.bounds.high, glm::vec3(1, 1, 0));
  EXPECT_EQ(scene.materials.at(static_cast<std::size_t>(p.material)).metallic, 1);  // glTF's default material
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(SceneLoad, NormalisedIntegers) {
  GltfBuilder b;
  const int p =
      b.accessor(std::vector<glm::i16vec4>{{-32768, 32767, 0, 0}, {0, 0, 16384, 0}, {0, 32767, 0, 0}},
                 GltfBuilder::kShort, "VEC3");
  b.root["accessors"][static_cast<std::size_t>(p)].update({{"normalized", true}});
  b.root["bufferViews"][0]["byteStride"] = 8;
  const int c = b.accessor(std::vector<glm::u8vec4>{{255, 0, 51, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}},
                           GltfBuilder::kUbyte, "VEC4");
  b.root["accessors"][static_cast<std::size_t>(c)]["normalized"] = true;
  b.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  b.meshNode(b.mesh({{"POSITION", p}, {"COLOR_0", c}}));
  const Primitive primitive = onlyPrimitive(loadBuilt(b));
  expectNear(primitive.positions[0], {-1, 1, 0});
  EXPECT_NEAR(primitive.positions[1].z, 16384 / 32767.0, 1e-6);
  expectNear(primitive.colours[0], {1, 0, 0.2f});
  EXPECT_EQ(primitive.colours[0].w, 0);
}

/// glTF 2.0, section 3.7.2.1; the GPU holds no others.
TEST(SceneLoad, ColoursAreClamped) {
  GltfBuilder b;
  b.triangle();
  b.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      b.vec4({{2, -1, 0.5f, 3}, {0, 1, 0.25f, -0.5f}, {1, 1, 1, 1}});
  const Scene scene = loadBuilt(b);
  EXPECT_THAT(onlyPrimitive(scene).colours,
              ElementsAre(glm::vec4(1, 0, 0.5f, 1), glm::vec4(0, 1, 0.25f, 0), glm::vec4(1)));
}

TEST(SceneLoad, SparseAccessor) {
  GltfBuilder b;
  b.triangle();
  const glm::vec3 value(7, 8, 9);
  b.root["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", b.view("\x01", 1)}, {"componentType", 5121}}},
      {"values", {{"bufferView", b.view(&value, 12)}}}};
  expectNear(onlyPrimitive(loadBuilt(b)).positions[1], value);
}

TEST(SceneLoad, StripsAndFans) {
  GltfBuilder b;
  const int p = b.vec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
  const int n = b.vec3(std::vector<glm::vec3>(4, glm::vec3(0, 0, 1)));
  b.meshNode(b.mesh({{"POSITION", p}, {"NORMAL", n}}));
  b.root["meshes"][0]["primitives"][0]["mode"] = 5;
  EXPECT_THAT(onlyPrimitive(loadBuilt(b)).indices, ElementsAre(0, 1, 2, 1, 3, 2));
  b.root["meshes"][0]["primitives"][0]["mode"] = 6;
  EXPECT_THAT(onlyPrimitive(loadBuilt(b)).indices, ElementsAre(1, 2, 0, 2, 3, 0));
  b.root["meshes"][0]["primitives"][0]["mode"] = 5;
  b.root["meshes"][0]["primitives"][0]["indices"] = b.indices({0, 1, 2, 2, 3});
  EXPECT_THAT(onlyPrimitive(loadBuilt(b)).indices, ElementsAre(0, 1, 2));  // stitches go
  b.root["meshes"][0]["primitives"][0]["mode"] = 1;
  const Scene lines = loadBuilt(b);
  EXPECT_TRUE(lines.meshes[0].primitives.empty());
  EXPECT_THAT(lines.warnings, ElementsAre(HasSubstr("points and lines")));
}

TEST(SceneLoad, MissingNormalsAreFlat) {
  GltfBuilder b;
  const int p = b.vec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  const int mesh = b.mesh({{"POSITION", p}}, b.indices({0, 1, 2, 0, 3, 1}));
  b.meshNode(mesh);
  const int delta = b.vec3({{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, {0, 0, 0}});
  b.root["meshes"][0]["primitives"][0]["targets"] = json::array({{{"POSITION", delta}}});
  const Primitive primitive = onlyPrimitive(loadBuilt(b));
  ASSERT_EQ(primitive.positions.size(), 6u);
  EXPECT_THAT(primitive.indices, ElementsAre(0, 1, 2, 3, 4, 5));
  for (std::size_t i = 0; i < 3; ++i) expectNear(primitive.normals[i], {0, 0, 1});
  for (std::size_t i = 3; i < 6; ++i) expectNear(primitive.normals[i], {0, 1, 0});
  // The target tilts the first face by 45 degrees.
  const glm::vec3 tilted(0, -std::sqrt(0.5f), std::sqrt(0.5f));
  expectNear(primitive.normals[0] + primitive.morphTargets[0].normals[0], tilted);
  expectNear(primitive.morphTargets[0].normals[3], glm::vec3(0));
}

TEST(SceneLoad, NormalsBecomeUnit) {
  GltfBuilder b;
  b.triangle();
  b.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      b.vec3({{0, 0, 3}, {0, 0, 0}, {0, 0.6f, 0.8f}});
  const Scene scene = loadBuilt(b);
  expectNear(onlyPrimitive(scene).normals[0], {0, 0, 1});
  expectNear(onlyPrimitive(scene).normals[1], {0, 0, 1});  // from the triangle
  expectNear(onlyPrimitive(scene).normals[2], {0, 0.6f, 0.8f});
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("not unit vectors")));
}

TEST(SceneLoad, Materials) {
  GltfBuilder b;
  b.append(
      "materials",
      {{"name", "glass"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
       {"emissiveFactor", {0.5, 1, 0}},
       {"doubleSided", true},
       {"alphaMode", "MASK"},
       {"alphaCutoff", 0.25},
       {"extensions",
        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}},
         {"KHR_materials_ior", {{"ior", 1.33}}},
         {"KHR_materials_specular", {{"specularFactor", 0}, {"specularColorFactor", {1, 0.5, 0}}}},
         {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
         {"KHR_materials_volume",
          {{"thicknessFactor", 0.1}, {"attenuationDistance", 2}, {"attenuationColor", {0.9, 0.8, 0.7}}}}}}});
  b.append("materials", {{"alphaMode", "BLEND"}});
  b.append("materials", {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"roughnessFactor", 7}}}});
  const Scene scene = loadBuilt(b);
  const scene::Material& m = scene.materials[0];
  EXPECT_EQ(m.baseColour, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.metallic, 0);
  EXPECT_EQ(m.roughness, 0.5f);
  EXPECT_EQ(m.emission, glm::vec3(2, 4, 0));
  EXPECT_TRUE(m.doubleSided);
  EXPECT_EQ(m.alphaCutoff, 0.25f);
  EXPECT_EQ(m.ior, 1.33f);
  EXPECT_EQ(m.specularFactor, 0);
  EXPECT_EQ(m.specularColour, glm::vec3(1, 0.5f, 0));
  EXPECT_EQ(m.transmission, 1);
  EXPECT_EQ(m.thickness, 0.1f);
  EXPECT_EQ(m.attenuationDistance, 2);
  EXPECT_EQ(m.attenuationColour, glm::vec3(0.9f, 0.8f, 0.7f));
  EXPECT_EQ(scene.materials[1].alphaCutoff, 0.5f);
  EXPECT_EQ(scene.materials[2].roughness, 1);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("BLEND counts as MASK"), HasSubstr("7 is clamped to 1")));
}

TEST(SceneLoad, OneTexturePerImageAndUse) {
  GltfBuilder b;
  const std::vector<std::byte> image = png(1, 1, {10, 20, 30, 40});
  b.append("images", {{"bufferView", b.view(image.data(), image.size())}, {"name", "pixel"}});
  b.append("samplers", {{"wrapS", 33071}, {"wrapT", 33648}});
  b.append("textures", {{"source", 0}, {"sampler", 0}});
  b.append("textures", {{"source", 0}});
  b.append("materials",
           {{"pbrMetallicRoughness",
             {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}}},
            {"emissiveTexture", {{"index", 1}}}});
  const Scene scene = loadBuilt(b);
  ASSERT_EQ(scene.images.size(), 2u);
  const scene::Material& m = scene.materials[0];
  EXPECT_TRUE(scene.images[static_cast<std::size_t>(m.baseColourTexture.image)].srgb);
  EXPECT_FALSE(scene.images[static_cast<std::size_t>(m.metalRoughTexture.image)].srgb);
  EXPECT_EQ(m.emissiveTexture.image, m.baseColourTexture.image);
  EXPECT_EQ(m.baseColourTexture.wrapS, scene::Wrap::clamp);
  EXPECT_EQ(m.baseColourTexture.wrapT, scene::Wrap::mirror);
  EXPECT_EQ(m.metalRoughTexture.wrapS, scene::Wrap::repeat);
  EXPECT_EQ(scene.images[0].name, "pixel");
  EXPECT_THAT(scene.images[0].levels[0].rgba, ElementsAre(10, 20, 30, 40));
}

/// Exporters write an image for each texture.
TEST(SceneLoad, ImagesOfOnePictureAreDecodedOnce) {
  const std::vector<std::byte> bytes = png(1, 1, {10, 20, 30, 40});
  GltfBuilder b;
  const json inside = {{"bufferView", b.view(bytes.data(), bytes.size())}},
             beside = {
                 {"uri", "data:image/webp;base64,UklGRh4AAABXRUJQVlA4TBEAAAAvAAAAEAdQiirUoyiBiOh/AAA="}};
  for (const json& image : {inside, beside, inside, beside}) {
    const int texture = b.append("textures", {{"source", b.append("images", image)}});
    b.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  }
  scene::LoadLimits limits;
  limits.imageTexels = 2;
  const Scene loaded = scene::loadMemory(b.glb(), limits);
  EXPECT_EQ(loaded.images.size(), 2u);
  std::vector<int> images;
  for (const scene::Material& m : loaded.materials) images.push_back(m.baseColourTexture.image);
  EXPECT_THAT(images, ElementsAre(0, 1, 0, 1));
}

TEST(SceneLoad, DataUri) {
  GltfBuilder b;
  b.root["buffers"] = {{{"byteLength", 3}, {"uri", "data:application/octet-stream;base64,AAEC"}}};
  b.append("bufferViews", {{"buffer", 0}, {"byteLength", 3}});
  b.append("accessors", {{"bufferView", 0}, {"componentType", 5121}, {"count", 3}, {"type", "SCALAR"}});
  EXPECT_EQ(loadError(b.text()), "");
  b.root["buffers"][0]["byteLength"] = 4;
  EXPECT_THAT(loadError(b.text()), HasSubstr("declares 4 bytes, 3 are there"));
  b.root["buffers"][0]["byteLength"] = 3;
  for (const char* header : {"data:;base64,", "DATA:application/gltf-buffer;charset=x;base64,"}) {
    b.root["buffers"][0]["uri"] = std::string(header) + "AAEC";
    EXPECT_EQ(loadError(b.text()), "") << header;
  }
  for (const char* uri : {"data:,abc", "data:;base64", "data:;base64,", "data:;base64,!"}) {
    b.root["buffers"][0]["uri"] = uri;
    EXPECT_THAT(loadError(b.text()), HasSubstr("buffer 0: the data URI cannot be decoded; base64")) << uri;
  }
}

TEST(SceneLoad, TextureTransform) {
  GltfBuilder b;
  const int material = b.texturedMaterial(png(1, 1, {1, 2, 3, 4}));
  b.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] =
      {{"offset", {0.5, 0.25}}, {"scale", {2, 4}}};
  b.triangle(material);
  EXPECT_THAT(onlyPrimitive(loadBuilt(b)).uvs,
              ElementsAre(glm::vec2(0.5f, 0.25f), glm::vec2(2.5f, 0.25f), glm::vec2(0.5f, 4.25f)));
}

/// Coordinates turn counter-clockwise as one sees them, v downwards: what rises along u goes up the picture.
TEST(SceneLoad, TextureRotation) {
  GltfBuilder b;
  const int material = b.texturedMaterial(png(1, 1, {1, 2, 3, 4}));
  b.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] =
      {{"offset", {0, 1}}, {"rotation", M_PI / 2}, {"scale", {0.5, 1}}};
  b.triangle(material);
  const Scene scene = loadBuilt(b);
  const std::vector<glm::vec2>& uvs = onlyPrimitive(scene).uvs;
  expectNear(glm::vec3(uvs.at(0), 0), {0, 1, 0});
  expectNear(glm::vec3(uvs.at(1), 0), {0, 0.5f, 0});
  expectNear(glm::vec3(uvs.at(2), 0), {1, 1, 0});
}

TEST(SceneLoad, TangentsOnlyWithNormalMap) {
  GltfBuilder b;
  b.texturedMaterial(png(1, 1, {128, 128, 255, 255}));
  b.root["materials"][0] = {{"normalTexture", {{"index", 0}, {"scale", 0.5}}}};
  b.triangle(0);
  const Scene scene = loadBuilt(b);
  EXPECT_EQ(scene.materials[0].normalScale, 0.5f);
  ASSERT_EQ(onlyPrimitive(scene).tangents.size(), 3u);
  expectNear(onlyPrimitive(scene).tangents[0], {1, 0, 0});
}

/// Halves of a body that share a texture, mirrored, may share vertices as well, whose tangents would cancel.
TEST(SceneLoad, MirroredHalvesHaveTangentsOfTheirOwn) {
  GltfBuilder b;
  const std::vector<std::byte> image = png(1, 1, {128, 128, 255, 255});
  b.append("images", {{"bufferView", b.view(image.data(), image.size())}, {"mimeType", "image/png"}});
  b.append("textures", {{"source", 0}});
  const int material = b.append("materials", {{"normalTexture", {{"index", 0}}}});
  const std::vector<glm::vec3> places = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  std::vector<glm::vec3> colours;
  for (const glm::vec3& place : places) colours.push_back(0.5f * place + 0.5f);
  const json attributes = {{"POSITION", b.vec3(places)},
                           {"NORMAL", b.vec3(std::vector<glm::vec3>(4, {0, 0, 1}))},
                           {"TEXCOORD_0", b.vec2({{1, 1}, {0, 1}, {0, 0}, {1, 1}})},
                           {"COLOR_0", b.vec3(colours)}};
  b.meshNode(b.mesh(attributes, b.indices({0, 1, 2, 1, 3, 2}), material));
  b.root["meshes"][0]["primitives"][0]["targets"] = json::array({{{"POSITION", b.vec3(places)}}});
  const Scene scene = loadBuilt(b);
  const Primitive& p = onlyPrimitive(scene);
  ASSERT_EQ(p.tangents.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    const float side = i < 3 ? -1.f : 1.f;
    EXPECT_EQ(p.tangents[p.indices[i]], glm::vec4(side, 0, 0, side)) << i;
    const std::size_t vertex = std::array<std::size_t, 6>{0, 1, 2, 1, 3, 2}[i];
    const glm::vec3 place = places[vertex];
    EXPECT_EQ(p.positions[p.indices[i]], place);
    EXPECT_EQ(p.colours[p.indices[i]], glm::vec4(colours[vertex], 1));
    EXPECT_EQ(p.morphTargets[0].positions[p.indices[i]], place);
  }
  b.root["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
      b.vec4(std::vector<glm::vec4>(4, {1, 0, 0, 1}));
  EXPECT_EQ(onlyPrimitive(loadBuilt(b)).positions.size(), 4u) << "the file's own";
}

/// Of others one renderer would divide by the fourth coordinate and one would not.
TEST(SceneLoad, MatricesAreAffine) {
  GltfBuilder b;
  b.triangle();
  json& matrix = b.root["nodes"][0]["matrix"];
  matrix = {1, 0, 0, 1e-7, 0, 1, 0, 0, 0, 0, 1, 0, 7, 0, 0, 0.9999999};
  const Scene rounded = loadBuilt(b);
  EXPECT_TRUE(rounded.warnings.empty()) << rounded.warnings.front();
  matrix[3] = 0.5;
  matrix[15] = 2;
  const Scene other = loadBuilt(b);
  EXPECT_THAT(other.warnings, ElementsAre(HasSubstr("node 0 'n' matrix: its last row is not 0, 0, 0, 1")));
  for (const Scene* scene : {&rounded, &other})
    EXPECT_EQ(scene->nodes.at(0).matrix, glm::translate(glm::mat4(1), glm::vec3(7, 0, 0)));
}

TEST(SceneLoad, BindMatricesAreAffine) {
  const glm::mat4 moved = glm::translate(glm::mat4(1), glm::vec3(7, 0, 0));
  glm::mat4 bind = moved;
  bind[0][3] = 0.5f;
  bind[3][3] = 2;
  GltfBuilder b;
  b.node(json::object());
  const int matrices = b.accessor(std::vector<glm::mat4>{bind}, GltfBuilder::kFloat, "MAT4");
  b.append("skins", {{"joints", {0}}, {"inverseBindMatrices", matrices}});
  const Scene loaded = loadBuilt(b);
  EXPECT_THAT(loaded.warnings, ElementsAre(HasSubstr("skin 0 inverseBindMatrices: the last row of one is")));
  EXPECT_EQ(loaded.skins.at(0).inverseBind.at(0), moved);
}

TEST(SceneLoad, OnlyTheDefaultSceneIsDrawn) {
  GltfBuilder b;
  b.triangle();
  b.meshNode(0);
  b.append("scenes", {{"nodes", {0}}});
  b.append("scenes", {{"nodes", {0, 1}}});
  EXPECT_EQ(loadBuilt(b).triangles(), 1u);
  b.root["scene"] = 1;
  EXPECT_EQ(loadBuilt(b).triangles(), 2u);
}

/// In extras and extensions, too, whose whole numbers tinygltf holds as int.
TEST(SceneLoad, LargeWholeNumbersAreTakenAsTheyAre) {
  GltfBuilder b;
  const json medium = {{"sigma_a", 4'000'000'000}, {"sigma_s", {1, 2, 5'000'000'000}}};
  b.append("scenes", {{"extras", {{"limn_medium", medium}}}});
  b.append("materials",
           {{"emissiveFactor", {1, 1, 1}},
            {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 3'000'000'000}}}}}});
  const Scene scene = loadBuilt(b);
  EXPECT_EQ(scene.medium.sigmaA, glm::vec3(4e9f));
  EXPECT_EQ(scene.medium.sigmaS, glm::vec3(1, 2, 5e9f));
  EXPECT_EQ(scene.materials.at(0).emission, glm::vec3(3e9f));
  EXPECT_TRUE(scene.warnings.empty());
}

/// By them a bench tells whether the scene has changed.
TEST_F(SceneFile, NamesItsFilesHoweverLargeItIs) {
  GltfBuilder b;
  b.append("images", {{"uri", "in%20side.png"}});
  const std::filesystem::path picture = write("scene/in side.png", png(1, 1, {1, 2, 3, 4}));
  const std::filesystem::path text = write("scene/a.gltf", b.text()), binary = write("scene/b.glb", b.glb());
  std::filesystem::resize_file(binary, std::uintmax_t{3} << 30);  // takes no room: nothing is written
  for (const std::filesystem::path& file : {text, binary})
    EXPECT_THAT(scene::filesOf(file), ElementsAre(file, picture));
  EXPECT_THROW(scene::filesOf(folder_ / "none.glb"), Error);
  EXPECT_THAT(scene::filesOf(write("scene/c.glb", GltfBuilder::toBytes("glTF"))), testing::SizeIs(1));
}

TEST_F(SceneFile, EnvironmentBesideTheScene) {
  Image sky = Image::rgb(2, 1);
  sky.at(0, 0, 0) = -3;
  sky.at(1, 0, 2) = 5;
  writeExr(folder_ / "scene" / "sky.exr", sky);
  GltfBuilder b;
  b.append("scenes", {{"extras", {{"limn_environment", "sky.exr"}}}});
  const Scene scene = scene::load(write("scene/a.glb", b.glb()));
  ASSERT_TRUE(scene.environment);
  EXPECT_EQ(scene.environment.texels[0], glm::vec3(0));  // negative pixels are clamped
  EXPECT_EQ(scene.environment.texels[1], glm::vec3(0, 0, 5));
  EXPECT_EQ(scene.file, folder_ / "scene/a.glb");
  sky.at(0, 0, 0) = std::nanf("");
  writeExr(folder_ / "scene" / "sky.exr", sky);
  EXPECT_THAT(loadError(folder_ / "scene/a.glb"), HasSubstr("pixel (0, 0) is not a finite number"));
}

}  // namespace
}  // namespace limn::test
