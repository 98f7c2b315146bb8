// Material models as products of tables, in place of their formulas.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/gpu_scene/gpu_scene.h"
#include "core/technique/technique.h"
#include "techniques/factored_brdf/material_fits.h"

namespace {

using namespace limn;
using brdf::Factorisation;

constexpr const char* kFits[] = {"analytic", "exact", "tables", "dfg", "pqp", "pqp_disc", "svd", "trilinear"};
enum Fit { analytic, exact, tables, dfg, pqp, pqpDisc, svd, trilinear };
constexpr const char* kCoordinates[] = {"warped", "published"};
constexpr const char* kFormats[] = {"float32", "half", "byte"};
constexpr GLenum kTextureFormats[] = {GL_RGBA32F, GL_RGBA16F, GL_RGBA8};

/// Pairs of directions that a numerical fit looks at. With 20000, pqp_disc loses a seventh of its error on
/// metals and dfg nothing, for up to twice the time.
constexpr int kSamples = 8000;

constexpr Parameter kParameters[] = {
    choice(
        "fit", analytic, kFits,
        "How models become tables. analytic: Torrance-Sparrow alone, by its formula; exact: none does; the "
        "others fit every model that they can hold, when the graph is built"),
    integer("terms", 1, {1, 16}, "", "Products that svd takes the sum of"),
    integer(
        "fit_texels", 0, {0, 512}, "texels",
        "Texels along each axis of a fit (of trilinear along n.h, half of that along the others); svd has "
        "48 at most. 0: 64 for dfg and pqp, 32 for pqp_disc and trilinear, 24 for svd, 128 for tables"),
    integer("texels", 128, {2, 2048}, "texels", "Width and height of both analytic tables")
        .quality()
        .logScale(),
    choice(
        "coordinates", 0, kCoordinates,
        "What the tables of analytic and tables lie over, and the discs of pqp_disc. warped: sqrt(1 - n.h) "
        "and roots of the cosines, in which a lobe is as wide as its roughness; published: the cosines, in "
        "which it is as wide as the square of that"),
    choice(
        "format", 1, kFormats,
        "What holds the values. byte clamps G / (pi n.v) of analytic tables to 1, as published tables of 8 "
        "bits did; the other fits take half then"),
};
constexpr StressCase kStress[] = {
    {.name = "tables of 2 texels", .settings = "texels=2", .factor = 100},
    {.name = "published coordinates", .settings = "coordinates=published", .factor = 100},
    {.name = "8 bits", .settings = "format=byte", .factor = 100},
    {.name = "dfg of 2 texels", .scene = "torus_metal", .settings = "fit=dfg fit_texels=2", .factor = 0},
    {.name = "svd of 2 texels", .scene = "torus_metal", .settings = "fit=svd fit_texels=2", .factor = 0},
    {.name = "volumes of 2 texels",
     .scene = "torus_metal",
     .settings = "fit=trilinear fit_texels=2",
     .factor = 0},
    {.name = "fits of other models", .scene = "disk_and_sphere", .settings = "fit=pqp_disc", .factor = 100},
};

/// Returns what a fit takes where no number of texels is given.
int defaultTexels(int fit) {
  switch (fit) {
    case dfg:
    case pqp:
      return 64;
    case svd:
      return 24;
    case tables:
      return 128;
    default:
      return 32;
  }
}

Factorisation factorisation(int fit) {
  switch (fit) {
    case dfg:
      return Factorisation::dfg;
    case pqp:
      return Factorisation::pqp;
    case pqpDisc:
      return Factorisation::pqp_disc;
    case svd:
      return Factorisation::svd;
    case trilinear:
      return Factorisation::trilinear;
    default:
      return Factorisation::tables;
  }
}

factored::FitChoice described(const ParameterValues& parameters) {
  const int fit = parameters.choice("fit");
  factored::FitChoice choice;
  choice.analytic = fit == analytic;
  choice.fit.factorisation = factorisation(fit);
  choice.fit.terms = parameters.integer("terms");
  choice.fit.warped = parameters.choice("coordinates") == 0;
  choice.fit.samples = kSamples;
  choice.fit.format = static_cast<brdf::TableFormat>(parameters.choice("format"));
  if (choice.analytic) {
    choice.fit.texels = parameters.integer("texels");
    return choice;
  }
  const int asked = parameters.integer("fit_texels");
  choice.fit.texels = asked == 0 ? defaultTexels(fit) : std::max(asked, 2);
  if (choice.fit.format == brdf::TableFormat::byte) choice.fit.format = brdf::TableFormat::half;
  return choice;
}

class FactoredBrdf : public Technique {
  gpu::Texture tables_[2];  ///< layers of each fit, behind each other; the second of two-table fits alone
  gpu::Texture materials_;  ///< of each material, row 0: scale and fit (-1: none), row 1: floor

  frame::TextureHandle addPasses(frame::FrameGraph&, const TechniqueInputs&,
                                 const TermRequest& request) override {
    return request.target;
  }

  scene::SurfaceAnswer surface(frame::FrameGraph& graph, const TechniqueInputs& inputs) override {
    scene::SurfaceAnswer answer;
    answer.file = "techniques/factored_brdf/response.glsl";
    if (inputs.parameters.choice("fit") == exact) {
      answer.defines = {{"FACTORED_FIT", "FACTORED_EXACT"}};
      return answer;
    }
    const factored::FitChoice choice = described(inputs.parameters);
    const factored::MaterialFits fits = factored::fitMaterials(inputs.scene, choice);
    for (const factored::MaterialFits::Exact& left : fits.exact)
      graph.leaveOut(fmt::format("tables of {}", left.material), info.name, left.reason);
    if (fits.fits.empty()) {
      answer.defines = {{"FACTORED_FIT", "FACTORED_EXACT"}};
      return answer;
    }
    upload(inputs.gpuScene.device(), fits);
    static constexpr const char* kProducts[] = {"TABLES", "DFG", "PQP", "PQP_DISC", "SVD", "TRILINEAR"};
    const std::vector<brdf::FactorTable>& first = fits.fits.front().tables;
    answer.defines = {
        {"FACTORED_FIT", fmt::format("FACTORED_{}", kProducts[static_cast<int>(choice.fit.factorisation)])},
        {"FACTORED_COMPLETE", fits.complete(inputs.scene) ? "1" : "0"},
        {"FACTORED_WARPED", choice.fit.warped ? "true" : "false"},
        {"FACTORED_LAYERS", fmt::format("{}", first.front().depth)}};
    answer.textures = {{"factored_1", graph.importTexture("factors", tables_[0]), "what f is a product of"},
                       {"factored_materials", graph.importTexture("tables of materials", materials_),
                        "which tables a material has"}};
    if (first.size() > 1)
      answer.textures.push_back(
          {"factored_2", graph.importTexture("second factors", tables_[1]), "what f is a product of"});
    return answer;
  }

  void upload(gpu::Device& device, const factored::MaterialFits& fits) {
    for (size_t t = 0; t < fits.fits.front().tables.size(); ++t) tables_[t] = layers(device, fits.fits, t);
    std::vector<glm::vec4> rows;
    for (const factored::MaterialFits::Row& row : fits.rows)
      rows.emplace_back(row.scale, static_cast<float>(row.fit));
    for (const factored::MaterialFits::Row& row : fits.rows) rows.emplace_back(row.floor, 0.f);
    materials_ =
        gpu::Texture(device, "tables of materials",
                     {.format = GL_RGBA32F, .width = static_cast<int>(fits.rows.size()), .height = 2});
    materials_.upload(0, 0, GL_RGBA, GL_FLOAT, rows.data());
  }

  static gpu::Texture layers(gpu::Device& device, const std::vector<brdf::FactoredBrdf>& fits, size_t table) {
    const brdf::FactorTable& first = fits.front().tables[table];
    gpu::Texture texture(device, table == 0 ? "factors" : "second factors",
                         {.target = GL_TEXTURE_2D_ARRAY,
                          .format = kTextureFormats[static_cast<int>(first.format)],
                          .width = first.width,
                          .height = first.height,
                          .layers = first.depth * static_cast<int>(fits.size())});
    texture.setSampling(GL_LINEAR, GL_LINEAR);
    for (size_t i = 0; i < fits.size(); ++i)
      for (int z = 0; z < first.depth; ++z)
        texture.upload(0, static_cast<int>(i) * first.depth + z, GL_RGB, GL_FLOAT,
                       &fits[i].tables[table].at(0, 0, z));
    return texture;
  }

 public:
  static constexpr TechniqueInfo info{
      .name = "factored_brdf",
      .title = "Factored BRDFs",
      .source = "Heidrich and Seidel 1999; McCool, Ang and Ahmad 2001; Kautz and McCool 1999",
      .terms = termSet(Term::surface),
      .parameters = kParameters,
      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(FactoredBrdf::info, FactoredBrdf)
