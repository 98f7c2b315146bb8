// Material models as products of tables, in place of their formulas.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "core/gpu_scene/gpu_scene.h"
#include "core/technique/technique.h"
#include "glsl/materials/material_model.glsl"
#include "techniques/factored_brdf/material_fits.h"

namespace {

using namespace limn;
using brdf::Factorisation;

constexpr const char* kFits[] = {"analytic", "exact",    "tables", "dfg",      "pqp",
                                 "pqp_disc", "dfg_disc", "svd",    "trilinear"};
enum Fit { analytic, exact, tables, dfg, pqp, pqpDisc, dfgDisc, svd, trilinear };
constexpr const char* kCoordinates[] = {"warped", "published"};
constexpr const char* kFormats[] = {"float32", "half", "byte"};
constexpr const char* kFresnelTerms[] = {"exact", "schlick"};
constexpr GLenum kTextureFormats[] = {GL_RGBA32F, GL_RGBA16F, GL_RGBA8};

/// Pairs of directions that a numerical fit looks at. With 20000, pqp_disc loses a seventh of its error on
/// metals and dfg nothing, for up to twice the time.
constexpr int kSamples = 8000;

constexpr Parameter kParameters[] = {
    choice("fit", analytic, kFits,
           "How models become tables. analytic: Torrance-Sparrow, Ward and Banks alone, by their formulas; "
           "exact: "
           "none does; the others fit every model that they can hold, when the graph is built"),
    integer("terms", 1, {1, 16}, "",
            "Products that a fit is the sum of: at most 16 of svd, 2 of dfg, pqp, pqp_disc and dfg_disc, and "
            "one of the others"),
    integer(
        "fit_texels", 0, {0, 512}, "texels",
        "Texels along each axis of a fit (of trilinear along n.h, half of that along the others); svd has "
        "48 at most. 0: 64 for dfg and pqp, 32 for pqp_disc, dfg_disc and trilinear, 24 for svd, 128 for "
        "tables"),
    integer("texels", 128, {2, 2048}, "texels", "Width and height of analytic tables").quality().logScale(),
    choice(
        "coordinates", 0, kCoordinates,
        "What the tables of analytic and tables lie over, and the half vector's discs. warped: sqrt(1 - n.h) "
        "and roots of the cosines, in which a lobe is as wide as its roughness; published: the cosines, in "
        "which it is as wide as the square of that. ward: roots of |h.t| and |h.b|; angle and azimuth of h"),
    choice(
        "format", 1, kFormats,
        "What holds the values. byte clamps G / (pi n.v) of analytic tables to 1, as published tables of 8 "
        "bits did; the other fits take half then"),
    choice("fresnel", 0, kFresnelTerms,
           "Reflectance of the microfacets in analytic tables: by Fresnel's equations, or by Schlick's "
           "approximation, off by 0.036 at an index of 1.5, 0.26 at 5 and 0.12 for aluminium"),
};
constexpr StressCase kStress[] = {
    {.name = "tables of 2 texels", .settings = "texels=2", .factor = 0},
    {.name = "published coordinates", .settings = "coordinates=published"},
    {.name = "8 bits", .settings = "format=byte"},
    {.name = "Schlick's reflectance", .settings = "fresnel=schlick"},
    {.name = "dfg of 2 texels", .scene = "torus_metal", .settings = "fit=dfg fit_texels=2", .factor = 0},
    {.name = "svd of 2 texels", .scene = "torus_metal", .settings = "fit=svd fit_texels=2", .factor = 0},
    {.name = "volumes of 2 texels",
     .scene = "torus_metal",
     .settings = "fit=trilinear fit_texels=2",
     .factor = 0},
    {.name = "slopes and fibres of 2 texels",
     .scene = "disk_and_sphere",
     .settings = "texels=2 format=byte",
     .factor = 0},
    {.name = "published coordinates of slopes",
     .scene = "disk_and_sphere",
     .settings = "coordinates=published"},
    {.name = "fits of other models", .scene = "disk_and_sphere", .settings = "fit=pqp_disc", .factor = 5},
    {.name = "two products over discs of 2 texels",
     .scene = "disk_and_sphere",
     .settings = "fit=dfg_disc terms=2 fit_texels=2",
     .factor = 0},
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
    case dfgDisc:
      return Factorisation::dfg_disc;
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
  choice.fresnel = static_cast<brdf::FresnelTerm>(parameters.choice("fresnel"));
  choice.fit.factorisation = factorisation(fit);
  choice.fit.terms = std::min(parameters.integer("terms"), brdf::mostTerms(choice.fit.factorisation));
  choice.fit.warped = parameters.choice("coordinates") == 0;
  choice.fit.samples = kSamples;
  choice.fit.format = static_cast<brdf::TableFormat>(parameters.choice("format"));
  if (choice.analytic) {
    choice.fit.texels = parameters.integer("texels");
    return choice;
  }
  // Other fits lie over nothing that is chosen: they are kept once, and have one program.
  if (fit != tables && fit != pqpDisc && fit != dfgDisc) choice.fit.warped = true;
  const int asked = parameters.integer("fit_texels");
  choice.fit.texels = asked == 0 ? defaultTexels(fit) : std::max(asked, 2);
  if (choice.fit.format == brdf::TableFormat::byte) choice.fit.format = brdf::TableFormat::half;
  return choice;
}

/// Returns the steps of the loop over products in response.glsl, which is left at the head of a step of its
/// own.
int loopSteps(Factorisation product, int layers) {
  switch (product) {
    case Factorisation::dfg:
    case Factorisation::pqp:
    case Factorisation::svd:
      return layers + 1;
    case Factorisation::pqp_disc:
    case Factorisation::dfg_disc:
      return layers / 2 + 1;
    default:
      return 0;
  }
}

/// Is a texture of the tables of one kind of product.
struct TableTexture {
  Factorisation product;
  std::size_t table;  ///< index in FactoredBrdf::tables
  const char* sampler;
  const char* name;
};
/// Analytic tables of several models stand beside each other; fits are of one kind.
constexpr TableTexture kAnalyticTextures[] = {
    {Factorisation::tables, 0, "factored_1", "factors"},
    {Factorisation::tables, 1, "factored_2", "second factors"},
    {Factorisation::slopes, 0, "factored_slopes", "distributions of slopes"},
    {Factorisation::slopes, 1, "factored_slope_rows", "Fresnel's terms and masking"},
    {Factorisation::fibres, 0, "factored_fibres", "fibres"}};

/// Returns the mask, by kind of model, of analytic tables that there are.
int kindsOf(const factored::MaterialFits& fits) {
  int kinds = 0;
  for (const auto& fit : fits.fits)
    kinds |= 1 << (fit->factorisation == Factorisation::slopes   ? glsl::model_ward
                   : fit->factorisation == Factorisation::fibres ? glsl::model_banks
                                                                 : glsl::model_torrance_sparrow);
  return kinds;
}

class FactoredBrdf : public Technique {
  std::vector<gpu::Texture> tables_;  ///< layers of each fit, behind each other
  gpu::Texture materials_;            ///< of each material, row 0: scale and fit (-1: none), row 1: floor

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
    static constexpr const char* kProducts[] = {"TABLES",   "DFG", "PQP",      "PQP_DISC",
                                                "DFG_DISC", "SVD", "TRILINEAR"};
    const char* product =
        choice.analytic ? "ANALYTIC" : kProducts[static_cast<int>(choice.fit.factorisation)];
    answer.defines = {{"FACTORED_FIT", fmt::format("FACTORED_{}", product)},
                      {"FACTORED_COMPLETE", fits.complete(inputs.scene) ? "1" : "0"},
                      {"FACTORED_WARPED", choice.fit.warped ? "true" : "false"},
                      {"FACTORED_LAYERS", fmt::format("{}", fits.fits.front()->tables.front().depth)}};
    if (choice.analytic) answer.defines["FACTORED_KINDS"] = fmt::format("{}", kindsOf(fits));
    answer.steps = loopSteps(choice.fit.factorisation, fits.fits.front()->tables.front().depth);
    upload(inputs.gpuScene.device(), graph, choice, fits, answer);
    return answer;
  }

  /// Makes the textures and adds them to the answer.
  void upload(gpu::Device& device, frame::FrameGraph& graph, const factored::FitChoice& choice,
              const factored::MaterialFits& fits, scene::SurfaceAnswer& answer) {
    std::vector<TableTexture> textures(std::begin(kAnalyticTextures), std::end(kAnalyticTextures));
    if (!choice.analytic) {
      textures.resize(fits.fits.front()->tables.size());
      for (TableTexture& texture : textures) texture.product = choice.fit.factorisation;
    }
    tables_.clear();
    tables_.reserve(textures.size());  // the graph keeps references
    for (const TableTexture& texture : textures) {
      const std::vector<const brdf::FactoredBrdf*> own = fits.of(texture.product);
      if (own.empty()) continue;
      tables_.push_back(layers(device, texture, own));
      answer.textures.push_back(
          {texture.sampler, graph.importTexture(texture.name, tables_.back()), "what f is a product of"});
    }
    std::vector<glm::vec4> rows;
    for (const factored::MaterialFits::Row& row : fits.rows)
      rows.emplace_back(row.scale, static_cast<float>(row.fit));
    for (const factored::MaterialFits::Row& row : fits.rows) rows.emplace_back(row.floor, 0.f);
    materials_ =
        gpu::Texture(device, "tables of materials",
                     {.format = GL_RGBA32F, .width = static_cast<int>(fits.rows.size()), .height = 2});
    materials_.upload(0, 0, GL_RGBA, GL_FLOAT, rows.data());
    answer.textures.push_back({"factored_materials", graph.importTexture("tables of materials", materials_),
                               "which tables a material has"});
  }

  static gpu::Texture layers(gpu::Device& device, const TableTexture& which,
                             const std::vector<const brdf::FactoredBrdf*>& fits) {
    const brdf::FactorTable& first = fits.front()->tables[which.table];
    gpu::Texture texture(device, which.name,
                         {.target = GL_TEXTURE_2D_ARRAY,
                          .format = kTextureFormats[static_cast<int>(first.format)],
                          .width = first.width,
                          .height = first.height,
                          .layers = first.depth * static_cast<int>(fits.size())});
    texture.setSampling(GL_LINEAR, GL_LINEAR);
    for (size_t i = 0; i < fits.size(); ++i)
      for (int z = 0; z < first.depth; ++z)
        texture.upload(0, static_cast<int>(i) * first.depth + z, GL_RGB, GL_FLOAT,
                       &fits[i]->tables[which.table].at(0, 0, z));
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
