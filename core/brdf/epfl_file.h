// Declares reading of the BRDF files of the Realistic Graphics Lab of EPFL (Dupuy and Jakob 2018, An Adaptive
// Parameterization for Efficient Material Acquisition and Rendering), in the variant for RGB renderers.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <string_view>

#include "core/base/export.h"
#include "core/brdf/measured_file.h"

namespace limn::brdf {

/// What files are resampled to.
struct EpflNodes {
  glm::ivec3 angles{90, 90, 90};  ///< of isotropic materials, over half and difference angles
  int texels = 40;                ///< a side of each square of directions, of anisotropic ones
};

/// Returns a table of a file's content, resampled by
///   f = rgb(u) ndf(h) / (4 sigma(l) cos(v)),
/// where u in [0, 1]^2 is what the inverse of the visible normals' distribution, vndf, makes of h. Files with
/// more than two azimuths of l are anisotropic. What they leave out of the circle follows by symmetry: half a
/// circle looks the same after half a turn, a quarter in mirrors at its ends as well. As measurements are not
/// quite reciprocal, the table has the mean of f and of f with both directions swapped.
///
/// Throws Error that begins with `name` where the content is no such file, lacks an array, has arrays whose
/// sizes disagree or that hold what is no number or no density, or azimuths of another part of the circle, or
/// where f is no number at a texel of an anisotropic table.
LIMN_API MeasuredBrdf decodeEpfl(std::span<const std::byte> bytes, std::string_view name,
                                 const EpflNodes& nodes = {});

}  // namespace limn::brdf
