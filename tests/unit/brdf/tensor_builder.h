// Writes the container of the RGL's BRDF files, and the smallest of these files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace limn::brdf::test {

struct Array {
  std::vector<std::uint64_t> shape;
  std::vector<float> values;
};

/// The arrays of a file by name.
using Arrays = std::map<std::string, Array>;

/// Fills an array by a function of its indices.
template <class Value>
Array filled(std::vector<std::uint64_t> shape, Value value) {
  std::uint64_t count = 1;
  for (const std::uint64_t side : shape) count *= side;
  Array array{.shape = std::move(shape), .values = {}};
  std::vector<std::uint64_t> index(array.shape.size());
  for (std::uint64_t i = 0; i < count; ++i) {
    std::uint64_t rest = i;
    for (std::size_t d = index.size(); d-- > 0; rest /= array.shape[d]) index[d] = rest % array.shape[d];
    array.values.push_back(static_cast<float>(value(index)));
  }
  return array;
}

/// Where node i of `count` lies that divide [0, 1].
inline double onGrid(std::uint64_t i, std::uint64_t count) {
  return static_cast<double>(i) / static_cast<double>(count - 1);
}

/// The smallest file that is read.
inline Arrays smallFile() {
  return {{"phi_i", {{1}, {0}}},
          {"theta_i", {{2}, {0, 1.5f}}},
          {"ndf", {{1, 2}, {1, 1}}},
          {"sigma", {{1, 2}, {1, 1}}},
          {"vndf", {{1, 2, 2, 2}, {1, 2, 3, 4, 1, 1, 1, 1}}},
          {"rgb", {{1, 2, 3, 2, 2}, std::vector<float>(24, 1)}}};
}

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
