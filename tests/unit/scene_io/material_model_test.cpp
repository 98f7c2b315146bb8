// extras.limn_material: what is read, what is refused, and the metallic-roughness that stands beside a model.
#include "core/scene/material_model.h"

#include "core/brdf/measured_file.h"
#include "glsl/surface/reflectance.glsl"
#include "tests/support/material_models.h"
#include "tests/support/png.h"
#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using json = nlohmann::json;
using scene::Material;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

GltfBuilder withModel(const json& model) {
  GltfBuilder b;
  b.append("materials", {{"extras", {{"limn_material", model}}}});
  b.triangle(0);
  return b;
}

scene::Scene loaded(const json& model) {
  return loadBuilt(withModel(model));
}

std::string refusal(const json& model) {
  return loadError(withModel(model).glb());
}

TEST(SceneMaterialModel, IsReadWithAllItsNumbers) {
  const scene::Scene scene = loaded({{"model", "ward"},
                                     {"roughness", {0.1, 0.4}},
                                     {"eta", {0.25, 1, 1.5}},
                                     {"k", 2},
                                     {"kd", {0.125, 0.25, 0.5}},
                                     {"distribution", "gaussian"},
                                     {"masking", "product"}});
  EXPECT_THAT(scene.warnings, IsEmpty());
  const Material& material = scene.materials.at(0);
  ASSERT_TRUE(material.model);
  EXPECT_EQ(material.model->kind, glsl::model_ward);
  EXPECT_EQ(material.model->roughness, glm::vec2(0.1f, 0.4f));
  EXPECT_EQ(material.model->eta, glm::vec3(0.25f, 1, 1.5f));
  EXPECT_EQ(material.model->k, glm::vec3(2));
  EXPECT_EQ(material.model->kd, glm::vec3(0.125f, 0.25f, 0.5f));
  EXPECT_EQ(material.model->options, glsl::model_option_gaussian | glsl::model_option_product);
  EXPECT_TRUE(material.tangents());
  EXPECT_FALSE(material.lambertian() || material.specularSurface());
}

TEST(SceneMaterialModel, HasDefaults) {
  for (const auto& [name, kind] :
       {std::pair{"torrance_sparrow", glsl::model_torrance_sparrow}, std::pair{"phong", glsl::model_phong},
        std::pair{"banks", glsl::model_banks}, std::pair{"coated", glsl::model_coated}}) {
    const scene::Scene scene = loaded({{"model", name}});
    const glsl::MaterialModel& m = scene.materials.at(0).model.value();
    EXPECT_EQ(m.kind, kind) << name;
    EXPECT_EQ(m.eta, glm::vec3(1.5f)) << name;
    EXPECT_EQ(m.options, 0u) << name;
  }
  EXPECT_FALSE(loadBuilt(GltfBuilder()).materials.size() > 0);
}

TEST(SceneMaterialModel, RefusesWhatItDoesNotKnowInOneLine) {
  EXPECT_THAT(refusal("phong"), HasSubstr("limn_material: an object with a model is accepted"));
  EXPECT_THAT(refusal({{"roughness", 1}}),
              HasSubstr("torrance_sparrow, ward, banks, phong, coated and measured"));
  EXPECT_THAT(refusal({{"model", "blinn"}}), HasSubstr("limn_material model: 'blinn'"));
  EXPECT_THAT(refusal({{"model", "ward"}, {"roughness", {1, 2, 3}}}),
              HasSubstr("roughness: 2 numbers are accepted"));
  EXPECT_THAT(refusal({{"model", "phong"}, {"kd", {1, 2}}}), HasSubstr("kd: 3 numbers are accepted"));
  EXPECT_THAT(refusal({{"model", "banks"}, {"banks", "kajiya"}}),
              HasSubstr("banks: 'kajiya'; stalling and printed are accepted"));
  EXPECT_THAT(refusal({{"model", "coated"}, {"combine", 3}}),
              HasSubstr("combine: ''; sum, blend and physical are accepted"));
}

TEST(SceneMaterialModel, ClampsWithAWarning) {
  const scene::Scene scene =
      loaded({{"model", "torrance_sparrow"}, {"roughness", 7}, {"eta", 0}, {"k", -1}, {"kd", -2}});
  EXPECT_EQ(scene.warnings.size(), 4u);
  const glsl::MaterialModel& m = scene.materials.at(0).model.value();
  EXPECT_EQ(m.roughness, glm::vec2(1));
  EXPECT_GT(m.eta.x, 0);
  EXPECT_EQ(m.k, glm::vec3(0));
  EXPECT_EQ(m.kd, glm::vec3(0));
}

TEST(SceneMaterialModel, ReflectsNoMoreLightThanThereIs) {
  const scene::Scene phong = loaded({{"model", "phong"}, {"kd", 0.75}, {"ks", 0.75}});
  EXPECT_THAT(phong.warnings, ElementsAre(HasSubstr("up to 1.5 times the light")));
  EXPECT_FLOAT_EQ(phong.materials.at(0).model->kd.x, 0.5f);
  const scene::Scene hair = loaded({{"model", "banks"}, {"kd", 1}, {"ks", 1}, {"exponent", 32}});
  EXPECT_LE(glsl::model_excess(*hair.materials.at(0).model), 1.0001f);
}

TEST(SceneMaterialModel, TheMetalBesideItReflectsAsMuchDiffuseLight) {
  for (const NamedModel& named : materialModels()) {
    Material material;
    scene::setModel(material, named.model);
    const glsl::SurfaceBrdf metal = glsl::surface_brdf(glm::vec3(material.baseColour), material.metallic,
                                                       material.roughness, 1, glm::vec3(1), 1.5f);
    expectNear(glsl::hemispherical_reflectance(metal),
               glm::max(glsl::model_albedo(named.model), glm::vec3(glsl::mean_schlick_weight)), 1e-4f);
  }
}

TEST(SceneMaterialModel, LiesAlongRisingUWhereTheFileHasNoTangents) {
  const scene::Scene scene = loaded({{"model", "ward"}, {"roughness", {0.1, 0.4}}});
  EXPECT_THAT(scene.warnings, IsEmpty());
  const scene::Primitive& primitive = scene.meshes.at(0).primitives.at(0);
  ASSERT_EQ(primitive.tangents.size(), 3u);
  expectNear(glm::vec3(primitive.tangents[0]), {1, 0, 0});
  EXPECT_TRUE(loaded({{"model", "ward"}, {"roughness", 0.1}}).meshes.at(0).primitives.at(0).tangents.empty());
}

TEST(SceneMaterialModel, LeavesTexturesOfMetallicRoughnessAside) {
  GltfBuilder b;
  const int material = b.texturedMaterial(png(1, 1, {1, 2, 3, 4}));
  b.root["materials"][static_cast<size_t>(material)]["extras"]["limn_material"] = {{"model", "phong"}};
  b.triangle(material);
  const scene::Scene scene = loadBuilt(b);
  EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("textures of metallic-roughness have no part")));
  EXPECT_EQ(scene.materials.at(static_cast<size_t>(material)).baseColourTexture.image, scene::kNone);
}

class MeasuredMaterial : public SceneFiles {
 protected:
  /// Writes a scene whose materials name these files.
  std::filesystem::path scene(const std::vector<json>& models) {
    GltfBuilder b;
    for (const json& model : models) b.append("materials", {{"extras", {{"limn_material", model}}}});
    b.triangle(0);
    return write("scene/scene.glb", b.glb());
  }
};

TEST_F(MeasuredMaterial, IsReadFromAFileOnceAndReflectsNoMoreThanThereIs) {
  const auto white = [](const glm::vec3&, const glm::vec3&) { return glm::vec3(2 / glsl::pi); };
  const brdf::AnisotropicTable table = brdf::tabulateAnisotropic(4, white);
  brdf::writeMeasured(folder_ / "scene" / "white.bsdf", table, brdf::MeasuredFormat::float32);
  const json model = {{"model", "measured"}, {"file", "white.bsdf"}};
  json half = model;
  half["ks"] = 0.5;
  const scene::Scene loaded = scene::load(scene({model, half}));
  EXPECT_THAT(loaded.warnings, ElementsAre(HasSubstr("white.bsdf' reflects up to 2 times the light")));
  EXPECT_EQ(loaded.measured, table.values);
  const glsl::MaterialModel& m = loaded.materials.at(0).model.value();
  EXPECT_EQ(m.kind, glsl::model_measured);
  EXPECT_EQ(glsl::measured_size(m.nodes), glm::uvec3(4, 0, 0));
  expectNear(m.ks, glm::vec3(0.5f), 0.01f);
  expectNear(glsl::model_albedo(m), glm::vec3(1), 0.01f);
  expectNear(glsl::model_albedo(*loaded.materials.at(1).model), glm::vec3(0.5f), 0.01f);
  expectNear(glsl::model_response(loaded.measured, m, {0, 0, 1}, {0, 0.6f, 0.8f}), glm::vec3(0.8f / glsl::pi),
             0.003f);
}

TEST_F(MeasuredMaterial, RefusesFilesInOneLine) {
  EXPECT_THAT(loadError(scene({{{"model", "measured"}}})), HasSubstr("file: the name of a file"));
  EXPECT_THAT(loadError(scene({{{"model", "measured"}, {"file", "none.bsdf"}}})), HasSubstr("none.bsdf"));
  EXPECT_THAT(loadError(scene({{{"model", "measured"}, {"file", "../x.bsdf"}}})),
              HasSubstr("lies outside the scene's folder"));
  write("scene/short.bsdf", std::vector<std::byte>(11));
  EXPECT_THAT(loadError(scene({{{"model", "measured"}, {"file", "short.bsdf"}}})),
              HasSubstr("limn_material file 'short.bsdf': not a BRDF file of the RGL"));
  write("scene/short.binary", std::vector<std::byte>(11));
  EXPECT_THAT(loadError(scene({{{"model", "measured"}, {"file", "short.binary"}}})),
              HasSubstr("material 0 limn_material file 'short.binary'"));
}

}  // namespace
}  // namespace limn::test
