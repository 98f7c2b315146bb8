// Declares the numerical factorisation of BRDFs that are known by their values alone.
#pragma once

#include "core/base/export.h"
#include "core/brdf/factor_tables.h"

namespace limn::brdf {

/// The most texels along an axis that svd takes: its matrix has their fourth power of entries.
inline constexpr int kMostSvdTexels = 48;

/// Returns the most products that a fit of a kind is the sum of.
LIMN_API int mostTerms(Factorisation factorisation);

/// Returns whether a fit of a kind follows BRDFs that turn with the tangent.
LIMN_API bool followsTangent(Factorisation factorisation);

struct FitSettings {
  /// What the BRDF becomes a product of. `tables` is the dfg fit with D and F baked into one table and both G
  /// into the other: two look-ups and no exponential.
  Factorisation factorisation = Factorisation::dfg;
  int texels =
      64;  ///< along each axis of a factor; of a trilinear table along n.h, half as many along the others
  /// Products that the fit is the sum of: up to 16 of svd, up to 2 of dfg, pqp and those over discs, of which
  /// the second is led on from a diffuse floor. The others have one.
  int terms = 1;
  bool warped = true;  ///< of discs: that of the half vector over the root of its radius; of tables as well
  /// A diffuse part is taken out first and added to the product (a sum is no product), where a
  /// picture under other lights is then closer. A trilinear table needs none.
  bool floor = true;
  /// Gauss-Newton on the error of f n.l n.v over f + its mean, after the least squares of the logarithms
  /// (dfg, pqp and those over discs).
  bool refine = true;
  int samples = 20000;  ///< pairs of directions the logarithmic fits look at
  TableFormat format = TableFormat::half;
  bool operator==(const FitSettings&) const = default;
};

/// Returns the fit, with its error over a picture of 128 x 128 pixels under lights that nothing was fitted or
/// chosen by (refinement looks at samples, the floor is kept by a picture under other lights). A fit whose
/// largest directional albedo is above 1 is divided by it. Throws UsageError for settings out of range (less
/// than 2 texels, more than svd takes, no term or more than mostTerms()), and Error where there is nothing to
/// fit: no function, no finite value, or 0 everywhere.
LIMN_API FactoredBrdf fitBrdf(const Brdf& brdf, const FitSettings& settings);

/// Returns a fit of kind dfg or pqp as two tables of `texels` x `texels`, with the same scale and floor.
/// Throws UsageError for other kinds, sums of products and less than 2 texels.
LIMN_API FactoredBrdf bakedTables(const FactoredBrdf& fit, int texels, bool warped, TableFormat format);

}  // namespace limn::brdf
