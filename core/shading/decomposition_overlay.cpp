// The picture of a decomposition: outlines of its lights on the map.
#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/shading/environment.h"
#include "core/shading/environment_decomposition.h"
#include "glsl/numeric/equirectangular.glsl"

namespace limn::shading {
namespace {

/// Draws the great-circle arc from a to b (on one face: a straight line there).
void drawArc(Image& image, const glm::vec3& a, const glm::vec3& b) {
  const float angle = std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.f, 1.f));
  // Near the poles a small angle spans many pixels.
  const int steps = std::max(2, static_cast<int>(8 * angle * static_cast<float>(image.width()) / glsl::pi));
  for (int i = 0; i <= steps; ++i) {
    const glm::vec2 uv =
        glsl::equirectangular_uv(glm::mix(a, b, static_cast<float>(i) / static_cast<float>(steps)));
    const int x = std::min(static_cast<int>(uv.x * static_cast<float>(image.width())), image.width() - 1);
    const int y = std::min(static_cast<int>(uv.y * static_cast<float>(image.height())), image.height() - 1);
    image.at(x, y, 0) = image.at(x, y, 2) = 0;
    image.at(x, y, 1) = 1;
  }
}

}  // namespace

Image decompositionOverlay(const scene::Environment& environment,
                           const EnvironmentDecomposition& decomposition, int width, float exposureEv) {
  if (!environment) throw Error("environment: there is no map to show");
  const FilteredMap map{environment.width, environment.height, environment.texels};
  Image image = Image::rgb(width, std::max(width / 2, 1));
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::vec2 uv((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                         (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height()));
      const glm::vec3 radiance = std::exp2(exposureEv) * bilinear(map, uv);
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = radiance[c];
    }
  }
  for (const scene::DistantRectangle& light : decomposition.lights) {
    const glm::vec3 u = 0.5f * light.sides.x * light.axisU, v = 0.5f * light.sides.y * light.axisV;
    const std::array<glm::vec3, 4> corners{light.centre - u - v, light.centre + u - v, light.centre + u + v,
                                           light.centre - u + v};
    for (size_t i = 0; i < 4; ++i) drawArc(image, corners[i], corners[(i + 1) % 4]);
  }
  return image;
}

}  // namespace limn::shading
