// Tiny glTF files for tests, made in memory.
#pragma once

#include <cstddef>
#include <cstring>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace limn::test {

/// Collects buffer data and the JSON beside it; `root` is free to be changed by hand.
class GltfBuilder {
 public:
  using json = nlohmann::json;
  static constexpr int kByte = 5120, kUbyte = 5121, kShort = 5122, kUshort = 5123, kUint = 5125,
                       kFloat = 5126;

  GltfBuilder() { root = {{"asset", {{"version", "2.0"}}}}; }

  json root;

  /// Appends a buffer view of its own and returns its index.
  int view(const void* data, std::size_t size) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    const std::size_t offset = bytes_.size();
    bytes_.resize(offset + size);
    if (size > 0) std::memcpy(bytes_.data() + offset, data, size);
    return append("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
  }
  template <class T>
  int accessor(const std::vector<T>& data, int componentType, const char* type) {
    return append("accessors", {{"bufferView", view(data.data(), data.size() * sizeof(T))},
                                {"componentType", componentType},
                                {"count", data.size()},
                                {"type", type}});
  }
  int floats(const std::vector<float>& v) { return accessor(v, kFloat, "SCALAR"); }
  int vec2(const std::vector<glm::vec2>& v) { return accessor(v, kFloat, "VEC2"); }
  int vec3(const std::vector<glm::vec3>& v) { return accessor(v, kFloat, "VEC3"); }
  int vec4(const std::vector<glm::vec4>& v) { return accessor(v, kFloat, "VEC4"); }
  int indices(const std::vector<std::uint32_t>& v) { return accessor(v, kUint, "SCALAR"); }

  /// Appends to a top-level array and returns the index.
  int append(const char* list, json entry) {
    root[list].push_back(std::move(entry));
    return static_cast<int>(root[list].size()) - 1;
  }

  /// A mesh of one primitive; returns the mesh's index.
  int mesh(json attributes, int indices = -1, int material = -1) {
    json primitive = {{"attributes", std::move(attributes)}};
    if (indices >= 0) primitive["indices"] = indices;
    if (material >= 0) primitive["material"] = material;
    return append("meshes", {{"name", "m"}, {"primitives", {primitive}}});
  }
  int node(json entry) { return append("nodes", std::move(entry)); }
  int meshNode(int mesh) { return node({{"name", "n"}, {"mesh", mesh}}); }

  /// A node with a triangle in the XY plane: (0,0,0), (1,0,0), (0,1,0); normals +Z.
  int triangle(int material = -1) {
    const int positions = vec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    const int normals = vec3({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
    const int uvs = vec2({{0, 0}, {1, 0}, {0, 1}});
    return meshNode(mesh({{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}}, -1, material));
  }
  /// A material, an image in the binary chunk and a texture; returns the material's index.
  int texturedMaterial(const std::vector<std::byte>& image, const char* slot = "baseColorTexture") {
    const int source =
        append("images", {{"bufferView", view(image.data(), image.size())}, {"mimeType", "image/png"}});
    const int texture = append("textures", {{"source", source}});
    return append("materials", {{"pbrMetallicRoughness", {{slot, {{"index", texture}}}}}});
  }
  /// A light and its node's index.
  int light(json source, json node = json::object()) {
    json& lights = root["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(std::move(source));
    node["extensions"]["KHR_lights_punctual"]["light"] = lights.size() - 1;
    return append("nodes", std::move(node));
  }

  std::vector<std::byte> glb() const {
    json document = root;
    if (!bytes_.empty() && !document.contains("buffers"))
      document["buffers"] = json::array({{{"byteLength", bytes_.size()}}});
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string out;
    const auto word = [&](std::size_t value) {
      for (int i = 0; i < 4; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xff));
    };
    const std::size_t padded = (bytes_.size() + 3) / 4 * 4;
    out += "glTF";
    word(2);
    word(20 + text.size() + (padded ? 8 + padded : 0));
    word(text.size());
    out += "JSON" + text;
    if (padded) {
      word(padded);
      out += std::string("BIN\0", 4);
      out.append(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
      out.resize(out.size() + padded - bytes_.size(), '\0');
    }
    return toBytes(out);
  }
  std::vector<std::byte> text() const { return toBytes(root.dump()); }

  static std::vector<std::byte> toBytes(const std::string& s) {
    std::vector<std::byte> out(s.size());
    std::memcpy(out.data(), s.data(), s.size());
    return out;
  }

 private:
  std::vector<unsigned char> bytes_;
};

}  // namespace limn::test
