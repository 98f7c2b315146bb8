// WebP pictures for tests, by libwebp's encoder.
#pragma once

#include <webp/encode.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace limn::test {

inline std::vector<std::byte> takenWebp(std::uint8_t* encoded, std::size_t size) {
  std::vector<std::byte> bytes(size);
  if (size > 0) std::memcpy(bytes.data(), encoded, size);
  WebPFree(encoded);
  return bytes;
}

/// Holds R, G, B, A of every pixel exactly, where alpha is not 0.
inline std::vector<std::byte> losslessWebp(int width, int height, const std::vector<std::uint8_t>& rgba) {
  std::uint8_t* encoded = nullptr;
  const std::size_t size = WebPEncodeLosslessRGBA(rgba.data(), width, height, 4 * width, &encoded);
  return takenWebp(encoded, size);
}

inline std::vector<std::byte> lossyWebp(int width, int height, const std::vector<std::uint8_t>& rgba,
                                        float quality = 90) {
  std::uint8_t* encoded = nullptr;
  const std::size_t size = WebPEncodeRGBA(rgba.data(), width, height, 4 * width, quality, &encoded);
  return takenWebp(encoded, size);
}

}  // namespace limn::test
