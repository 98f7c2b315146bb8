// Shows where a picture is too bright and where it is too dark.
#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "core/image/image.h"

namespace limn::app {

/// Declares how differences become colours: symmetric in sign, logarithmic beyond `least`.
struct DifferenceScale {
  float least = 0.001f;  ///< smaller ones are white
  float most = 1;        ///< larger ones have the last colour; greater than least
};

/// Returns the position of a difference on the colour bar, -1 (most negative) to 1.
float differencePosition(float difference, const DifferenceScale& scale);
/// Returns the colour of a position, sRGB in [0, 1]: blue, white, red; safe for the colour-blind.
glm::vec3 differenceColour(float position);

/// Returns the luminance (Rec. 709) of image - reference in those colours. Throws Error if the sizes differ.
Image8 signedDifference(const Image& image, const Image& reference, const DifferenceScale& scale);

}  // namespace limn::app
