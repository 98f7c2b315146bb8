// glTF extensions of materials: unlit ones, specular colours, and what is left out with a warning.
#include <utility>
#include <vector>

#include "tests/support/png.h"
#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using json = nlohmann::json;
using scene::Material;
using scene::Scene;
using testing::ElementsAre;
using testing::HasSubstr;

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
  expectNear(glm::vec3(scene.meshes.at(0).primitives.at(0).colours.at(0)), colours[0]);
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

/// The G-buffer holds an index near 1.5 finely and a dark colour in few steps.
TEST(SpecularColours, OfAnInfiniteIndexGiveTheIndexThatReflectsAsMuch) {
  const json colour = json::array({0.04, 0.04, 0.02});
  const Material m = withSpecularColour(colour, 0).materials.at(0);
  expectNear(m.specularColour, {1, 1, 0.5f});
  EXPECT_NEAR(m.ior, 1.5, 0.005) << "0.4 % less than 0.04 head-on";
  const Scene glass =
      withSpecularColour(colour, 0, {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}});
  EXPECT_EQ(glass.materials.at(0).ior, 1000.f) << "light is refracted by it";
  expectNear(glass.materials.at(0).specularColour, {0.04f, 0.04f, 0.02f});
  EXPECT_TRUE(glass.warnings.empty());
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
                    LeftOut{"MorphedTextureCoordinates",
                            R"([{"op": "add", "path": "/meshes/0/primitives/0/targets",
                     "value": [{"POSITION": 2, "TEXCOORD_0": 4}, {"TEXCOORD_0": 4}]}])",
                            "mesh 0 'm' primitive 0: morph targets of TEXCOORD_0 are ignored"},
                    LeftOut{"AnimationPointer",
                            R"([{"op": "add", "path": "/extensionsUsed", "value": ["KHR_animation_pointer"]},
                    {"op": "add", "path": "/animations/0/channels/-",
                     "value": {"sampler": 0, "target": {"path": "pointer", "extensions":
                       {"KHR_animation_pointer": {"pointer": "/nodes/0/scale"}}}}}])",
                            "what these extensions add is not read: KHR_animation_pointer"}),
    [](const auto& made) { return made.param.name; });

}  // namespace
}  // namespace limn::test
