#include "core/scene/light_texture.h"

#include <algorithm>
#include <cmath>

#include "core/image/byte_values.h"
#include "core/scene/bilinear.h"

namespace limn::scene {

LightTexture makeLightTexture(const TextureImage& image) {
  const TextureImage::Level& level = image.levels.at(0);
  constexpr int side = LightTexture::side;
  // Points per texel and axis: as many as there are texels of the image, so that each counts.
  const int across = std::max(1, (level.width + side - 1) / side),
            down = std::max(1, (level.height + side - 1) / side);
  const auto& colour = byteValues(image.srgb);
  const auto texel = [&](int x, int y) {
    const uint8_t* rgba = level.rgba.data() + 4 * (static_cast<size_t>(y) * static_cast<size_t>(level.width) +
                                                   static_cast<size_t>(x));
    return glm::vec3(colour[rgba[0]], colour[rgba[1]], colour[rgba[2]]);
  };
  LightTexture texture;
  texture.texels.resize(size_t{side} * side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      glm::vec3 sum(0);
      for (int i = 0; i < across * down; ++i) {
        const int64_t column = int64_t{x} * across + i % across, row = int64_t{y} * down + i / across;
        sum += texel(static_cast<int>(column * level.width / (side * across)),
                     static_cast<int>(row * level.height / (side * down)));
      }
      // Images have their top row first, v points up.
      texture.texels[static_cast<size_t>(side - 1 - y) * side + static_cast<size_t>(x)] =
          sum / static_cast<float>(across * down);
    }
  return texture;
}

glm::vec3 lightTextureAt(const Scene& scene, const glsl::Light& light, const glm::vec3& receiver) {
  if (light.texture_number == 0) return glm::vec3(1);
  const LightTexture& texture = scene.lightTextures.at(static_cast<size_t>(light.texture_number) - 1);
  const glm::vec2 place = glm::clamp(glsl::light_texture_place(light, receiver), 0.f, 1.f);
  return bilinear(glm::ivec2(LightTexture::side), Wrap::clamp, Wrap::clamp, place, [&](int x, int y) {
    return texture.texels[static_cast<size_t>(y) * LightTexture::side + static_cast<size_t>(x)];
  });
}

}  // namespace limn::scene
