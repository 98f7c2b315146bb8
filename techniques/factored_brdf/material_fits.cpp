#include "techniques/factored_brdf/material_fits.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include "core/base/error.h"
#include "core/brdf/model_brdf.h"
#include "glsl/materials/model.glsl"

namespace limn::factored {
namespace {

using brdf::Factorisation;
using glm::dvec3;
using glm::vec3;

brdf::TorranceSparrow described(const glsl::MaterialModel& m) {
  using namespace glsl;
  return {.eta = dvec3(m.eta),
          .k = dvec3(m.k),
          .roughness = static_cast<double>(m.roughness.x),
          .distribution = (m.options & model_option_gaussian) != 0 ? brdf::NormalDistribution::gaussian
                                                                   : brdf::NormalDistribution::beckmann,
          .masking =
              (m.options & model_option_product) != 0 ? brdf::Masking::product : brdf::Masking::correlated};
}

/// Says whether two Torrance-Sparrow models have the same analytic tables, which hold neither kd nor ks.
bool sameAnalytic(const glsl::MaterialModel& a, const glsl::MaterialModel& b) {
  return a.eta == b.eta && a.k == b.k && a.options == b.options && a.roughness.x == b.roughness.x;
}

/// Says why a choice cannot hold a model; empty where it can.
std::string reasonAgainst(const glsl::MaterialModel& model, const FitChoice& choice) {
  if (choice.analytic)
    return model.kind == glsl::model_torrance_sparrow ? "" : "analytic tables are Torrance-Sparrow's alone";
  const Factorisation kind = choice.fit.factorisation;
  if (glsl::model_anisotropic(model) && kind != Factorisation::pqp_disc && kind != Factorisation::svd)
    return "it turns with the tangent, which pqp_disc and svd alone can follow";
  return "";
}

/// Returns the tables of a material; nothing where there is nothing to fit.
std::optional<brdf::FactoredBrdf> fitted(const scene::Scene& scene, const scene::Material& material,
                                         const FitChoice& choice) {
  if (choice.analytic)
    return brdf::torranceSparrowTables(described(*material.model), choice.fit.texels, choice.fit.texels,
                                       choice.fit.warped, choice.fit.format);
  try {
    return brdf::fitBrdf(brdf::modelBrdf(*material.model, scene.measured), choice.fit);
  } catch (const UsageError&) {
    throw;
  } catch (const Error&) {
    return std::nullopt;  // black
  }
}

}  // namespace

bool MaterialFits::complete(const scene::Scene& scene) const {
  for (size_t i = 0; i < rows.size(); ++i)
    if (scene.materials[i].model && rows[i].fit < 0) return false;
  return true;
}

MaterialFits fitMaterials(const scene::Scene& scene, const FitChoice& choice) {
  MaterialFits result;
  std::vector<glsl::MaterialModel> models;  // of each fit
  for (const scene::Material& material : scene.materials) {
    MaterialFits::Row& row = result.rows.emplace_back();
    if (!material.model) continue;
    const glsl::MaterialModel& model = *material.model;
    if (const std::string reason = reasonAgainst(model, choice); !reason.empty()) {
      result.exact.push_back({material.name, reason});
      continue;
    }
    auto found = std::ranges::find_if(models, [&](const glsl::MaterialModel& m) {
      return choice.analytic ? sameAnalytic(m, model) : brdf::sameModel(m, model, scene.measured);
    });
    if (found == models.end()) {
      std::optional<brdf::FactoredBrdf> fit = fitted(scene, material, choice);
      if (!fit) {
        result.exact.push_back({material.name, "it reflects nothing that could be fitted"});
        continue;
      }
      result.fits.push_back(std::move(*fit));
      found = models.insert(models.end(), model);
    }
    row.fit = static_cast<int>(found - models.begin());
    const brdf::FactoredBrdf& fit = result.fits[static_cast<size_t>(row.fit)];
    row.scale = vec3(fit.scale) * (choice.analytic ? model.ks : vec3(1));
    row.floor = choice.analytic ? model.kd * std::numbers::inv_pi_v<float> : vec3(fit.floor);
  }
  return result;
}

}  // namespace limn::factored
