// Declares what is shown of a BRDF: the light that it reflects, its reciprocity, and a picture of its lobes.
#pragma once

#include "core/base/export.h"
#include "core/brdf/factor_tables.h"
#include "core/image/image.h"

namespace limn::brdf {

/// Returns the unit vector at an angle of `degrees` from the normal and at `azimuth` (radians) from the
/// tangent.
LIMN_API glm::dvec3 directionAt(double degrees, double azimuth);

/// Returns f cos(l).
LIMN_API Response responseOf(const Brdf& brdf);

/// Returns the root of the mean square of f(l, v) - f(v, l) over that of f(l, v), over all l and over v up to
/// 80 degrees, both weighted by their cosines: 0 for a reciprocal BRDF. 0 where f is 0 everywhere.
LIMN_API double reciprocityDefect(const Brdf& brdf);

/// The angles between the normal and the light, degrees, whose lobes a picture shows.
inline constexpr int kLobeAngles[] = {0, 30, 45, 60, 75};

/// Draws lobes and furnace of a BRDF.
///
/// Discs from left to right show f cos(l) over all directions v for light from -x at the angles of
/// kLobeAngles, as hemispheres seen from above that keep areas (Lambert's projection: equal areas are equal
/// solid angles); a ring stands where the light comes from. The largest channel of a pixel is, in linear
/// values, the root of f cos(l) over its largest value in any disc; hues are kept. Unless the BRDF is
/// `isotropic`, discs of a second row have light from -y.
///
/// The strip beneath shows the albedo of each channel over the angle of the view, 0 to 90 degrees from left
/// to right; where the channels agree the line is white. Levels are a quarter apart from 0 at the bottom, 1
/// is the brightest, and the only one where a quarter is less than two rows; upright lines are at
/// kLobeAngles. The views lean to +x, those of dim lines to +y.
LIMN_API Image lobePicture(const Brdf& brdf, bool isotropic, int discPixels = 160);

}  // namespace limn::brdf
