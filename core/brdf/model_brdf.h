// Declares the models of materials (glsl/materials) as BRDFs. `measured` holds the tables of measured models
// (Scene::measured).
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"
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

}  // namespace limn::brdf
