// Declares a decomposition that covers a grid of texels by few uniform regions (Annen, Dong, Mertens,
// Bekaert, Seidel and Kautz 2008, Real-Time All-Frequency Shadows in Dynamic Scenes; the thesis's section
// 5.3.2). It is used for the faces of an environment's cube map and for emissive textures.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"

namespace limn {

/// Holds what a surface or a part of the sky emits, per texel, rows from the top.
struct TexelGrid {
  int width = 0, height = 0;
  std::vector<glm::dvec3> energy;  ///< radiance times measure, >= 0 and finite
  std::vector<double> measure;     ///< solid angle or area, > 0
};

/// Describes the texels [x0, x1) x [y0, y1) as one uniform light.
struct Region {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  glm::dvec3 energy{0};
};

enum class RegionShape { squares, rectangles };

/// Returns regions that cover the grid, found greedily. Each region starts as one texel, the brightest that
/// no region covers yet, and grows by a row or column while that adds more than `threshold` times the energy
/// of the grown region; squares grow by a row and a column towards one of their corners, while both together
/// add more than twice that. The region then takes the energy of its texels except a residual, at most the
/// density of the texels around it, so that later regions grow smoothly across it. The source leaves "the
/// average energy"; it is the average around the region, not that of the region: a single bright texel is its
/// own average, and would leave all that it has to the regions that later lie across it. Once every texel
/// that emits is covered, the remaining energy of a texel is divided equally among the regions that cover it:
/// the energies of the regions sum to the grid's. Brightness and growth are measured by luminance.
///
/// In a uniform grid, growth stops at a side of about 1/threshold - 1 texels. The algorithm ends for every
/// grid, since each region covers at least one more texel; a grid that emits nothing gives no regions. The
/// result is deterministic. A region costs O(width height) for its summed-area table, each step of its growth
/// O(1).
///
/// Throws UsageError if more than `mostRegions` are needed; `what` names in the message what is being
/// decomposed.
LIMN_API std::vector<Region> greedyRegions(const TexelGrid& grid, double threshold, RegionShape shape,
                                           int mostRegions, const char* what);

}  // namespace limn
