// Declares the tables that the material models of a scene are looked up in.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/brdf/factor_fit.h"
#include "core/scene/scene.h"

namespace limn::factored {

/// Says how models become tables.
struct FitChoice {
  /// Torrance-Sparrow, Ward and Banks alone, by their formulas; `fit` names size, coordinates and format
  /// then.
  bool analytic = true;
  brdf::FresnelTerm fresnel = brdf::FresnelTerm::exact;  ///< of analytic tables
  brdf::FitSettings fit;
};

/// Holds the tables of a scene's materials.
struct MaterialFits {
  /// Is what a material looks up: f n.l is `scale` times the product of the tables, plus `floor` n.l.
  struct Row {
    int fit = -1;  ///< index among the fits of its kind of product; -1: the model is evaluated exactly
    glm::vec3 scale{0}, floor{0};
  };
  /// Is a material that tables cannot hold.
  struct Exact {
    std::string material, reason;
  };
  /// Of all materials with a model, equal ones once.
  std::vector<std::shared_ptr<const brdf::FactoredBrdf>> fits;
  std::vector<Row> rows;  ///< of each material of the scene
  std::vector<Exact> exact;

  /// Returns those of one kind of product, in the order that rows count them.
  std::vector<const brdf::FactoredBrdf*> of(brdf::Factorisation kind) const;
  /// Returns whether no material with a model is evaluated exactly.
  bool complete(const scene::Scene& scene) const;
};

/// Returns the tables. A numerical fit takes about a second for each different material, several at once;
/// equal ones share it, and the process keeps it for the next graph (brdf::fitModel).
/// Materials with a model have a row without a fit where the choice cannot hold them: `analytic` all but
/// Torrance-Sparrow, Ward and Banks after Stalling, dfg, pqp, tables and trilinear those that turn with the
/// tangent, and every fit those that are black.
MaterialFits fitMaterials(const scene::Scene& scene, const FitChoice& choice);

}  // namespace limn::factored
