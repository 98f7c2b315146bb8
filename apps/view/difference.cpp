#include "apps/view/difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "core/base/error.h"

namespace limn::app {

float differencePosition(float difference, const DifferenceScale& scale) {
  const float size = std::abs(difference);
  if (!(size > scale.least)) return 0;
  const float part = std::log(size / scale.least) / std::log(scale.most / scale.least);
  return std::copysign(std::min(part, 1.f), difference);
}

glm::vec3 differenceColour(float position) {
  const glm::vec3 white(0.97f), blue(0.13f, 0.40f, 0.67f), red(0.70f, 0.09f, 0.17f);
  return glm::mix(white, position < 0 ? blue : red, std::clamp(std::abs(position), 0.f, 1.f));
}

Image8 signedDifference(const Image& image, const Image& reference, const DifferenceScale& scale) {
  if (image.width() != reference.width() || image.height() != reference.height())
    throw Error(fmt::format("difference: {} x {} and {} x {} pixels", image.width(), image.height(),
                            reference.width(), reference.height()));
  const auto luminance = [](const Image& from, int x, int y) {
    return 0.2126f * from.at(x, y, 0) + 0.7152f * from.at(x, y, 1) + 0.0722f * from.at(x, y, 2);
  };
  Image8 result{image.width(), image.height(), {}};
  result.data.reserve(static_cast<size_t>(result.width) * static_cast<size_t>(result.height) * 4);
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x) {
      const glm::vec3 colour =
          differenceColour(differencePosition(luminance(image, x, y) - luminance(reference, x, y), scale));
      for (int c = 0; c < 3; ++c) result.data.push_back(static_cast<uint8_t>(std::lround(255 * colour[c])));
      result.data.push_back(255);
    }
  }
  return result;
}

}  // namespace limn::app
