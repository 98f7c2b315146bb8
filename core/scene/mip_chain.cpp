#include "core/scene/mip_chain.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/image/byte_values.h"
#include "glsl/numeric/mip_weights.glsl"
#include "glsl/numeric/srgb.glsl"

namespace limn::scene {
namespace {

/// Linear value to the nearest byte, as sRGB by the number of midpoints between decoded steps that it
/// reaches. A table has those of values between two of which lies one midpoint at most.
class Encoder {
 public:
  explicit Encoder(bool srgb) : srgb_(srgb) {
    for (int i = 0; i < 255; ++i)
      midpoint_[static_cast<std::size_t>(i)] = glsl::srgb_decode((static_cast<float>(i) + 0.5f) / 255.f);
    std::size_t reached = 0;
    for (std::size_t step = 0; step < reached_.size(); ++step) {
      while (reached < midpoint_.size() && midpoint_[reached] * kSteps <= static_cast<float>(step)) ++reached;
      reached_[step] = static_cast<std::uint8_t>(reached);
    }
  }
  std::uint8_t operator()(float value) const {
    if (!srgb_) return static_cast<std::uint8_t>(std::clamp(value, 0.f, 1.f) * 255.f + 0.5f);
    std::size_t reached = reached_[static_cast<std::size_t>(std::clamp(value, 0.f, 1.f) * kSteps)];
    while (reached < midpoint_.size() && midpoint_[reached] <= value) ++reached;
    return static_cast<std::uint8_t>(reached);
  }

 private:
  static constexpr int kSteps = 4096;  // a power of two: products with it are exact

  bool srgb_;
  std::array<float, 255> midpoint_{};
  std::array<std::uint8_t, kSteps + 1> reached_{};
};

TextureImage::Level halve(const TextureImage::Level& from, bool srgb, const Encoder& encode) {
  const auto &colour = byteValues(srgb), &alpha = byteValues(false);
  TextureImage::Level to;
  to.width = std::max(1, from.width / 2);
  to.height = std::max(1, from.height / 2);
  to.rgba.resize(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height) * 4);
  std::vector<glm::vec3> columns;
  for (int x = 0; x < to.width; ++x) columns.push_back(glsl::mip_weights(x, from.width, to.width));
  const auto width = static_cast<std::size_t>(from.width);
  std::uint8_t* out = to.rgba.data();
  for (int y = 0; y < to.height; ++y) {
    const glm::vec3 rows = glsl::mip_weights(y, from.height, to.height);
    for (std::size_t x = 0; x < columns.size(); ++x) {
      glm::vec4 sum(0);
      for (int r = 0; r < 3 && rows[r] > 0; ++r) {
        const std::uint8_t* texel = &from.rgba[(static_cast<std::size_t>(2 * y + r) * width + 2 * x) * 4];
        for (int c = 0; c < 3 && columns[x][c] > 0; ++c, texel += 4)
          sum += rows[r] * columns[x][c] *
                 glm::vec4(colour[texel[0]], colour[texel[1]], colour[texel[2]], alpha[texel[3]]);
      }
      for (int channel = 0; channel < 3; ++channel) *out++ = encode(sum[channel]);
      *out++ = static_cast<std::uint8_t>(std::min(sum.w, 1.f) * 255.f + 0.5f);
    }
  }
  return to;
}

}  // namespace

void buildMipChain(TextureImage& texture) {
  static const Encoder linear(false), srgb(true);
  const Encoder& encode = texture.srgb ? srgb : linear;
  while (texture.levels.back().width > 1 || texture.levels.back().height > 1)
    texture.levels.push_back(halve(texture.levels.back(), texture.srgb, encode));
}

}  // namespace limn::scene
