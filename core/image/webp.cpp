#include "core/image/private/webp.h"

#include <fmt/format.h>
#include <webp/decode.h>

#include <cstring>

#include "core/base/error.h"

namespace limn {
namespace {

const std::uint8_t* dataOf(std::span<const std::byte> bytes) {
  return reinterpret_cast<const std::uint8_t*>(bytes.data());
}

[[noreturn]] void failDamaged(const std::string& name) {
  throw Error(fmt::format("{}: truncated or damaged WebP", name));
}

}  // namespace

bool isWebp(std::span<const std::byte> bytes) {
  return bytes.size() >= 12 && std::memcmp(bytes.data(), "RIFF", 4) == 0 &&
         std::memcmp(bytes.data() + 8, "WEBP", 4) == 0;
}

WebpHeader readWebpHeader(std::span<const std::byte> bytes, const std::string& name) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(dataOf(bytes), bytes.size(), &features) != VP8_STATUS_OK) failDamaged(name);
  if (features.has_animation) throw Error(fmt::format("{}: animated WebP pictures are not accepted", name));
  return {features.width, features.height, features.has_alpha != 0};
}

void decodeWebp(std::span<const std::byte> bytes, const WebpHeader& header, std::span<std::uint8_t> rgba,
                const std::string& name) {
  if (!WebPDecodeRGBAInto(dataOf(bytes), bytes.size(), rgba.data(), rgba.size(), 4 * header.width))
    failDamaged(name);
}

}  // namespace limn
