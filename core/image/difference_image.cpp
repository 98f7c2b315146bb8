#include <algorithm>
#include <glm/glm.hpp>

#include "core/image/metrics.h"
#include "glsl/numeric/srgb.glsl"

namespace limn {
namespace {

/// Black over purple and orange to light yellow, of steadily rising lightness, in sRGB: polynomials of degree
/// 6 fitted to nine colours of the magma map.
glm::vec3 falseColour(float value) {
  static constexpr glm::vec3 kCoefficients[] = {{-0.001f, 0.001f, 0.015f},    {0.069f, 0.948f, 1.775f},
                                                {10.240f, -6.472f, 5.365f},   {-35.271f, 25.044f, -28.551f},
                                                {66.533f, -45.977f, 34.288f}, {-63.427f, 42.963f, -10.428f},
                                                {22.845f, -15.515f, -1.713f}};
  glm::vec3 colour(0.0f);
  for (int i = 6; i >= 0; --i) colour = colour * value + kCoefficients[i];
  return glm::clamp(colour, 0.0f, 1.0f);
}

}  // namespace

Image differenceImage(const Comparison& comparison) {
  Image picture = Image::rgb(comparison.width, comparison.height);
  constexpr glm::vec3 kMasked(0.5f);
  for (std::size_t i = 0; i < comparison.mask.size(); ++i) {
    const glm::vec3 linear =
        glsl::srgb_decode(comparison.mask[i] ? falseColour(comparison.flipMap[i]) : kMasked);
    for (int c = 0; c < 3; ++c) picture.data()[3 * i + static_cast<std::size_t>(c)] = linear[c];
  }
  return picture;
}

}  // namespace limn
