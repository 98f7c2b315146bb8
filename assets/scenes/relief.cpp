#include "assets/scenes/relief.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limn::assets {

double noiseRelief(double u, double v) {
  constexpr int most = 6;
  double sum = 0;
  for (int i = 0; i <= most; ++i)
    for (int j = -most; j <= most; ++j) {
      const int square = i * i + j * j;
      if (square == 0 || square > most * most) continue;
      const double phase = std::fmod(37.77 * i + 71.13 * j + 5.1 * i * j + 9.7 * j * j, 2 * std::numbers::pi);
      sum += std::cos(2 * std::numbers::pi * (i * u + j * v) + phase) / square;
    }
  return 0.0187 * sum;
}

HeightMap addHeights(Scene& scene, std::string name, glm::ivec2 texels, glm::vec2 tile,
                     const Relief& relief) {
  Image image = makeImage(texels.x, texels.y, [&](glm::vec2 uv) {
    return glm::vec4(static_cast<float>(relief(static_cast<double>(uv.x), static_cast<double>(uv.y))));
  });
  const auto [low, high] =
      std::ranges::minmax(image.pixels, {}, [](const glm::vec4& pixel) { return pixel.r; });
  const float lowest = low.r, range = high.r - low.r, side = 0.5f * (tile.x + tile.y);
  for (glm::vec4& pixel : image.pixels) pixel = (pixel - lowest) / range;
  return {.texture = scene.addHeights(std::move(name), std::move(image)),
          .scale = side * range,
          .offset = side * lowest,
          .tile = tile};
}

}  // namespace limn::assets
