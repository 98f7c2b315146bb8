// Declares what all makers of analytic tables ask of their arguments.
#pragma once

#include <glm/glm.hpp>

namespace limn::brdf {

/// Throws UsageError for tables of less than 2 texels along an axis.
void checkTexels(int width, int height);
/// Throws UsageError for a roughness outside of [0, 1].
void checkRoughness(double roughness);
/// Throws UsageError for indices of refraction and absorption that no material has.
void checkRefraction(const glm::dvec3& eta, const glm::dvec3& k);

}  // namespace limn::brdf
