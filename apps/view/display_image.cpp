#include "apps/view/display_image.h"

#include <algorithm>
#include <cmath>

#include "core/image/byte_values.h"

namespace limn::app {

std::shared_ptr<const Image8> readBack(const gpu::Texture& texture) {
  auto image = std::make_shared<Image8>(Image8{texture.desc().width, texture.desc().height, {}});
  const size_t row = static_cast<size_t>(image->width) * 4;
  const auto rows = static_cast<size_t>(image->height);
  image->data.resize(row * rows);
  texture.read(0, GL_RGBA, GL_UNSIGNED_BYTE, image->data.data(), image->data.size());
  uint8_t* data = image->data.data();  // its bottom row first, as OpenGL has them
  for (size_t y = 0; y < rows / 2; ++y)
    std::swap_ranges(data + y * row, data + (y + 1) * row, data + (rows - 1 - y) * row);
  return image;
}

Image fromBottomFirst(glm::ivec2 size, std::span<const uint8_t> pixels) {
  const auto& colour = byteValues(true);
  Image image = Image::rgb(size.x, size.y);
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const auto at =
          3 * (static_cast<size_t>(size.y - 1 - y) * static_cast<size_t>(size.x) + static_cast<size_t>(x));
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = colour[pixels[at + static_cast<size_t>(c)]];
    }
  }
  return image;
}

}  // namespace limn::app
