#include "core/scene/mip_chain.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/image/byte_values.h"
#include "glsl/numeric/srgb.glsl"

namespace limn::scene {
namespace {

/// The texels of one side that a texel of the next level covers, and the share of each.
struct Footprint {
  int first = 0, count = 0;
  std::array<float, 3> weight{};
};

std::vector<Footprint> footprints(int from, int to) {
  std::vector<Footprint> out(static_cast<std::size_t>(to));
  const double width = static_cast<double>(from) / to;  // 1, 2, or 2 + 1/to: at most 3 texels, 4 never
  for (int i = 0; i < to; ++i) {
    const double low = i * width, high = (i + 1) * width;
    Footprint& f = out[static_cast<std::size_t>(i)];
    f.first = static_cast<int>(low + 1e-9);
    for (int j = f.first; j < from && f.count < 3; ++j) {
      const double share = std::min<double>(high, j + 1) - std::max<double>(low, j);
      if (share <= 1e-9) break;
      f.weight[static_cast<std::size_t>(f.count++)] = static_cast<float>(share / width);
    }
  }
  return out;
}

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
  const auto columns = footprints(from.width, to.width), rows = footprints(from.height, to.height);
  std::uint8_t* out = to.rgba.data();
  for (const Footprint& row : rows) {
    for (const Footprint& column : columns) {
      glm::vec4 sum(0);
      for (int r = 0; r < row.count; ++r) {
        const std::size_t line =
            static_cast<std::size_t>(row.first + r) * static_cast<std::size_t>(from.width);
        for (int c = 0; c < column.count; ++c) {
          const std::uint8_t* texel = &from.rgba[(line + static_cast<std::size_t>(column.first + c)) * 4];
          const float weight =
              row.weight[static_cast<std::size_t>(r)] * column.weight[static_cast<std::size_t>(c)];
          sum += weight * glm::vec4(colour[texel[0]], colour[texel[1]], colour[texel[2]], alpha[texel[3]]);
        }
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
