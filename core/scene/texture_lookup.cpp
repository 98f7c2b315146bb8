#include "core/scene/texture_lookup.h"

#include <algorithm>
#include <cmath>

#include "core/image/byte_values.h"
#include "core/scene/bilinear.h"

namespace limn::scene {
namespace {

/// uv brought near 0, so that texel coordinates fit an int and keep their precision.
float reduce(float u, Wrap wrap) {
  if (!std::isfinite(u)) return 0.f;
  if (wrap == Wrap::clamp) return std::clamp(u, -1.f, 2.f);
  return wrap == Wrap::mirror ? u - 2.f * std::floor(0.5f * u) : u - std::floor(u);
}

/// The values `at(level)` of the two levels next to `lod`, mixed.
template <class Level>
auto betweenLevels(std::size_t levels, float lod, const Level& at) {
  const float level = lod > 0.f ? std::min(lod, static_cast<float>(levels - 1)) : 0.f;
  const auto fine = static_cast<std::size_t>(level);
  const auto value = at(fine);
  const float fraction = level - static_cast<float>(fine);
  return fraction == 0.f ? value : glm::mix(value, at(fine + 1), fraction);
}

}  // namespace

glm::vec4 sampleTexture(const Scene& scene, const TextureRef& texture, glm::vec2 uv, float lod) {
  if (texture.image == kNone) return glm::vec4(1);
  const TextureImage& image = scene.images[static_cast<size_t>(texture.image)];
  if (image.levels.empty()) return glm::vec4(1);
  uv = {reduce(uv.x, texture.wrapS), reduce(uv.y, texture.wrapT)};
  const auto &colour = byteValues(image.srgb), &alpha = byteValues(false);
  return betweenLevels(image.levels.size(), lod, [&](std::size_t index) {
    const TextureImage::Level& level = image.levels[index];
    const auto texel = [&](int x, int y) {
      const size_t at =
          4 * (static_cast<size_t>(y) * static_cast<size_t>(level.width) + static_cast<size_t>(x));
      const uint8_t* p = level.rgba.data() + at;
      return glm::vec4(colour[p[0]], colour[p[1]], colour[p[2]], alpha[p[3]]);
    };
    return bilinear({level.width, level.height}, texture.wrapS, texture.wrapT, uv, texel);
  });
}

glm::vec2 textureSize(const Scene& scene, const TextureRef& texture) {
  if (texture.image == kNone) return {1, 1};
  const TextureImage& image = scene.images[static_cast<size_t>(texture.image)];
  if (image.levels.empty()) return {1, 1};
  return {image.levels[0].width, image.levels[0].height};
}

glm::vec2 sampleSlopes(const std::vector<relief::SlopeLevel>& levels, Wrap wrap, glm::vec2 uv, float lod) {
  uv = {reduce(uv.x, wrap), reduce(uv.y, wrap)};
  return betweenLevels(levels.size(), lod, [&](std::size_t index) {
    const relief::SlopeLevel& level = levels[index];
    return bilinear(level.size, wrap, wrap, uv, [&](int x, int y) {
      return level.slopes[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.size.x) +
                          static_cast<std::size_t>(x)];
    });
  });
}

}  // namespace limn::scene
