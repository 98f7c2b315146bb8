// Declares analytic tables of the models that turn with the tangent: Ward's brushed metal and Banks's fibres.
#pragma once

#include <glm/glm.hpp>

#include "core/base/export.h"
#include "core/brdf/factor_tables.h"

namespace limn::brdf {

/// Describes a reflector whose slopes have an elliptical Gaussian distribution (Ward 1992).
struct Ward {
  glm::dvec3 eta{1.5};        ///< index of refraction
  glm::dvec3 k{0};            ///< its absorption; 0 for dielectrics
  glm::dvec2 roughness{0.1};  ///< along the tangent and across it, taken as at least kLeastRoughness
  Masking masking = Masking::correlated;
  FresnelTerm fresnel = FresnelTerm::exact;
};

/// Describes fibres along the tangent (Banks 1994), with the lobe of Stalling, Zoeckler and Hege (1997).
struct Banks {
  glm::dvec3 kd{0}, ks{0};  ///< coefficients, 1/sr
  double exponent = 32;
};

/// Returns D (1/sr) where the half vector's components along the tangent and across it are `h`; 0 where no
/// unit vector above the surface has them.
LIMN_API double slopeDistribution(const Ward& material, const glm::dvec2& h);

/// Returns the tables of a material, of kind `slopes`: texels x texels of D over its largest value, and two
/// rows of `texels`, Fresnel's term and masking. Published texels lie over the half vector's angle and
/// azimuth. Throws UsageError for less than 2 texels and parameters that are no numbers of a material.
LIMN_API FactoredBrdf wardTables(const Ward& material, int texels, bool warped, TableFormat format);

/// Returns the table of a material, of kind `fibres`: texels x texels of diffuse part and lobe over l.t and
/// v.t, divided by the sum of their coefficients.
/// Throws UsageError for less than 2 texels, negative coefficients and a negative exponent.
LIMN_API FactoredBrdf banksTable(const Banks& material, int texels, TableFormat format);

}  // namespace limn::brdf
