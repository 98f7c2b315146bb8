// Declares the models of materials (glsl/materials) as BRDFs, and their fits. `measured` holds the tables of
// measured models (Scene::measured).
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/brdf/factor_fit.h"
#include "core/brdf/factor_tables.h"
#include "glsl/materials/material_model.glsl"

namespace limn::brdf {

/// Returns f of a model: what passes evaluate, without the cosine. `measured` has to live as long as the
/// function.
LIMN_API Brdf modelBrdf(const glsl::MaterialModel& model, const std::vector<glm::vec3>& measured);

/// Returns whether two models have the same numbers and, where they are measured, tables of the same values,
/// wherever these lie.
LIMN_API bool sameModel(const glsl::MaterialModel& a, const glsl::MaterialModel& b,
                        const std::vector<glm::vec3>& measured);

/// The most memory, in bytes, of the fits that fitModel() keeps beside the last one.
inline constexpr std::size_t kKeptFitBytes = std::size_t{64} << 20;

/// Returns fitBrdf() of a model's f. The process keeps the fits that were asked for last, so that graphs,
/// renderers and scenes with the same model and settings share one. Threads may call it at once. Throws as
/// fitBrdf() does, and keeps nothing then.
LIMN_API std::shared_ptr<const FactoredBrdf> fitModel(const glsl::MaterialModel& model,
                                                      const std::vector<glm::vec3>& measured,
                                                      const FitSettings& settings);

/// Returns the same of several models, which are fitted side by side; null for those that reflect nothing
/// that could be fitted. Throws UsageError as fitBrdf() does.
LIMN_API std::vector<std::shared_ptr<const FactoredBrdf>> fitModels(
    std::span<const glsl::MaterialModel> models, const std::vector<glm::vec3>& measured,
    const FitSettings& settings);

}  // namespace limn::brdf
