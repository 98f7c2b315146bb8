// Declares the numerical factorisation of BRDFs that are known by their values alone.
#pragma once

#include "core/base/export.h"
#include "core/brdf/factor_tables.h"

namespace limn::brdf {

/// The most texels along an axis that svd takes: its matrix has their fourth power of entries.
inline constexpr int kMostSvdTexels = 48;

struct FitSettings {
  /// What the BRDF becomes a product of. `tables` is the dfg fit with D and F baked into one table and both G
  /// into the other: two look-ups and no exponential.
  Factorisation factorisation = Factorisation::dfg;
  int texels =
      64;  ///< along each axis of a factor; of a trilinear table along n.h, half as many along the others
  int terms = 1;       ///< products that svd takes the sum of
  bool warped = true;  ///< of pqp_disc: the half vector's disc over the root of its radius; of tables as well
  /// A diffuse part is taken out first and added to the product (a sum is no product), where a
  /// picture under other lights is then closer. A trilinear table needs none.
  bool floor = true;
  /// Gauss-Newton on the error of f n.l n.v over f + its mean, after the least squares of the logarithms
  /// (dfg, pqp and pqp_disc).
  bool refine = true;
  int samples = 20000;  ///< pairs of directions the logarithmic fits look at
  TableFormat format = TableFormat::half;
};

/// Returns the fit, with its error over a picture of 128 x 128 pixels under lights that nothing was fitted or
/// chosen by (refinement looks at samples, the floor is kept by a picture under other lights). A fit whose
/// largest directional albedo is above 1 is divided by it. Throws UsageError for settings out of range (less
/// than 2 texels, more than svd takes, no term), and Error where there is nothing to fit: no function, no
/// finite value, or 0 everywhere.
LIMN_API FactoredBrdf fitBrdf(const Brdf& brdf, const FitSettings& settings);

/// Returns a fit of kind dfg or pqp as two tables of `texels` x `texels`, with the same scale and floor.
/// Throws UsageError for other kinds and less than 2 texels.
LIMN_API FactoredBrdf bakedTables(const FactoredBrdf& fit, int texels, bool warped, TableFormat format);

}  // namespace limn::brdf
