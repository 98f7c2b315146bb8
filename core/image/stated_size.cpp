#include "core/image/stated_size.h"

#include <cstring>
#include <string_view>

namespace limn {
namespace {

using Bytes = std::span<const std::byte>;

bool holds(Bytes bytes, std::size_t at, std::string_view text) {
  return at + text.size() <= bytes.size() && std::memcmp(bytes.data() + at, text.data(), text.size()) == 0;
}

std::uint64_t bigEndian(Bytes bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | std::to_integer<std::uint64_t>(bytes[at + i]);
  return value;
}

std::uint64_t littleEndian(Bytes bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value << 8 | std::to_integer<std::uint64_t>(bytes[at + i]);
  return value;
}

/// Of the first frame header (SOF0 to SOF15, without DHT, JPG and DAC).
StatedSize jpegSize(Bytes bytes) {
  for (std::size_t i = 2; i + 9 < bytes.size() && bigEndian(bytes, i, 1) == 0xff;) {
    const std::uint64_t marker = bigEndian(bytes, i + 1, 1);
    if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc)
      return {bigEndian(bytes, i + 7, 2), bigEndian(bytes, i + 5, 2)};
    i += marker == 0xff ? 1 : 2 + static_cast<std::size_t>(bigEndian(bytes, i + 2, 2));
  }
  return {};
}

/// Of the first chunk: lossy, lossless, or the canvas of an extended file.
StatedSize webpSize(Bytes bytes) {
  if (bytes.size() < 30) return {};
  constexpr std::uint64_t side = 0x3fff;
  if (holds(bytes, 12, "VP8X")) return {1 + littleEndian(bytes, 24, 3), 1 + littleEndian(bytes, 27, 3)};
  if (holds(bytes, 12, "VP8 ")) return {littleEndian(bytes, 26, 2) & side, littleEndian(bytes, 28, 2) & side};
  if (!holds(bytes, 12, "VP8L")) return {};
  const std::uint64_t bits = littleEndian(bytes, 21, 4);
  return {1 + (bits & side), 1 + (bits >> 14 & side)};
}

}  // namespace

StatedSize statedSize(Bytes bytes) {
  if (holds(bytes, 0, "\x89P") && bytes.size() >= 24)
    return {bigEndian(bytes, 16, 4), bigEndian(bytes, 20, 4)};
  if (holds(bytes, 0, "\xff\xd8")) return jpegSize(bytes);
  return holds(bytes, 0, "RIFF") && holds(bytes, 8, "WEBP") ? webpSize(bytes) : StatedSize{};
}

}  // namespace limn
