// Declares LDR-FLIP, a map of the differences a person notices when alternating between two pictures.
//
// P. Andersson, J. Nilsson, T. Akenine-Moller, M. Oskarsson, K. Astrom, M. D. Fairchild, "FLIP: A Difference
// Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020.
#pragma once

#include <span>
#include <vector>

#include "core/base/export.h"

namespace limn {

/// Pixels per degree of a 3840-pixel, 0.7 m wide monitor seen from 0.7 m (section 5 of the paper): 67.02.
inline constexpr double kFlipPixelsPerDegree = 0.7 * 3840.0 / 0.7 * 3.14159265358979323846 / 180.0;

/// Returns the FLIP error in [0, 1] of every pixel. Both pictures hold width * height pixels of three display
/// values in [0, 1], linear (before the sRGB curve), rows from the top. The result is symmetric in the two
/// pictures. Throws Error if a span has the wrong length or pixelsPerDegree is not in [1, 1000].
LIMN_API std::vector<float> flipMap(std::span<const float> image, std::span<const float> reference, int width,
                                    int height, double pixelsPerDegree = kFlipPixelsPerDegree);

}  // namespace limn
