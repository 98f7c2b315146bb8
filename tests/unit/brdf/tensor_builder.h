// Writes the container of the RGL's BRDF files, and files of a material that is known in closed form.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace limn::brdf::test {

struct Array {
  std::vector<std::uint64_t> shape;
  std::vector<float> values;
};

/// The arrays of a file by name.
using Arrays = std::map<std::string, Array>;

inline std::vector<std::byte> tensorFile(const Arrays& arrays) {
  std::vector<std::byte> bytes;
  const auto put = [&](const void* from, std::size_t count) {
    const auto* first = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + count);
  };
  const auto number = [&](auto value) { put(&value, sizeof value); };
  put("tensor_file\0\1\0", 14);
  number(static_cast<std::uint32_t>(arrays.size()));
  std::uint64_t offset = 18;
  for (const auto& [name, array] : arrays) offset += 13 + name.size() + 8 * array.shape.size();
  for (const auto& [name, array] : arrays) {
    number(static_cast<std::uint16_t>(name.size()));
    put(name.data(), name.size());
    number(static_cast<std::uint16_t>(array.shape.size()));
    number(std::uint8_t{10});
    number(offset);
    for (const std::uint64_t side : array.shape) number(side);
    offset += 4 * array.values.size();
  }
  for (const auto& [name, array] : arrays) put(array.values.data(), 4 * array.values.size());
  return bytes;
}

}  // namespace limn::brdf::test
