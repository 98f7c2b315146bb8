// Declares a scene of the library as it lies on disk: the JSON and the arrays of its .glb, read without
// limn's loader.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/paths.h"

namespace limn::test {

inline const std::filesystem::path kAssets = std::filesystem::path(kBinaryDir) / "assets";

inline std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Holds the binary glTF file of a scene. What is not glTF fails the test.
struct Glb {
  nlohmann::json root;
  std::string binary;

  explicit Glb(const std::string& scene) {
    const std::string bytes = bytesOf(kAssets / scene / (scene + ".glb"));
    const auto word = [&](std::size_t at) {
      std::uint32_t value = 0;
      if (at + 4 <= bytes.size()) std::memcpy(&value, bytes.data() + at, 4);
      return value;
    };
    EXPECT_EQ(word(0), 0x46546c67u) << scene;
    EXPECT_EQ(word(4), 2u);
    EXPECT_EQ(word(8), bytes.size());
    const std::size_t length = word(12);
    EXPECT_EQ(word(16), 0x4e4f534au);
    if (20 + length + 8 > bytes.size()) return;
    root = nlohmann::json::parse(bytes.substr(20, length), nullptr, false);
    EXPECT_FALSE(root.is_discarded());
    EXPECT_EQ(word(20 + length + 4), 0x004e4942u);
    binary = bytes.substr(28 + length);
  }

  template <class T>
  std::vector<T> read(int accessor) const {
    const nlohmann::json& a = root.at("accessors").at(static_cast<std::size_t>(accessor));
    const nlohmann::json& view = root.at("bufferViews").at(a.at("bufferView").get<std::size_t>());
    std::vector<T> values(a.at("count").get<std::size_t>());
    EXPECT_LE(view.at("byteOffset").get<std::size_t>() + values.size() * sizeof(T), binary.size());
    EXPECT_EQ(view.at("byteOffset").get<std::size_t>() % 4, 0u);
    EXPECT_EQ(view.at("byteLength").get<std::size_t>(), values.size() * sizeof(T));
    std::memcpy(values.data(), binary.data() + view.at("byteOffset").get<std::size_t>(),
                values.size() * sizeof(T));
    return values;
  }

  std::vector<std::uint32_t> indices(const nlohmann::json& primitive) const {
    const int accessor = primitive.at("indices");
    if (root.at("accessors").at(static_cast<std::size_t>(accessor)).at("componentType") == 5125) {
      return read<std::uint32_t>(accessor);
    }
    const auto narrow = read<std::uint16_t>(accessor);
    return {narrow.begin(), narrow.end()};
  }

  /// Triangles of every node that shows a mesh, instances counted.
  std::size_t trianglesShown() const {
    std::size_t sum = 0;
    for (const nlohmann::json& node : root.at("nodes")) {
      if (!node.contains("mesh")) continue;
      std::size_t copies = 1;
      if (node.contains("extensions") && node["extensions"].contains("EXT_mesh_gpu_instancing")) {
        const std::size_t accessor =
            node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"];
        copies = root["accessors"][accessor]["count"];
      }
      for (const nlohmann::json& primitive : root["meshes"][node["mesh"].get<std::size_t>()]["primitives"]) {
        sum += copies *
               root["accessors"][primitive["indices"].get<std::size_t>()]["count"].get<std::size_t>() / 3;
      }
    }
    return sum;
  }
};

using Vec3 = std::array<float, 3>;
using Vec4 = std::array<float, 4>;

}  // namespace limn::test
