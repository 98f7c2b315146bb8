// extras.limn_height: what is read, shared, refused and warned of.
#include <cmath>
#include <limits>

#include "core/image/image.h"
#include "tests/support/png.h"
#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using json = nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// 2 x 2 heights of 0, 0.25, 0.5 and 1, to within 2^-16.
const std::vector<std::byte> kMap = png16(2, 2, {0, 16384, 32768, 65535});

json heightOf(int texture, json more = json::object()) {
  more["texture"]["index"] = texture;
  return more;
}

/// A triangle of 1 m per unit of u and v whose material has that height map. The texture 0 is `image`.
GltfBuilder withHeight(const json& height, const std::vector<std::byte>& image = kMap) {
  GltfBuilder b;
  const int material = b.texturedMaterial(image);
  b.root["materials"][static_cast<size_t>(material)] = {{"name", "wall"},
                                                        {"extras", {{"limn_height", height}}}};
  b.triangle(material);
  return b;
}

GltfBuilder withSampler(int wrapS, int wrapT) {
  GltfBuilder b = withHeight(heightOf(0));
  b.append("samplers", {{"wrapS", wrapS}, {"wrapT", wrapT}});
  b.root["textures"][0]["sampler"] = 0;
  return b;
}

std::string refusedHeight(const json& height) {
  return loadError(withHeight(height).glb());
}

TEST(SceneHeightMap, IsReadWithAllItsNumbers) {
  const scene::Scene scene =
      loadBuilt(withHeight(heightOf(0, {{"scale", -2}, {"offset", 0.5}, {"tile", {1, 1}}})));
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_EQ(scene.heights.size(), 1u);
  EXPECT_EQ(scene.materials.at(0).height, 0);
  const relief::HeightField& field = scene.heights[0];
  EXPECT_EQ(field.size(), glm::ivec2(2));
  EXPECT_EQ(field.wrap(), relief::Wrap::periodic);
  EXPECT_EQ(field.spacing(), glm::dvec2(0.5));
  EXPECT_NEAR(field.texel({0, 0}), 0.5, 1e-9) << "the first texel is that of the top left corner";
  EXPECT_NEAR(field.texel({1, 0}), 0.5 - 2 * 16384 / 65535.0, 1e-6);
  EXPECT_NEAR(field.texel({0, 1}), 0.5 - 2 * 32768 / 65535.0, 1e-6) << "not decoded from sRGB";
  EXPECT_NEAR(field.texel({1, 1}), -1.5, 1e-9);
  EXPECT_TRUE(scene.images.empty()) << "no 8-bit picture is made of it";
  const scene::Primitive& primitive = scene.meshes.at(0).primitives.at(0);
  EXPECT_EQ(primitive.uvs.size(), 3u);
  ASSERT_EQ(primitive.tangents.size(), 3u);
  expectNear(glm::vec3(primitive.tangents[0]), {1, 0, 0});
}

TEST(SceneHeightMap, HasDefaults) {
  const scene::Scene scene = loadBuilt(withHeight(heightOf(0)));
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_NEAR(scene.heights.at(0).lowest(), 0, 1e-9);
  EXPECT_NEAR(scene.heights.at(0).highest(), 1, 1e-9);
  EXPECT_EQ(scene.heights.at(0).spacing(), glm::dvec2(0.5));
}

TEST(SceneHeightMap, TakesTheFirstChannelOfColoursAndAnyScale) {
  const std::vector<std::byte> red = png(1, 1, {255, 0, 51, 0});
  for (const double scale : {0.0, 1e-4, 1e4, -1.0}) {
    const scene::Scene scene = loadBuilt(withHeight(heightOf(0, {{"scale", scale}}), red));
    EXPECT_THAT(scene.warnings, IsEmpty()) << scale;
    EXPECT_DOUBLE_EQ(scene.heights.at(0).texel({0, 0}), scale);
  }
}

TEST(SceneHeightMap, WrapsAsItsSampler) {
  EXPECT_EQ(loadBuilt(withSampler(10497, 10497)).heights.at(0).wrap(), relief::Wrap::periodic);
  EXPECT_EQ(loadBuilt(withSampler(33071, 33071)).heights.at(0).wrap(), relief::Wrap::clamped);
  for (const auto& [s, t] : {std::pair{10497, 33071}, {33648, 33648}, {33071, 33648}})
    EXPECT_THAT(
        loadError(withSampler(s, t).glb()),
        HasSubstr("material 0 'wall' limn_height texture: a sampler that repeats (10497) along both"));
}

TEST(SceneHeightMap, ExistsOnceWhereAllIsTheSame) {
  GltfBuilder b = withHeight(heightOf(0, {{"scale", 0.1}}));
  const auto add = [&](const json& height) {
    b.append("materials", {{"extras", {{"limn_height", height}}}});
  };
  add(heightOf(0, {{"scale", 0.1}, {"offset", 0}, {"tile", {1, 1}}}));
  add(heightOf(0, {{"scale", 0.2}}));
  add(heightOf(0, {{"scale", 0.1}, {"offset", 1}}));
  add(heightOf(0, {{"scale", 0.1}, {"tile", {1, 2}}}));
  const scene::Scene scene = loadBuilt(b);
  std::vector<int> maps;
  for (const scene::Material& material : scene.materials) maps.push_back(material.height);
  EXPECT_THAT(maps, ElementsAre(0, 0, 1, 2, 3));
  EXPECT_EQ(scene.heights.size(), 4u);
}

TEST(SceneHeightMap, RefusesWhatItDoesNotKnowInOneLine) {
  const std::string place = "material 0 'wall' limn_height";
  EXPECT_THAT(refusedHeight(3), HasSubstr(place + ": an object {texture, scale, offset, tile} is accepted"));
  // Objects without members are not there: the library that reads glTF leaves them out.
  EXPECT_EQ(refusedHeight(json::object()), "");
  EXPECT_THAT(refusedHeight({{"scale", 1}}), HasSubstr(place + " texture: glTF's object {index, texCoord}"));
  for (const json& info : {json(0), json{{"texCoord", 0}}, json{{"index", "a"}}, json{{"index", 0.5}},
                           json{{"index", 0}, {"texCoord", -1}}, json{{"index", 0}, {"texCoord", "b"}}})
    EXPECT_THAT(refusedHeight({{"texture", info}}), HasSubstr(place + " texture: glTF's object")) << info;
  EXPECT_THAT(refusedHeight(heightOf(7)),
              HasSubstr(place + " texture: texture 7 does not exist; there are 1"));
  EXPECT_THAT(refusedHeight(heightOf(-1)), HasSubstr(place + " texture: texture -1 does not exist"));
  EXPECT_THAT(refusedHeight(heightOf(0, {{"scale", "high"}})),
              HasSubstr(place + " scale: one number (metres)"));
  EXPECT_THAT(refusedHeight(heightOf(0, {{"scale", 1e200}})),
              HasSubstr("scale: 1e+200 is not a finite number"));
  EXPECT_THAT(refusedHeight(heightOf(0, {{"scale", 3e38}, {"offset", 3e38}})),
              AllOf(HasSubstr(place), HasSubstr("finite 32-bit heights are needed")));
  EXPECT_THAT(refusedHeight(heightOf(0, {{"offset", {1}}})),
              HasSubstr(place + " offset: one number (metres)"));
  EXPECT_THAT(refusedHeight(heightOf(0, {{"tile", 1}})),
              HasSubstr("tile (metres per unit of u and v): 2 numbers"));
  for (const json& tile : {json{0, 1}, json{1, -1}})
    EXPECT_THAT(refusedHeight(heightOf(0, {{"tile", tile}})),
                AllOf(HasSubstr(place), HasSubstr("both must be above 0 and finite")));
}

TEST(SceneHeightMap, RefusesPicturesThatAreNoHeightsInOneLine) {
  const auto refused = [](const std::vector<std::byte>& image) {
    return loadError(withHeight(heightOf(0), image).glb());
  };
  EXPECT_THAT(refused(GltfBuilder::toBytes("\xff\xd8\xff\xe0 and so on \xff\xd9")),
              HasSubstr("material 0 'wall' limn_height: image 0: "));
  EXPECT_THAT(refused(GltfBuilder::toBytes("nothing")), HasSubstr("limn_height: image 0: not a picture"));
  std::vector<std::byte> cut = kMap;
  cut.resize(cut.size() - 20);
  EXPECT_THAT(refused(cut), HasSubstr("limn_height: image 0: truncated or damaged PNG"));
  EXPECT_THAT(refused(png16(70000, 70000, {0})), HasSubstr("limn_height: image 0: "));
  EXPECT_THAT(loadError(withHeight(heightOf(0)).glb(), {.imageTexels = 3}),
              HasSubstr("limn_height: image 0: 2x2 pixels; at most 3 are accepted"));
  GltfBuilder b = withHeight(heightOf(0));
  b.root["textures"][0].erase("source");
  EXPECT_THAT(loadError(b.glb()), HasSubstr("limn_height texture: texture 0 has no image"));
}

TEST(SceneHeightMap, WarnsOfASecondSourceOfNormals) {
  GltfBuilder b = withHeight(heightOf(0));
  b.root["materials"][0]["normalTexture"]["index"] = 0;
  const scene::Scene scene = loadBuilt(b);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("limn_height: there is a normalTexture too")));
  EXPECT_EQ(scene.materials.at(0).height, 0);
}

TEST(SceneHeightMap, WarnsWithoutTextureCoordinatesAsTexturesDo) {
  GltfBuilder b = withHeight(heightOf(0));
  b.root["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  const scene::Scene scene = loadBuilt(b);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("no TEXCOORD_0 for the textures of its material")));
  EXPECT_EQ(scene.meshes.at(0).primitives.at(0).uvs.size(), 3u);
}

/// The sign of a tangent's w is such that the bitangent w cross(n, t), n = +Z, points against rising v. A
/// quarter turn makes (v, -u) of (u, v).
TEST(SceneHeightMap, TangentsOfAFileStayUnlessTheMapTurnsThem) {
  const float c = std::cos(0.5f), s = std::sin(0.5f);
  const glm::vec4 own(c, s, 0, -1);
  const auto tangent = [&](const json& transform, int set = 0) {
    json height = heightOf(0);
    height["texture"]["texCoord"] = set;
    if (!transform.empty()) height["texture"]["extensions"]["KHR_texture_transform"] = transform;
    GltfBuilder b = withHeight(height);
    json& attributes = b.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["TANGENT"] = b.vec4({own, own, own});
    attributes["TEXCOORD_1"] = b.vec2({{0, 0}, {0, 1}, {1, 0}});
    const scene::Scene scene = loadBuilt(b);
    EXPECT_THAT(scene.warnings, IsEmpty()) << transform;
    return scene.meshes.at(0).primitives.at(0).tangents.at(0);
  };
  const auto expectTangent = [](const glm::vec4& found, const glm::vec4& expected) {
    expectNear(glm::vec3(found), glm::vec3(expected), 1e-5f);
    EXPECT_EQ(found.w, expected.w);
  };
  expectTangent(tangent(json::object()), own);
  expectTangent(tangent({{"offset", {0.25, 0.5}}}), own);
  expectTangent(tangent({{"scale", {-1, 1}}}), {-1, 0, 0, 1});
  expectTangent(tangent({{"scale", {1, -1}}}), {1, 0, 0, 1});
  expectTangent(tangent({{"rotation", 1.5707963}}), {0, 1, 0, -1});
  expectTangent(tangent(json::object(), 1), {0, 1, 0, 1});
}

TEST(SceneHeightMap, WarnsOfCoordinatesThatDoNotFitItsTile) {
  const auto warnings = [](const json& tile, const std::vector<glm::vec3>& corners) {
    GltfBuilder b = withHeight(heightOf(0, {{"tile", tile}}));
    b.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = b.vec3(corners);
    b.triangle(0);  // a second one of 1 x 1 m
    return loadBuilt(b).warnings;
  };
  const std::vector<glm::vec3> square{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_THAT(warnings({1, 1}, square), IsEmpty());
  EXPECT_THAT(warnings({1.08, 0.95}, square), IsEmpty());
  EXPECT_THAT(warnings({1, 1.2}, square), ElementsAre(HasSubstr("1 x 1 m per unit of u and v")))
      << "one line for a material";
  EXPECT_THAT(warnings({1, 1}, {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}}),
              ElementsAre(AllOf(HasSubstr("material 0 'wall' limn_height: a primitive has 2 x 1 m"),
                                HasSubstr("tile is 1 x 1 m"))));
  EXPECT_THAT(warnings({1, 1}, {{0, 0, 0}, {1, 0, 0}, {0.05f, 1, 0}}), IsEmpty());
  EXPECT_THAT(warnings({1, 1}, {{0, 0, 0}, {1, 0, 0}, {0.25f, 0.968f, 0}}),
              ElementsAre(HasSubstr("are 14.5 degrees off a right angle")));
}

TEST(SceneHeightMap, WarnsOfFewBitsForManyTexels) {
  std::vector<std::uint8_t> steps;
  std::vector<std::uint16_t> fine;
  for (int i = 0; i < 64; ++i) {
    const auto value = static_cast<std::uint8_t>(4 * i);
    steps.insert(steps.end(), {value, value, value, 255});
    fine.push_back(static_cast<std::uint16_t>(1024 * i));
  }
  const json low = heightOf(0, {{"scale", 0.15}}), high = heightOf(0, {{"scale", 0.2}});
  EXPECT_THAT(loadBuilt(withHeight(low, png(64, 1, steps))).warnings, IsEmpty());
  EXPECT_THAT(loadBuilt(withHeight(high, png(64, 1, steps))).warnings,
              ElementsAre(HasSubstr("limn_height: image 0 has 8 bits for heights over 12.6 texels")));
  EXPECT_THAT(loadBuilt(withHeight(high, png16(64, 1, fine))).warnings, IsEmpty());
}

class HeightMapFiles : public SceneFiles {
 protected:
  std::filesystem::path scene(const std::string& uri) {
    GltfBuilder b = withHeight(heightOf(0));
    b.root["images"][0] = {{"uri", uri}};
    return write("scene/scene.glb", b.glb());
  }
  void writeHeights(const std::vector<float>& values) {
    Image image(static_cast<int>(values.size()), 1, {"Y"});
    std::copy(values.begin(), values.end(), image.data().begin());
    writeExr(folder_ / "scene" / "heights.exr", image);
  }
};

TEST_F(HeightMapFiles, AreExrAsTheyAre) {
  writeHeights({-3.5f, 1e-7f, 20});
  const scene::Scene loaded = scene::load(scene("heights.exr"));
  EXPECT_THAT(loaded.warnings, IsEmpty());
  const relief::HeightField& field = loaded.heights.at(0);
  EXPECT_EQ(field.size(), glm::ivec2(3, 1));
  EXPECT_EQ(field.texel({0, 0}), -3.5);
  EXPECT_EQ(field.texel({1, 0}), double(1e-7f));
  EXPECT_EQ(field.texel({2, 0}), 20);
}

TEST_F(HeightMapFiles, AreFoundInTheScenesFolderAlone) {
  EXPECT_THAT(loadError(scene("none.exr")), HasSubstr("material 0 'wall' limn_height: image 0 (none.exr): "));
  EXPECT_THAT(loadError(scene("../none.exr")), HasSubstr("lies outside the scene's folder"));
}

TEST_F(HeightMapFiles, HaveNumbersAlone) {
  for (const float wrong :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    writeHeights({0, wrong});
    EXPECT_THAT(loadError(scene("heights.exr")),
                AllOf(HasSubstr("material 0 'wall' limn_height: "), HasSubstr("finite 32-bit heights")));
  }
}

}  // namespace
}  // namespace limn::test
