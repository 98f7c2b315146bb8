// Declares the pairs of directions at which a BRDF is fitted.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/brdf/factor_tables.h"

namespace limn::brdf {

/// Is what a BRDF is at one pair of directions.
struct BrdfSample {
  glm::dvec3 l, v;
  glm::dvec3 f;  ///< 1/sr
};

/// Returns whether all channels are numbers.
bool finite(const glm::dvec3& f);

/// Returns about `count` samples, half of them spread evenly over warped half vector and difference, half
/// over warped cosines and azimuths; the first half gives lobes their share however narrow, the second
/// grazing angles. Values that are not finite are left out, negative ones count as 0. Throws Error where
/// there is nothing to fit: no function, no finite value, or 0 everywhere.
std::vector<BrdfSample> sampleBrdf(const Brdf& brdf, int count);

/// Returns the light and the view of a half vector and of the light's direction as seen from it (local
/// frame).
void directionsOf(const glm::dvec3& h, const glm::dvec3& difference, glm::dvec3& l, glm::dvec3& v);

/// Returns the diffuse part of f per channel: the value that one in fifty samples with both cosines above 0.3
/// does not exceed; 0 where there is no such sample.
glm::dvec3 diffuseFloor(const std::vector<BrdfSample>& samples);

}  // namespace limn::brdf
