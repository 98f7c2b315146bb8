// Declares reading of the BRDF files of the Realistic Graphics Lab of EPFL (Dupuy and Jakob 2018, An Adaptive
// Parameterization for Efficient Material Acquisition and Rendering), in the variant for RGB renderers.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string_view>

#include "core/base/export.h"
#include "core/brdf/tabulated.h"

namespace limn::brdf {

/// The nodes that files are resampled to, where nothing else is said.
inline constexpr glm::ivec3 kEpflNodes{90, 90, 90};

/// Returns a table of an isotropic material, resampled from a file's content by
///   f = rgb(u) ndf(h) / (4 sigma(l) cos(v)),
/// where u in [0, 1]^2 is what the inverse of the visible normals' distribution, vndf, makes of h. Throws
/// Error that begins with `name` where the content is no such file, lacks an array, has arrays whose sizes
/// disagree or that hold what is no number or no density, or where the material is anisotropic.
LIMN_API TabulatedBrdf decodeEpfl(std::span<const std::byte> bytes, std::string_view name,
                                  const glm::ivec3& size = kEpflNodes);
LIMN_API TabulatedBrdf readEpfl(const std::filesystem::path& path, const glm::ivec3& size = kEpflNodes);

}  // namespace limn::brdf
