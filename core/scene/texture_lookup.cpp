#include "core/scene/texture_lookup.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "glsl/numeric/srgb.glsl"

namespace limn::scene {
namespace {

struct ByteTable {
  std::array<float, 256> srgb, linear;
  ByteTable() {
    for (int i = 0; i < 256; ++i) {
      linear[i] = static_cast<float>(i) / 255.f;
      srgb[i] = glsl::srgb_decode(linear[i]);
    }
  }
};

int wrapIndex(int i, int size, Wrap wrap) {
  if (wrap == Wrap::clamp) return std::clamp(i, 0, size - 1);
  const int period = wrap == Wrap::mirror ? 2 * size : size;
  i %= period;
  if (i < 0) i += period;
  return i < size ? i : 2 * size - 1 - i;
}

/// uv brought near 0, so that texel coordinates fit an int and keep their precision.
float reduce(float u, Wrap wrap) {
  if (!std::isfinite(u)) return 0.f;
  if (wrap == Wrap::clamp) return std::clamp(u, -1.f, 2.f);
  return wrap == Wrap::mirror ? u - 2.f * std::floor(0.5f * u) : u - std::floor(u);
}

glm::vec4 texel(const TextureImage::Level& level, bool srgb, int x, int y) {
  static const ByteTable table;
  const size_t at = 4 * (static_cast<size_t>(y) * static_cast<size_t>(level.width) + static_cast<size_t>(x));
  const uint8_t* p = level.rgba.data() + at;
  const auto& colour = srgb ? table.srgb : table.linear;
  return {colour[p[0]], colour[p[1]], colour[p[2]], table.linear[p[3]]};
}

glm::vec4 bilinear(const TextureImage& image, int index, Wrap wrapS, Wrap wrapT, glm::vec2 uv) {
  const TextureImage::Level& level = image.levels[static_cast<size_t>(index)];
  const float s = uv.x * static_cast<float>(level.width) - 0.5f;
  const float t = uv.y * static_cast<float>(level.height) - 0.5f;
  const float s0 = std::floor(s), t0 = std::floor(t);
  const int x0 = wrapIndex(static_cast<int>(s0), level.width, wrapS);
  const int x1 = wrapIndex(static_cast<int>(s0) + 1, level.width, wrapS);
  const int y0 = wrapIndex(static_cast<int>(t0), level.height, wrapT);
  const int y1 = wrapIndex(static_cast<int>(t0) + 1, level.height, wrapT);
  const glm::vec4 top = glm::mix(texel(level, image.srgb, x0, y0), texel(level, image.srgb, x1, y0), s - s0);
  const glm::vec4 bottom =
      glm::mix(texel(level, image.srgb, x0, y1), texel(level, image.srgb, x1, y1), s - s0);
  return glm::mix(top, bottom, t - t0);
}

}  // namespace

glm::vec4 sampleTexture(const Scene& scene, const TextureRef& texture, glm::vec2 uv, float lod) {
  if (texture.image == kNone) return glm::vec4(1);
  const TextureImage& image = scene.images[static_cast<size_t>(texture.image)];
  if (image.levels.empty()) return glm::vec4(1);
  uv = {reduce(uv.x, texture.wrapS), reduce(uv.y, texture.wrapT)};
  const int last = static_cast<int>(image.levels.size()) - 1;
  const float level = lod > 0.f ? std::min(lod, static_cast<float>(last)) : 0.f;
  const int fine = static_cast<int>(level);
  const glm::vec4 value = bilinear(image, fine, texture.wrapS, texture.wrapT, uv);
  const float fraction = level - static_cast<float>(fine);
  if (fraction == 0.f) return value;
  return glm::mix(value, bilinear(image, fine + 1, texture.wrapS, texture.wrapT, uv), fraction);
}

glm::vec2 textureSize(const Scene& scene, const TextureRef& texture) {
  if (texture.image == kNone) return {1, 1};
  const TextureImage& image = scene.images[static_cast<size_t>(texture.image)];
  if (image.levels.empty()) return {1, 1};
  return {image.levels[0].width, image.levels[0].height};
}

}  // namespace limn::scene
