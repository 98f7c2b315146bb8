// Translucent materials, by extras.limn_subsurface and by drafts of Khronos: what is read, refused and warned
// of.
#include "tests/support/half_space_albedo.h"
#include "tests/support/png.h"
#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using json = nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

GltfBuilder withMaterial(json material) {
  material["name"] = "wax";
  GltfBuilder b;
  b.triangle(b.append("materials", std::move(material)));
  return b;
}

json translucent(const json& subsurface, double ior = 1.3) {
  return {{"extras", {{"limn_subsurface", subsurface}}},
          {"extensions", {{"KHR_materials_ior", {{"ior", ior}}}}}};
}

/// A draft's extension beside a volume of extinction ln 2 / 0.01 per metre, ln 4 / 0.01 and ln 10 / 0.01.
json drafted(const char* name, const json& scatter) {
  return {{"extensions",
           {{"KHR_materials_ior", {{"ior", 1.3}}},
            {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
            {"KHR_materials_volume",
             {{"thicknessFactor", 1}, {"attenuationDistance", 0.01}, {"attenuationColor", {0.5, 0.25, 0.1}}}},
            {name, scatter}}}};
}

std::string refusedSubsurface(const json& subsurface) {
  return loadError(withMaterial(translucent(subsurface)).glb());
}

TEST(SceneSubsurface, IsReadAsCoefficients) {
  const json skin{{"sigma_a", {32, 170, 480}}, {"sigma_s_prime", {740, 880, 1010}}};
  const scene::Scene scene = loadBuilt(withMaterial(translucent(skin)));
  EXPECT_THAT(scene.warnings, IsEmpty());
  const scene::Material& m = scene.materials.at(0);
  ASSERT_TRUE(m.subsurface);
  expectNear(m.subsurface->extinction, {772, 1050, 1490}, 1e-3f);
  expectNear(m.subsurface->absorption, {32 / 772.f, 170 / 1050.f, 480 / 1490.f}, 1e-6f);
  EXPECT_FALSE(m.subsurface->albedoFromBaseColour);
  EXPECT_EQ(m.metallic, 0);
  EXPECT_FALSE(m.specularSurface());
  // The base colour is what a half space of it reflects.
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(m.baseColour[c], halfSpaceAlbedo(1 - double(m.subsurface->absorption[c]), 1.3), 6e-4);
}

TEST(SceneSubsurface, TakesOneNumberForAllChannels) {
  const scene::Scene scene = loadBuilt(withMaterial(translucent({{"sigma_a", 0}, {"sigma_s_prime", 2000}})));
  ASSERT_TRUE(scene.materials.at(0).subsurface);
  expectNear(scene.materials[0].subsurface->extinction, glm::vec3(2000));
  expectNear(scene.materials[0].subsurface->absorption, glm::vec3(0));
  EXPECT_EQ(glm::vec3(scene.materials[0].baseColour), glm::vec3(1)) << "nothing is absorbed";
}

TEST(SceneSubsurface, AMeanFreePathTakesTheAlbedoFromTheBaseColour) {
  json material = translucent({{"mean_free_path", {0.001, 0.002, 0.004}}}, 1.5);
  material["pbrMetallicRoughness"]["baseColorFactor"] = {0.9, 0.5, 0, 1};
  const scene::Scene scene = loadBuilt(withMaterial(material));
  EXPECT_THAT(scene.warnings, IsEmpty());
  const scene::Material& m = scene.materials.at(0);
  ASSERT_TRUE(m.subsurface);
  EXPECT_TRUE(m.subsurface->albedoFromBaseColour);
  expectNear(m.subsurface->extinction, {1000, 500, 250}, 1e-3f);
  expectNear(glm::vec3(m.baseColour), {0.9, 0.5, 0});
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(halfSpaceAlbedo(1 - double(m.subsurface->absorption[c]), 1.5), m.baseColour[c], 6e-4);
}

TEST(SceneSubsurface, BadValuesAreRefused) {
  const std::string place = "material 0 'wax' limn_subsurface";
  const std::string accepted = ": an object {sigma_a, sigma_s_prime} or {mean_free_path} is accepted";
  EXPECT_THAT(refusedSubsurface(7), HasSubstr(place + accepted));
  EXPECT_THAT(refusedSubsurface({{"sigma_s", 1}}), HasSubstr(place + accepted));
  EXPECT_THAT(refusedSubsurface({{"sigma_a", 1}}), HasSubstr(place + accepted));
  EXPECT_THAT(refusedSubsurface({{"sigma_a", 1}, {"mean_free_path", 1}}), HasSubstr(place + accepted));
  EXPECT_THAT(refusedSubsurface({{"sigma_a", 1}, {"sigma_s_prime", 1}, {"mean_free_path", 1}}),
              HasSubstr(place + accepted));
  EXPECT_THAT(refusedSubsurface({{"sigma_a", {1, 2}}, {"sigma_s_prime", 1}}),
              HasSubstr(place + " sigma_a: 3 numbers are accepted"));
  EXPECT_THAT(refusedSubsurface({{"sigma_a", -1}, {"sigma_s_prime", 1}}),
              HasSubstr(place + " sigma_a: it must not be negative"));
  EXPECT_THAT(refusedSubsurface({{"sigma_a", 0}, {"sigma_s_prime", {1, 0, 1}}}),
              HasSubstr("is 0 per metre; 1e-06 to 1000000000 are accepted"));
  EXPECT_THAT(refusedSubsurface({{"mean_free_path", 0}}), HasSubstr("per metre; "));
  EXPECT_THAT(refusedSubsurface({{"mean_free_path", "thick"}}), HasSubstr(place + " mean_free_path"));
}

TEST(SceneSubsurface, AModelAndAnUnusedTextureAreWarnedOf) {
  json material = translucent({{"sigma_a", 1}, {"sigma_s_prime", 1}});
  material["extras"]["limn_material"] = {{"model", "phong"}};
  scene::Scene scene = loadBuilt(withMaterial(material));
  EXPECT_FALSE(scene.materials.at(0).subsurface);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("there is a limn_material too")));

  for (const bool lengths : {false, true}) {
    GltfBuilder b;
    const int index = b.texturedMaterial(png16(2, 2, {0, 16384, 32768, 65535}));
    b.root["materials"][0]["extras"]["limn_subsurface"] =
        lengths ? json{{"mean_free_path", 0.01}} : json{{"sigma_a", 1}, {"sigma_s_prime", 1}};
    b.triangle(index);
    scene = loadBuilt(b);
    EXPECT_EQ(scene.materials.at(0).baseColourTexture.image != scene::kNone, lengths);
    EXPECT_EQ(scene.warnings.size(), lengths ? 0u : 1u);
  }
}

// The albedo follows from the coefficients alone, whatever colours the mesh and the mask have.
TEST(SceneSubsurface, CoefficientsLeaveOfColoursOnlyTheMask) {
  for (const bool masked : {false, true})
    for (const bool lengths : {false, true}) {
      GltfBuilder b;
      const int index = b.texturedMaterial(png(1, 1, {10, 20, 30, 40}));
      b.root["materials"][0]["extras"]["limn_subsurface"] =
          lengths ? json{{"mean_free_path", 0.01}} : json{{"sigma_a", 1}, {"sigma_s_prime", 1}};
      if (masked) b.root["materials"][0]["alphaMode"] = "MASK";
      b.triangle(index);
      b.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
          b.vec4(std::vector<glm::vec4>(3, {0.5f, 0.25f, 0, 0.75f}));
      const scene::Scene scene = loadBuilt(b);
      const scene::TextureRef& texture = scene.materials.at(0).baseColourTexture;
      const std::vector<glm::vec4>& found = scene.meshes.at(0).primitives.at(0).colours;
      ASSERT_EQ(found.empty(), !lengths && !masked);
      ASSERT_EQ(texture.image == scene::kNone, !lengths && !masked);
      EXPECT_EQ(scene.warnings.size(), lengths ? 0u : 1u);
      if (found.empty()) continue;
      EXPECT_EQ(found[0], lengths ? glm::vec4(0.5f, 0.25f, 0, 0.75f) : glm::vec4(1, 1, 1, 0.75f));
      const std::vector<uint8_t>& texel = scene.images[static_cast<size_t>(texture.image)].levels.at(0).rgba;
      if (lengths) {
        EXPECT_THAT(texel, ElementsAre(10, 20, 30, 40));
      } else {
        EXPECT_THAT(texel, ElementsAre(255, 255, 255, 40));
      }
    }
}

// A mask without colours is read once and warned of by nobody.
TEST(SceneSubsurface, WhiteMasksStay) {
  GltfBuilder b;
  const int index = b.texturedMaterial(png(1, 1, {255, 255, 255, 40}));
  b.root["materials"][0]["extras"]["limn_subsurface"] = {{"sigma_a", 1}, {"sigma_s_prime", 1}};
  b.root["materials"][0]["alphaMode"] = "MASK";
  b.triangle(index);
  const scene::Scene scene = loadBuilt(b);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.materials.at(0).baseColourTexture.image, 0);
}

TEST(SceneSubsurface, DraftsOfKhronosSayTheSame) {
  for (const auto& [name, colour] : {std::pair{"KHR_materials_volume_scatter", "multiscatterColor"},
                                     std::pair{"KHR_materials_scatter", "multiscatterColorFactor"}}) {
    const scene::Scene scene = loadBuilt(withMaterial(drafted(name, {{colour, {0.2, 0.5, 0.9}}})));
    EXPECT_THAT(scene.warnings, IsEmpty());
    const scene::Material& m = scene.materials.at(0);
    ASSERT_TRUE(m.subsurface) << name;
    expectNear(m.subsurface->extinction, {69.31472f, 138.62944f, 230.25851f}, 1e-3f);
    EXPECT_FALSE(m.specularSurface()) << "scattering wins over glass";
    // Their albedo is that of a half space without a boundary.
    const glm::dvec3 given(0.2, 0.5, 0.9);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(halfSpaceAlbedo(1 - double(m.subsurface->absorption[c]), 1), given[c], 0.006) << name;
  }
}

scene::Subsurface anisotropic(const char* draft, const char* colour, double g) {
  return loadBuilt(withMaterial(drafted(draft, {{colour, {0.2, 0.5, 0.9}}, {"scatterAnisotropy", g}})))
      .materials.at(0)
      .subsurface.value();
}

TEST(SceneSubsurface, AnisotropyOfADraftIsReduced) {
  const auto read = [](double g) {
    return anisotropic("KHR_materials_volume_scatter", "multiscatterColor", g);
  };
  const scene::Subsurface isotropic = read(0), forward = read(0.8);
  // Absorption per metre is the same, scattering a fifth.
  expectNear(forward.absorption * forward.extinction, isotropic.absorption * isotropic.extinction, 1e-3f);
  expectNear((1.f - forward.absorption) * forward.extinction,
             0.2f * (1.f - isotropic.absorption) * isotropic.extinction, 1e-3f);
}

TEST(SceneSubsurface, AnisotropyOfTheNewerDraftLeavesTheColour) {
  const auto read = [](double g) {
    return anisotropic("KHR_materials_scatter", "multiscatterColorFactor", g);
  };
  const scene::Subsurface isotropic = read(0), forward = read(0.8), backward = read(-0.8);
  expectNear(forward.absorption, isotropic.absorption, 1e-6f);
  expectNear(backward.absorption, isotropic.absorption, 1e-6f);
  // By hand: s = 0.2971 for an albedo of 0.5, and (1 - g) / (1 - g s^2) of the extinction is left.
  EXPECT_NEAR(isotropic.absorption.y, 0.0883f, 1e-4f);
  EXPECT_NEAR(forward.extinction.y / isotropic.extinction.y, 0.2152f, 1e-4f);
}

TEST(SceneSubsurface, DraftsWithoutAVolumeAreIgnoredWithAWarning) {
  const json scatter{{"multiscatterColor", {0.5, 0.5, 0.5}}};
  json thin = drafted("KHR_materials_volume_scatter", scatter), clear = thin, wall = thin;
  thin["extensions"].erase("KHR_materials_volume");
  clear["extensions"]["KHR_materials_volume"]["attenuationColor"] = {1, 0.5, 0.5};
  wall["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 0;
  for (const json& material : {thin, clear, wall}) {
    const scene::Scene scene = loadBuilt(withMaterial(material));
    EXPECT_FALSE(scene.materials.at(0).subsurface);
    EXPECT_EQ(scene.materials[0].transmission, 1) << "glass stays glass";
    EXPECT_THAT(scene.warnings,
                ElementsAre(HasSubstr("material 0 'wax' KHR_materials_volume_scatter is ignored: ")));
  }
}

TEST(SceneSubsurface, PartsOfADraftThatAreNotReadAreNamed) {
  const scene::Scene scene =
      loadBuilt(withMaterial(drafted("KHR_materials_scatter", {{"scatterStrengthFactor", 0.5}})));
  EXPECT_THAT(scene.warnings,
              ElementsAre(HasSubstr("KHR_materials_scatter: scatterStrengthFactor is ignored")));
}

}  // namespace
}  // namespace limn::test
