// Declares the fits behind fitBrdf: each returns tables, scale and floor for values that are not negative.
#pragma once

#include <vector>

#include "core/brdf/factor_fit.h"
#include "core/brdf/factor_fit_samples.h"

namespace limn::brdf {

/// Sums of logarithms: dfg, pqp, pqp_disc and dfg_disc. `floor` is taken out of the samples; a second product
/// starts as what is left of their diffuse part.
FactoredBrdf fitLogarithms(const std::vector<BrdfSample>& samples, const FitSettings& settings,
                           const glm::dvec3& floor);

/// The best sum of `settings.terms` products of a function of the half vector and one of the difference, on
/// discs of `settings.texels` squared. Pairs whose l or v lies below the horizon have no value: they are
/// taken from the sum itself, over and over. Texels that no pair above the horizon has get the mean of their
/// neighbours.
FactoredBrdf fitSvd(const Brdf& brdf, const FitSettings& settings, const glm::dvec3& floor);

/// A table over half vector and difference. Texels whose l or v lies below the horizon get the mean of their
/// neighbours.
FactoredBrdf fitTrilinear(const Brdf& brdf, const FitSettings& settings);

}  // namespace limn::brdf
