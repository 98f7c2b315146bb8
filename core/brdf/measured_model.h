// Declares what a material of the kind `measured` is made of, besides its table.
#pragma once

#include "core/base/export.h"
#include "core/brdf/tabulated.h"
#include "glsl/materials/material_model.glsl"

namespace limn::brdf {

struct MeasuredModel {
  /// Holds a model with ks = 1 whose table begins at value 0: sizes, hemispherical reflectance (k), diffuse
  /// part (kd) and the width of its lobe (roughness), which decides where samples go and how wide the surface
  /// is that comes next to it in prefiltered environments.
  glsl::MaterialModel model{};
  /// Holds the largest share of light that is reflected to a view of up to 75 degrees, in the channel that
  /// reflects most. Tables of measurements are above 1 at grazing views now and then; those nearer to 90
  /// degrees, where measurements are worst, do not count, or a few values would dim the whole material.
  float largestAlbedo = 0;
};

/// Returns the model of a table. Throws Error where a side of it is above 1023 nodes, or where it is empty.
LIMN_API MeasuredModel measuredModel(const TabulatedBrdf& table);
LIMN_API MeasuredModel measuredModel(const AnisotropicTable& table);

}  // namespace limn::brdf
