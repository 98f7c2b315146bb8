// glTF extensions of textures: WebP, and the specular-glossiness model, whose textures are converted.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "glsl/surface/gbuffer.glsl"
#include "tests/support/png.h"
#include "tests/support/scene_files.h"
#include "tests/support/webp.h"

namespace limn::test {
namespace {

using json = nlohmann::json;
using scene::Material;
using scene::Scene;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

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
  EXPECT_EQ(imageOf(scene, m.baseColourTexture).rgba, rgba);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(WebpTextures, AreReadFromDataUris) {
  GltfBuilder b = webpMaterial(losslessWebp(1, 1, {1, 2, 3, 4}));
  b.root["images"][0] = {
      {"uri", "data:image/webp;base64,UklGRh4AAABXRUJQVlA4TBEAAAAvAAAAEAdQiirUoyiBiOh/AAA="}};
  const Scene scene = loadBuilt(b);
  EXPECT_TRUE(scene.warnings.empty());
  const scene::TextureRef texture = scene.materials.at(0).baseColourTexture;
  ASSERT_NE(texture.image, scene::kNone);
  EXPECT_THAT(imageOf(scene, texture).rgba, ElementsAre(10, 20, 30, 40));
  b.root["images"][0]["uri"] = "data:image/webp,RIFF";
  EXPECT_THAT(loadBuilt(b).warnings,
              ElementsAre(AllOf(HasSubstr("the data URI cannot be decoded"), HasSubstr("goes without it"))));
}

TEST(WebpTextures, OthersStandInWhereTheyCannotBeRead) {
  const std::vector<std::byte> webp = losslessWebp(1, 1, {10, 20, 30, 40}),
                               other = png(1, 1, {50, 60, 70, 80});
  const auto shown = [](const Scene& scene) {
    return imageOf(scene, scene.materials.at(0).baseColourTexture).rgba;
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

/// What a dielectric mirrors at normal incidence, all but 0.4 % of the file's specular colour.
glm::vec3 headOn(const Material& m) {
  const float ratio = (m.ior - 1) / (m.ior + 1);
  return ratio * ratio * m.specularColour;
}

TEST(SpecularGlossiness, FactorsBecomeMetallicRoughness) {
  const Scene scene = loadBuilt(glossy({{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}},
                                        {"specularFactor", {0.9, 0.6, 0.3}},
                                        {"glossinessFactor", 0.75}}));
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.baseColour, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.metallic, 0);
  EXPECT_EQ(m.roughness, 0.25f);
  expectNear(headOn(m), {0.9f, 0.6f, 0.3f}, 0.004f);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("is converted")));
  const Material standard = loadBuilt(glossy(json::object())).materials.at(0);
  EXPECT_EQ(standard.baseColour, glm::vec4(1));
  EXPECT_EQ(standard.roughness, 0);
  EXPECT_EQ(standard.specularColour, glm::vec3(1));
}

/// The G-buffer has 31 steps for colours: of 0.04, the usual one, 0.033 would be left.
TEST(SpecularGlossiness, DarkSpecularColoursReachTheGBuffer) {
  for (const glm::vec3& colour :
       {glm::vec3(0.04f, 0.04f, 0.02f), glm::vec3(0.1f), glm::vec3(0.3f, 0.2f, 0.1f)}) {
    Material m = loadBuilt(glossy({{"specularFactor", {colour.x, colour.y, colour.z}}})).materials.at(0);
    m.specularColour = glsl::colour_from_half_bits(glsl::colour_to_half_bits(m.specularColour));
    m.ior = glsl::gbuffer_ior_decode(std::round(255 * glsl::gbuffer_ior_encode(m.ior)) / 255);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(headOn(m)[c] / colour[c], 1, 0.03) << "channel " << c;
  }
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
  const auto srgb = [&](const scene::TextureRef& texture) {
    return scene.images.at(static_cast<std::size_t>(texture.image)).srgb;
  };
  EXPECT_TRUE(srgb(m.baseColourTexture));
  EXPECT_THAT(imageOf(scene, m.baseColourTexture).rgba, ElementsAre(10, 20, 30, 40));
  EXPECT_FALSE(srgb(m.metalRoughTexture));
  EXPECT_THAT(imageOf(scene, m.metalRoughTexture).rgba, ElementsAre(0, 128, 0, 255, 0, 255, 0, 255));
  EXPECT_EQ(m.roughness, 1);
  expectNear(headOn(m), {0.5f, 0.5f, 0}, 0.0021f);
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
  for (const Material& m : scene.materials) expectNear(headOn(m), glm::vec3(0.5f), 0.0021f);
  EXPECT_EQ(std::ranges::count_if(scene.warnings,
                                  [](const std::string& w) { return w.find("the mean of its") < w.size(); }),
            3)
      << "each material says so";
}

TEST(SpecularGlossiness, ADamagedImageOfSeveralMaterialsIsReadOnce) {
  GltfBuilder b = glossy({{"specularGlossinessTexture", {{"index", 0}}}});
  std::vector<std::byte> image = png(2, 2, std::vector<std::uint8_t>(16));
  image[50] ^= std::byte{1};
  b.append("images", {{"bufferView", b.view(image.data(), image.size())}, {"mimeType", "image/png"}});
  b.append("textures", {{"source", 0}});
  json& materials = b.root["materials"];
  for (const double factor : {0.25, 0.5}) {
    materials.push_back(json(materials[0]));
    materials.back()["extensions"]["KHR_materials_pbrSpecularGlossiness"]["glossinessFactor"] = factor;
  }
  scene::LoadLimits limits;
  limits.imageTexels = 4;
  const Scene scene = scene::loadMemory(b.glb(), limits);
  for (const Material& m : scene.materials) EXPECT_EQ(m.metalRoughTexture.image, scene::kNone);
  EXPECT_EQ(std::ranges::count_if(scene.warnings,
                                  [](const std::string& w) { return w.find("goes without it") < w.size(); }),
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
