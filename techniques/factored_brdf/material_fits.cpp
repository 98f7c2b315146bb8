#include "techniques/factored_brdf/material_fits.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>

#include "core/brdf/anisotropic_tables.h"
#include "core/brdf/model_brdf.h"
#include "glsl/materials/model.glsl"

namespace limn::factored {
namespace {

using brdf::Factorisation;
using glm::dvec3;
using glm::vec3;

brdf::Masking maskingOf(const glsl::MaterialModel& m) {
  return (m.options & glsl::model_option_product) != 0 ? brdf::Masking::product : brdf::Masking::correlated;
}

brdf::TorranceSparrow torranceSparrow(const glsl::MaterialModel& m, brdf::FresnelTerm fresnel) {
  return {.eta = dvec3(m.eta),
          .k = dvec3(m.k),
          .roughness = static_cast<double>(m.roughness.x),
          .distribution = (m.options & glsl::model_option_gaussian) != 0 ? brdf::NormalDistribution::gaussian
                                                                         : brdf::NormalDistribution::beckmann,
          .masking = maskingOf(m),
          .fresnel = fresnel};
}

brdf::Ward ward(const glsl::MaterialModel& m, brdf::FresnelTerm fresnel) {
  return {.eta = dvec3(m.eta),
          .k = dvec3(m.k),
          .roughness = glm::dvec2(m.roughness),
          .masking = maskingOf(m),
          .fresnel = fresnel};
}

/// Says whether two models have the same analytic tables. Those of microfacets hold neither kd nor ks.
bool sameAnalytic(const glsl::MaterialModel& a, const glsl::MaterialModel& b) {
  if (a.kind != b.kind || a.options != b.options) return false;
  if (a.kind == glsl::model_banks) return a.kd == b.kd && a.ks == b.ks && a.exponent == b.exponent;
  return a.eta == b.eta && a.k == b.k && a.roughness.x == b.roughness.x &&
         (a.kind == glsl::model_torrance_sparrow || a.roughness.y == b.roughness.y);
}

/// Says why analytic tables cannot hold a model; empty where they can.
std::string reasonAgainstAnalytic(const glsl::MaterialModel& model) {
  switch (model.kind) {
    case glsl::model_torrance_sparrow:
    case glsl::model_ward:
      return "";
    case glsl::model_banks:
      return (model.options & glsl::model_option_printed) == 0
                 ? ""
                 : "Banks's lobe as printed is no function of l.t and v.t";
    default:
      return "analytic tables are Torrance-Sparrow's, Ward's and Banks's alone";
  }
}

/// Says why a choice cannot hold a model; empty where it can.
std::string reasonAgainst(const glsl::MaterialModel& model, const FitChoice& choice) {
  if (choice.analytic) return reasonAgainstAnalytic(model);
  if (glsl::model_anisotropic(model) && !brdf::followsTangent(choice.fit.factorisation))
    return "it turns with the tangent, which pqp_disc, dfg_disc and svd alone can follow";
  return "";
}

brdf::FactoredBrdf analyticTables(const glsl::MaterialModel& model, const FitChoice& choice) {
  const brdf::FitSettings& fit = choice.fit;
  switch (model.kind) {
    case glsl::model_ward:
      return brdf::wardTables(ward(model, choice.fresnel), fit.texels, fit.warped, fit.format);
    case glsl::model_banks:
      return brdf::banksTable(
          {.kd = dvec3(model.kd), .ks = dvec3(model.ks), .exponent = static_cast<double>(model.exponent)},
          fit.texels, fit.format);
    default:
      return brdf::torranceSparrowTables(torranceSparrow(model, choice.fresnel), fit.texels, fit.texels,
                                         fit.warped, fit.format);
  }
}

using Tables = std::vector<std::shared_ptr<const brdf::FactoredBrdf>>;

/// Returns the tables of models that the choice can hold; null where there is nothing to fit.
Tables tablesOf(const std::vector<glsl::MaterialModel>& models, const scene::Scene& scene,
                const FitChoice& choice) {
  if (!choice.analytic) return brdf::fitModels(models, scene.measured, choice.fit);
  Tables tables;
  for (const glsl::MaterialModel& model : models)
    tables.push_back(std::make_shared<const brdf::FactoredBrdf>(analyticTables(model, choice)));
  return tables;
}

}  // namespace

std::vector<const brdf::FactoredBrdf*> MaterialFits::of(Factorisation kind) const {
  std::vector<const brdf::FactoredBrdf*> result;
  for (const auto& fit : fits)
    if (fit->factorisation == kind) result.push_back(fit.get());
  return result;
}

bool MaterialFits::complete(const scene::Scene& scene) const {
  for (size_t i = 0; i < rows.size(); ++i)
    if (scene.materials[i].model && rows[i].fit < 0) return false;
  return true;
}

MaterialFits fitMaterials(const scene::Scene& scene, const FitChoice& choice) {
  std::vector<glsl::MaterialModel> models;         // that tables can hold, equal ones once
  std::vector<std::optional<std::ptrdiff_t>> own;  // of each material: which of them it has
  for (const scene::Material& material : scene.materials) {
    std::optional<std::ptrdiff_t>& index = own.emplace_back();
    if (!material.model || !reasonAgainst(*material.model, choice).empty()) continue;
    const auto found = std::ranges::find_if(models, [&](const glsl::MaterialModel& m) {
      return choice.analytic ? sameAnalytic(m, *material.model)
                             : brdf::sameModel(m, *material.model, scene.measured);
    });
    index = found - models.begin();
    if (found == models.end()) models.push_back(*material.model);
  }
  const Tables tables = tablesOf(models, scene, choice);

  MaterialFits result;
  for (size_t i = 0; i < own.size(); ++i) {
    const scene::Material& material = scene.materials[i];
    MaterialFits::Row& row = result.rows.emplace_back();
    if (!material.model) continue;
    const glsl::MaterialModel& model = *material.model;
    if (!own[i]) {
      result.exact.push_back({material.name, reasonAgainst(model, choice)});
      continue;
    }
    const auto fit = tables.begin() + *own[i];
    if (!*fit) {
      result.exact.push_back({material.name, "it reflects nothing that could be fitted"});
      continue;
    }
    // Those before it of the same kind.
    row.fit = static_cast<int>(std::count_if(tables.begin(), fit, [&](const auto& other) {
      return other && other->factorisation == (*fit)->factorisation;
    }));
    row.scale = vec3((*fit)->scale);
    row.floor = vec3((*fit)->floor);
    if (choice.analytic && model.kind != glsl::model_banks) {
      row.scale *= model.ks;
      row.floor = model.kd * std::numbers::inv_pi_v<float>;
    }
  }
  std::ranges::copy_if(tables, std::back_inserter(result.fits),
                       [](const auto& fit) { return fit != nullptr; });
  return result;
}

}  // namespace limn::factored
