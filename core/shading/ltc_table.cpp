// The table of glsl/light/ltc.glsl, compiled in.
#include "core/shading/ltc_table.h"

#include <array>

namespace limn {
namespace {

constexpr glm::vec4 kTexels[] = {
#include "core/shading/ltc_table.inc"
};
static_assert(std::size(kTexels) == 2 * glsl::ltc_size * glsl::ltc_size);

}  // namespace

glm::vec4 glsl::ltc_texel(int layer, int x, int y) {
  return kTexels[2 * (y * ltc_size + x) + layer];
}

gpu::Texture shading::makeLtcTexture(gpu::Device& device) {
  constexpr int size = glsl::ltc_size;
  gpu::Texture texture(
      device, "ltc table",
      {.target = GL_TEXTURE_2D_ARRAY, .format = GL_RGBA32F, .width = size, .height = size, .layers = 2});
  for (int layer = 0; layer < 2; ++layer) {
    std::vector<glm::vec4> texels;
    for (int i = 0; i < size * size; ++i) texels.push_back(kTexels[2 * i + layer]);
    texture.upload(0, layer, GL_RGBA, GL_FLOAT, texels.data());
  }
  return texture;
}

}  // namespace limn
