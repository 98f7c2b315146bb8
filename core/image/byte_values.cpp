#include "core/image/byte_values.h"

#include <cstddef>

#include "glsl/numeric/srgb.glsl"

namespace limn {
namespace {

struct ByteTables {
  std::array<float, 256> decoded{}, shares{};
  ByteTables() {
    for (std::size_t i = 0; i < shares.size(); ++i) {
      shares[i] = static_cast<float>(i) / 255.f;
      decoded[i] = glsl::srgb_decode(shares[i]);
    }
  }
};

}  // namespace

const std::array<float, 256>& byteValues(bool srgb) {
  static const ByteTables tables;
  return srgb ? tables.decoded : tables.shares;
}

}  // namespace limn
