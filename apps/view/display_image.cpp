#include "apps/view/display_image.h"

#include <cmath>

#include "glsl/srgb.glsl"

namespace limn::app {

Image8 toneMapped(const Image& image, float exposureEv) {
  Image8 result{image.width(), image.height(), {}};
  result.data.reserve(static_cast<size_t>(result.width) * static_cast<size_t>(result.height) * 4);
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x) {
      for (int c = 0; c < 3; ++c)
        result.data.push_back(
            static_cast<uint8_t>(std::lround(255 * glsl::tone_map(image.at(x, y, c), exposureEv))));
      result.data.push_back(255);
    }
  }
  return result;
}

gpu::Texture toTexture(gpu::Device& device, const Image8& image) {
  gpu::Texture texture(device, "picture", {.format = GL_RGBA8, .width = image.width, .height = image.height});
  texture.upload(0, 0, GL_RGBA, GL_UNSIGNED_BYTE, image.data.data());
  return texture;
}

Image fromBottomFirst(glm::ivec2 size, std::span<const uint8_t> pixels) {
  Image image = Image::rgb(size.x, size.y);
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const auto at =
          3 * (static_cast<size_t>(size.y - 1 - y) * static_cast<size_t>(size.x) + static_cast<size_t>(x));
      for (int c = 0; c < 3; ++c)
        image.at(x, y, c) =
            glsl::srgb_decode(static_cast<float>(pixels[at + static_cast<size_t>(c)]) / 255.f);
    }
  }
  return image;
}

}  // namespace limn::app
