// Torrance-Sparrow materials as a product of two tables, in place of their formula.
#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "core/brdf/factor_tables.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/scene/scene.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;
using frame::Access;

constexpr const char* kCoordinates[] = {"warped", "published"};
constexpr const char* kFormats[] = {"float32", "half", "byte"};
constexpr GLenum kTextureFormats[] = {GL_RGBA32F, GL_RGBA16F, GL_RGBA8};

constexpr Parameter kParameters[] = {
    integer("texels", 128, {2, 2048}, "texels", "Width and height of both tables").quality().logScale(),
    choice("coordinates", 0, kCoordinates,
           "What the tables lie over. warped: sqrt(1 - n.h) and roots of the cosines, in which a lobe is as "
           "wide "
           "as its roughness; published: the cosines, in which it is as wide as the square of that"),
    choice("format", 1, kFormats,
           "What holds their values. byte clamps G / (pi n.v) to 1, as published tables of 8 bits did"),
};
constexpr StressCase kStress[] = {
    {.name = "tables of 2 texels", .settings = "texels=2", .factor = 100},
    {.name = "published coordinates", .settings = "coordinates=published", .factor = 100},
    {.name = "8 bits", .settings = "format=byte", .factor = 100},
};

brdf::TorranceSparrow described(const glsl::MaterialModel& m) {
  using namespace glsl;
  return {.eta = glm::dvec3(m.eta),
          .k = glm::dvec3(m.k),
          .roughness = static_cast<double>(m.roughness.x),
          .distribution = (m.options & model_option_gaussian) != 0 ? brdf::NormalDistribution::gaussian
                                                                   : brdf::NormalDistribution::beckmann,
          .masking =
              (m.options & model_option_product) != 0 ? brdf::Masking::product : brdf::Masking::correlated};
}

/// Says whether two models have the same tables.
bool alike(const glsl::MaterialModel& a, const glsl::MaterialModel& b) {
  return a.eta == b.eta && a.k == b.k && a.roughness.x == b.roughness.x && a.options == b.options;
}

class FactoredBrdf : public Technique {
  gpu::Texture tables_[2];  ///< a layer for each model
  gpu::Texture layers_;     ///< of each material: the factor of its tables, and their layer

  frame::TextureHandle addPasses(frame::FrameGraph&, const TechniqueInputs&,
                                 const TermRequest& request) override {
    return request.target;
  }

  scene::SurfaceAnswer surface(frame::FrameGraph& graph, const TechniqueInputs& inputs) override {
    makeTables(inputs);
    return {.file = "techniques/factored_brdf/response.glsl",
            .defines = {{"FACTORED_WARPED", inputs.parameters.choice("coordinates") == 0 ? "true" : "false"}},
            .textures = {{"factored_1", graph.importTexture("Fresnel's term and distribution", tables_[0]),
                          "over h.l and n.h"},
                         {"factored_2", graph.importTexture("masking", tables_[1]), "over n.l and n.v"},
                         {"factored_layers", graph.importTexture("tables of materials", layers_),
                          "which tables a material has"}}};
  }

  void makeTables(const TechniqueInputs& inputs) {
    const auto format = static_cast<size_t>(inputs.parameters.choice("format"));
    const int size = inputs.parameters.integer("texels");
    std::vector<glsl::MaterialModel> models;
    std::vector<brdf::FactoredBrdf> made;
    std::vector<glm::vec4> layers;
    for (const scene::Material& material : inputs.scene.materials) {
      glm::vec4& layer = layers.emplace_back(0);
      if (!material.model || material.model->kind != glsl::model_torrance_sparrow) continue;
      auto found = std::ranges::find_if(models, [&](const auto& m) { return alike(m, *material.model); });
      if (found == models.end()) {
        made.push_back(brdf::torranceSparrowTables(described(*material.model), size, size,
                                                   inputs.parameters.choice("coordinates") == 0,
                                                   static_cast<brdf::TableFormat>(format)));
        found = models.insert(models.end(), *material.model);
      }
      const auto index = static_cast<size_t>(found - models.begin());
      layer = glm::vec4(glm::vec3(made[index].scale), static_cast<float>(index));
    }
    gpu::Device& device = inputs.gpuScene.device();
    for (size_t t = 0; t < std::size(tables_); ++t)
      tables_[t] = upload(device, made, t, size, kTextureFormats[format]);
    layers_ = gpu::Texture(
        device, "tables of materials",
        {.format = GL_RGBA32F, .width = static_cast<int>(std::max<size_t>(1, layers.size())), .height = 1});
    if (!layers.empty()) layers_.upload(0, 0, GL_RGBA, GL_FLOAT, layers.data());
  }

  static gpu::Texture upload(gpu::Device& device, const std::vector<brdf::FactoredBrdf>& made, size_t table,
                             int size, GLenum format) {
    gpu::Texture texture(device, table == 0 ? "Fresnel's term and distribution" : "masking",
                         {.target = GL_TEXTURE_2D_ARRAY,
                          .format = format,
                          .width = size,
                          .height = size,
                          .layers = std::max(1, static_cast<int>(made.size()))});
    texture.setSampling(GL_LINEAR, GL_LINEAR);
    for (size_t i = 0; i < made.size(); ++i)
      texture.upload(0, static_cast<int>(i), GL_RGB, GL_FLOAT, made[i].tables[table].texels.data());
    return texture;
  }

 public:
  static constexpr TechniqueInfo info{.name = "factored_brdf",
                                      .title = "Factored BRDFs",
                                      .source = "Realistic materials, section 1; Torrance and Sparrow 1967",
                                      .terms = termSet(Term::surface),
                                      .parameters = kParameters,
                                      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(FactoredBrdf::info, FactoredBrdf)
