// A PNG encoder for tests: RGBA, stored without compression; the declared size may lie.
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

/// `rgba`: width * height * 4 bytes, top row first (fewer where only the header matters).
inline std::vector<std::byte> png(std::uint32_t width, std::uint32_t height,
                                  const std::vector<std::uint8_t>& rgba) {
  std::string rows;
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    if (i % (4ull * width) == 0) rows.push_back(0);
    rows.push_back(static_cast<char>(rgba[i]));
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
  header += std::string("\x08\x06\0\0\0", 5);
  std::string out("\x89PNG\r\n\x1a\n");
  appendChunk(out, "IHDR", header);
  appendChunk(out, "IDAT", data);
  appendChunk(out, "IEND", "");
  return GltfBuilder::toBytes(out);
}

}  // namespace limn::test
