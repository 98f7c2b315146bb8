// Where a picture is too bright and where too dark.
#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "core/image/image.h"

namespace limn::app {

/// How differences become colours: symmetric in sign, logarithmic beyond `least`.
struct DifferenceScale {
  float least = 0.001f;  ///< smaller ones are white
  float most = 1;        ///< larger ones have the last colour; greater than least
};

/// Position of a difference on the bar, -1 (most negative) to 1.
float differencePosition(float difference, const DifferenceScale& scale);
/// Colour of a position, sRGB in [0, 1]: blue, white, red; safe for the colour-blind.
glm::vec3 differenceColour(float position);

/// Luminance (Rec. 709) of image - reference in those colours. Throws Error if the sizes differ.
Image8 signedDifference(const Image& image, const Image& reference, const DifferenceScale& scale);

}  // namespace limn::app
