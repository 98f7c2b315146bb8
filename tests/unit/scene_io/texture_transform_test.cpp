// KHR_texture_transform where the textures of one material have different ones.
#include <algorithm>

#include "core/scene/texture_lookup.h"
#include "tests/support/png.h"
#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using json = nlohmann::json;
using scene::Scene;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kQuarterTurn = 1.5708;  // as files round it

struct Slot {
  const char* pointer;  ///< in the material
  json transform = json::object();
  std::vector<std::byte> image = {};  ///< empty: patterned
};

/// 8 x 4 texels, all different.
std::vector<std::byte> patterned() {
  std::vector<std::uint8_t> rgba;
  for (unsigned i = 0; i < 8 * 4 * 4; ++i) rgba.push_back(static_cast<std::uint8_t>(37 * i + i * i % 11));
  return png(8, 4, rgba);
}

/// A triangle whose material has these textures.
GltfBuilder withTextures(const std::vector<Slot>& slots) {
  GltfBuilder b;
  json material = json::object();
  for (const Slot& slot : slots) {
    const std::vector<std::byte> image = slot.image.empty() ? patterned() : slot.image;
    const int source = b.append("images", {{"bufferView", b.view(image.data(), image.size())}});
    material[json::json_pointer(slot.pointer)] = {
        {"index", b.append("textures", {{"source", source}})},
        {"extensions", {{"KHR_texture_transform", slot.transform}}}};
  }
  b.triangle(b.append("materials", material));
  return b;
}

constexpr const char* kBaseColour = "/pbrMetallicRoughness/baseColorTexture";
constexpr const char* kMetalRough = "/pbrMetallicRoughness/metallicRoughnessTexture";
constexpr const char* kNormal = "/normalTexture";
constexpr const char* kEmissive = "/emissiveTexture";

const std::vector<glm::vec2>& uvsOf(const Scene& scene) {
  return scene.meshes.at(0).primitives.at(0).uvs;
}

/// The largest difference between what two scenes show of a texture on and around the triangle.
float difference(const Scene& a, const Scene& b, scene::TextureRef scene::Material::*texture) {
  float most = 0;
  const auto colour = [&](const Scene& scene, float s, float t) {
    const std::vector<glm::vec2>& uvs = uvsOf(scene);
    const glm::vec2 uv = uvs[0] + s * (uvs[1] - uvs[0]) + t * (uvs[2] - uvs[0]);
    return sampleTexture(scene, scene.materials.at(0).*texture, uv, 0);
  };
  for (int i = 0; i < 50; ++i) {
    for (int k = 0; k < 50; ++k) {
      const float s = -1.3f + 0.061f * static_cast<float>(i), t = -1.7f + 0.067f * static_cast<float>(k);
      const glm::vec4 d = glm::abs(colour(a, s, t) - colour(b, s, t));
      most = std::max({most, d.x, d.y, d.z, d.w});
    }
  }
  return most;
}

TEST(TextureTransforms, RepeatsBecomeTiles) {
  const Scene scene = loadBuilt(
      withTextures({{kBaseColour}, {kMetalRough, {{"scale", {2, 3}}}, png(2, 1, {1, 2, 3, 4, 5, 6, 7, 8})}}));
  EXPECT_THAT(scene.warnings, IsEmpty());
  const auto& level = imageOf(scene, scene.materials.at(0).metalRoughTexture);
  EXPECT_EQ(level.width, 4);
  EXPECT_EQ(level.height, 3);
  std::vector<std::uint8_t> expected;
  for (int tile = 0; tile < 6; ++tile) expected.insert(expected.end(), {1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_EQ(level.rgba, expected);
  EXPECT_THAT(uvsOf(scene), ElementsAre(glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)));
}

TEST(TextureTransforms, EachTextureLiesWhereItsOwnOnePutsIt) {
  const std::pair<json, json> transforms[] = {
      {json::object(), {{"scale", {3, 2}}}},
      {{{"scale", {4, 4}}}, json::object()},
      {{{"offset", {0.25, 0.5}}}, json::object()},
      {json::object(), {{"rotation", kQuarterTurn}}},
      {{{"rotation", kQuarterTurn}}, {{"scale", {-1, 1}}}},
      {{{"rotation", -kQuarterTurn}, {"offset", {0.5, 0}}}, {{"scale", {2, -3}}, {"offset", {0.75, 0.25}}}},
      {{{"scale", {0.5, 0.25}}}, {{"scale", {-1, 1}}, {"rotation", 2 * kQuarterTurn}}},
      {{{"scale", {2, 2}}, {"rotation", 0.3}}, {{"scale", {4, 4}}, {"rotation", 0.3}}}};
  for (const auto& [base, emissive] : transforms) {
    const Scene both = loadBuilt(withTextures({{kBaseColour, base}, {kEmissive, emissive}}));
    EXPECT_THAT(both.warnings, IsEmpty()) << base << emissive;
    const Scene baseAlone = loadBuilt(withTextures({{kBaseColour, base}}));
    EXPECT_LT(difference(both, baseAlone, &scene::Material::baseColourTexture), 0.002f) << base << emissive;
    const Scene emissiveAlone = loadBuilt(withTextures({{kEmissive, emissive}}));
    EXPECT_LT(difference(both, emissiveAlone, &scene::Material::emissiveTexture), 0.002f) << base << emissive;
  }
}

TEST(TextureTransforms, PartsOfATexelBlurLittle) {
  const json emissive = {{"offset", {0.3, 0}}};
  const Scene both = loadBuilt(withTextures({{kBaseColour}, {kEmissive, emissive}}));
  const Scene alone = loadBuilt(withTextures({{kEmissive, emissive}}));
  EXPECT_THAT(both.warnings, IsEmpty());
  EXPECT_EQ(imageOf(both, both.materials.at(0).emissiveTexture).width, 1024);
  EXPECT_LT(difference(both, alone, &scene::Material::emissiveTexture), 0.02f);
}

TEST(TextureTransforms, NormalMapsAreNotTurned) {
  const Scene scene = loadBuilt(withTextures({{kBaseColour}, {kNormal, {{"rotation", kQuarterTurn}}}}));
  EXPECT_THAT(scene.warnings, IsEmpty());
  const scene::Material& m = scene.materials.at(0);
  EXPECT_EQ(imageOf(scene, m.normalTexture).width, 8) << "its coordinates are the material's";
  EXPECT_EQ(imageOf(scene, m.baseColourTexture).width, 4) << "which the base colour follows";
  EXPECT_NEAR(uvsOf(scene)[1].y, -1, 1e-5);
}

TEST(TextureTransforms, HeightMapsAreFollowed) {
  GltfBuilder b = withTextures({{kBaseColour, {{"scale", {2, 2}}}}});
  const std::vector<std::byte> map = png16(2, 2, {0, 16384, 32768, 65535});
  const int source = b.append("images", {{"bufferView", b.view(map.data(), map.size())}});
  b.root["materials"][0]["extras"]["limn_height"]["texture"]["index"] =
      b.append("textures", {{"source", source}});
  const Scene scene = loadBuilt(b);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_EQ(imageOf(scene, scene.materials.at(0).baseColourTexture).width, 16);
  EXPECT_EQ(uvsOf(scene)[1], glm::vec2(1, 0));
}

TEST(TextureTransforms, OneImageForAllMaterialsThatShareIt) {
  GltfBuilder b = withTextures({{kBaseColour}, {kEmissive, {{"scale", {2, 2}}}}});
  b.append("materials", json(b.root["materials"][0]));
  const Scene scene = loadBuilt(b);
  EXPECT_EQ(scene.images.size(), 3u);
  EXPECT_EQ(scene.materials[0].emissiveTexture.image, scene.materials[1].emissiveTexture.image);
}

TEST(TextureTransforms, WarnsOfWhatNoImageCanShow) {
  for (const json& transform : {json{{"scale", {1.5, 1}}}, json{{"scale", {0, 0}}}, json{{"rotation", 0.3}},
                                json{{"texCoord", 1}}, json{{"scale", {1e38, 1e38}}}}) {
    const Scene scene = loadBuilt(withTextures({{kBaseColour}, {kEmissive, transform}}));
    EXPECT_THAT(scene.warnings,
                ElementsAre(HasSubstr("material 0 emissiveTexture: its texture coordinates differ")))
        << transform;
    EXPECT_EQ(scene.images.size(), 2u) << transform;
  }
  EXPECT_THAT(loadBuilt(withTextures({{kBaseColour}, {kNormal, {{"scale", {-2, 2}}}}})).warnings,
              ElementsAre(HasSubstr("normalTexture: its texture coordinates differ")));
  GltfBuilder clamped = withTextures({{kBaseColour}, {kEmissive, {{"scale", {2, 2}}}}});
  clamped.root["textures"][1]["sampler"] = clamped.append("samplers", {{"wrapS", 33071}});
  EXPECT_THAT(loadBuilt(clamped).warnings, ElementsAre(HasSubstr("texture coordinates differ")));
}

/// Its normal map, which nothing looks up, could move the base colour by parts of a texel, and blur it.
TEST(TextureTransforms, OfAnUnlitMaterialAreThoseOfItsBaseColour) {
  for (const json& base : {json::object(), json{{"offset", {0.3, 0}}}}) {
    GltfBuilder b =
        withTextures({{kBaseColour, base}, {kMetalRough}, {kNormal}, {kEmissive, {{"texCoord", 1}}}});
    b.root["textures"][2]["sampler"] = b.append("samplers", {{"wrapS", 33071}});
    b.root["materials"][0]["extensions"]["KHR_materials_unlit"] = json::object();
    const Scene scene = loadBuilt(b);
    EXPECT_THAT(scene.warnings, IsEmpty());
    EXPECT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(imageOf(scene, scene.materials.at(0).emissiveTexture).width, 8);
  }
}

TEST(TextureTransforms, ImagesStayWithinLimits) {
  const GltfBuilder wide = withTextures({{kBaseColour}, {kEmissive, {{"scale", {4096, 1}}}}});
  EXPECT_THAT(loadBuilt(wide).warnings, ElementsAre(HasSubstr("texture coordinates differ")));
  const GltfBuilder tiled = withTextures({{kBaseColour}, {kEmissive, {{"scale", {2, 2}}}}});
  scene::LoadLimits limits;
  limits.imageTexels = 4 * 16 * 8;
  EXPECT_THAT(scene::loadMemory(tiled.glb(), limits).warnings, IsEmpty());
  --limits.imageTexels;
  EXPECT_THAT(scene::loadMemory(tiled.glb(), limits).warnings,
              ElementsAre(HasSubstr("texture coordinates differ")));
}

}  // namespace
}  // namespace limn::test
