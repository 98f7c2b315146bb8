// Declares the reading of WebP pictures by libwebp, with straight alpha: OpenImageIO 2.4 multiplies colours
// by alpha, which 8 bits do not give back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace limn {

/// Returns whether the bytes begin as a WebP file does: "RIFF", a size, "WEBP".
bool isWebp(std::span<const std::byte> bytes);

/// Holds what the header of a WebP says.
struct WebpHeader {
  int width = 0, height = 0;  ///< pixels, as large as the format allows: not checked against any limit
  bool alpha = false;         ///< it may have some
};
/// Returns what the header says. Throws Error with one line that begins with `name` for a damaged header and
/// for an animation.
WebpHeader readWebpHeader(std::span<const std::byte> bytes, const std::string& name);

/// Writes R, G, B, A of all pixels, rows from the top, as they are stored, to `rgba`, which holds 4 * width *
/// height bytes. Throws Error with one line that begins with `name` where the file is truncated or damaged.
void decodeWebp(std::span<const std::byte> bytes, const WebpHeader& header, std::span<std::uint8_t> rgba,
                const std::string& name);

}  // namespace limn
