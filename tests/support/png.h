// A PNG encoder for tests: RGBA or grey, stored without compression; the declared size may lie.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/gltf_builder.h"

namespace limn::test {

inline void appendWord(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(value >> shift & 0xff));
}

inline void appendChunk(std::string& out, const std::string& type, const std::string& data) {
  appendWord(out, static_cast<std::uint32_t>(data.size()));
  std::uint32_t code = ~0u;
  for (const char c : type + data) {
    code ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) code = code >> 1 ^ (code & 1 ? 0xedb88320u : 0u);
  }
  out += type + data;
  appendWord(out, ~code);
}

/// `bytes`: those of all pixels, top row first (fewer where only the header matters). `colour`: the format's
/// code, 0 for grey and 6 for RGBA; `depth`: bits of a value.
inline std::vector<std::byte> pngOf(std::uint32_t width, std::uint32_t height, char depth, char colour,
                                    const std::vector<std::uint8_t>& bytes) {
  const std::size_t row = (colour == 6 ? 4ull : 1ull) * static_cast<std::size_t>(depth / 8) * width;
  std::string rows;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i % row == 0) rows.push_back(0);
    rows.push_back(static_cast<char>(bytes[i]));
  }
  std::uint32_t a = 1, b = 0;
  for (const char c : rows) {
    a = (a + static_cast<std::uint8_t>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const std::uint32_t length = static_cast<std::uint32_t>(rows.size());
  std::string data("\x78\x01\x01", 3);
  for (const std::uint32_t v : {length, ~length}) {
    data.push_back(static_cast<char>(v & 0xff));
    data.push_back(static_cast<char>(v >> 8 & 0xff));
  }
  data += rows;
  appendWord(data, b << 16 | a);
  std::string header;
  appendWord(header, width);
  appendWord(header, height);
  header += {depth, colour, 0, 0, 0};
  std::string out("\x89PNG\r\n\x1a\n");
  appendChunk(out, "IHDR", header);
  appendChunk(out, "IDAT", data);
  appendChunk(out, "IEND", "");
  return GltfBuilder::toBytes(out);
}

/// `rgba`: width * height * 4 bytes, top row first (fewer where only the header matters).
inline std::vector<std::byte> png(std::uint32_t width, std::uint32_t height,
                                  const std::vector<std::uint8_t>& rgba) {
  return pngOf(width, height, 8, 6, rgba);
}

/// Grey of 16 bits.
inline std::vector<std::byte> png16(std::uint32_t width, std::uint32_t height,
                                    const std::vector<std::uint16_t>& grey) {
  std::vector<std::uint8_t> bytes;
  for (const std::uint16_t value : grey) {
    bytes.push_back(static_cast<std::uint8_t>(value >> 8));
    bytes.push_back(static_cast<std::uint8_t>(value & 0xff));
  }
  return pngOf(width, height, 16, 0, bytes);
}

}  // namespace limn::test
