// Computes light through links: gathered at leaves, pulled up to the elements above them (thesis, section
// 4.3.3).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/radiosity/forest.h"
#include "core/radiosity/links.h"
#include "core/scene/scene.h"
#include "glsl/indirect/direction_bins.glsl"

namespace limn::radiosity {

/// Returns the unit direction (xyz) and the solid angle in sr (w) of each bin.
LIMN_API std::vector<glm::vec4> binTable(int resolution);

/// Returns the environment's mean radiance over each bin (w is 0), W/(sr m^2), of bins in the axes of
/// `space`. Uses all cores; the result does not depend on their number.
LIMN_API std::vector<glm::vec4> environmentBins(const scene::Environment& environment,
                                                const ElementSpace& space, int resolution);

/// Computes the irradiance of every leaf, W/m^2: pi times the mean over the bins above its tangent plane of
/// the radiance that arrives, weighted by cosine and solid angle. A filled bin is filled wholly (equation
/// 4.5), and weights are divided by their sum, so that no white furnace gains light, which it would with the
/// bins' own weights (by 0.13 to 0.5 %). `outgoing` holds the radiance of each slot, `environment` the
/// radiance that empty bins see, for each bin; either is empty for darkness. Values of unused slots stay.
LIMN_API void gather(const Forest& forest, const Links& links, std::span<const glm::vec4> table,
                     std::span<const glm::vec3> outgoing, std::span<const glm::vec3> environment,
                     std::span<glm::vec3> irradiance);

/// Sets the radiance of every element above the leaves: the mean of its children's, weighted by area.
LIMN_API void pullUp(const Forest& forest, std::span<glm::vec3> outgoing);

}  // namespace limn::radiosity
