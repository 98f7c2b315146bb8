#include "core/image/private/image_format.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "core/base/error.h"
#include "core/image/private/exr_header.h"

namespace limn {
namespace {

/// Each scan of a progressive JPEG is a pass over the whole picture, however little it says; encoders make
/// ten or so.
constexpr int kMaxJpegScans = 100;

/// Empty, or what is wrong. libjpeg fills what a truncated file lacks with grey. A complete one has an end
/// marker (FF D9) after its first scan; within entropy-coded data FF is always followed by 00 or a restart
/// marker.
std::string jpegProblem(std::span<const std::byte> bytes) {
  const std::string truncated = "truncated JPEG";
  const auto at = [&](std::size_t i) { return std::to_integer<unsigned>(bytes[i]); };
  std::size_t i = 2;
  while (i + 4 <= bytes.size()) {  // header segments, whose thumbnails may contain end markers
    if (at(i) != 0xff) return truncated;
    const unsigned marker = at(i + 1);
    if (marker == 0xff) {
      ++i;
      continue;
    }
    i += 2 + (at(i + 2) << 8 | at(i + 3));
    if (marker == 0xda) break;
  }
  int scans = 1;
  for (; i + 1 < bytes.size(); ++i) {
    if (at(i) != 0xff) continue;
    if (at(i + 1) == 0xd9) return {};
    if (at(i + 1) == 0xda && ++scans > kMaxJpegScans)
      return fmt::format("more than {} scans, which is as many as are accepted", kMaxJpegScans);
  }
  return truncated;
}

/// Cyclic redundancy code of PNG chunks (ISO 3309; reflected polynomial EDB88320).
std::uint32_t chunkCode(std::span<const std::byte> bytes) {
  static constexpr auto kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      table[i] = i;
      for (int bit = 0; bit < 8; ++bit) table[i] = table[i] >> 1 ^ (table[i] & 1 ? 0xedb88320u : 0u);
    }
    return table;
  }();
  std::uint32_t code = ~0u;
  for (const std::byte byte : bytes)
    code = code >> 8 ^ kTable[(code ^ std::to_integer<std::uint32_t>(byte)) & 255];
  return ~code;
}

/// Whether every chunk up to IEND is there and undamaged. libpng would print its complaints itself and
/// overlooks some; none of the checked files gives it a reason.
bool pngIsComplete(std::span<const std::byte> bytes) {
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
    return value;
  };
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::size_t length = number(at);
    if (length > bytes.size() - at - 12) return false;
    if (chunkCode(bytes.subspan(at + 4, length + 4)) != number(at + 8 + length)) return false;
    if (std::memcmp(bytes.data() + at + 4, "IEND", 4) == 0) return true;
    at += length + 12;
  }
  return false;
}

}  // namespace

ImageFormat detectImageFormat(std::span<const std::byte> bytes, const std::string& name) {
  const auto startsWith = [&](std::string_view magic) {
    return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
  };
  if (startsWith("\x76\x2f\x31\x01")) return ImageFormat::exr;
  if (startsWith("\x89PNG\r\n\x1a\n")) return ImageFormat::png;
  if (startsWith("\xff\xd8\xff")) return ImageFormat::jpeg;
  if (startsWith("#?")) return ImageFormat::hdr;
  throw Error(fmt::format("{}: not a picture; EXR, HDR, PNG, JPEG or WebP is accepted", name));
}

std::string imageFileProblem(std::span<const std::byte> bytes, ImageFormat format) {
  if (format == ImageFormat::jpeg) return jpegProblem(bytes);
  if (format == ImageFormat::exr) return exrHeaderProblem(bytes);
  return format == ImageFormat::png && !pngIsComplete(bytes) ? "truncated or damaged PNG" : "";
}

}  // namespace limn
