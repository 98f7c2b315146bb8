// Buffers that meshoptimizer has compressed (EXT_meshopt_compression).
#include <meshoptimizer.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using json = nlohmann::json;
using scene::Primitive;
using scene::Scene;
using testing::Contains;
using testing::HasSubstr;

const Primitive& firstPrimitive(const Scene& s) {
  return s.meshes.at(0).primitives.at(0);
}

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

/// Compresses the view of an accessor; the plain bytes stay where they are, and nothing points at them.
json& compress(GltfBuilder& b, int accessor, const std::vector<unsigned char>& bytes, std::size_t count,
               std::size_t stride, const char* mode, const char* filter = nullptr) {
  const int view = b.view(bytes.data(), bytes.size());
  const json source = b.root["bufferViews"][at(view)];
  json extension = {{"buffer", source["buffer"]},
                    {"byteOffset", source["byteOffset"]},
                    {"byteLength", bytes.size()},
                    {"byteStride", stride},
                    {"count", count},
                    {"mode", mode}};
  if (filter != nullptr) extension["filter"] = filter;
  json& plain = b.root["bufferViews"][b.root["accessors"][at(accessor)]["bufferView"].get<std::size_t>()];
  plain["byteLength"] = count * stride;
  plain["extensions"]["EXT_meshopt_compression"] = extension;
  return plain;
}

template <class T>
std::vector<unsigned char> encodedVertices(const std::vector<T>& values) {
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(values.size(), sizeof(T)));
  bytes.resize(
      meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values.data(), values.size(), sizeof(T)));
  return bytes;
}

const std::vector<glm::vec3> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.25f}};
const std::vector<std::uint32_t> kCornerIndices{0, 1, 2, 2, 1, 3};

/// Two triangles whose positions and indices are compressed.
GltfBuilder compressedQuad(const char* mode = "TRIANGLES") {
  GltfBuilder b;
  const int positions = b.vec3(kCorners), indices = b.indices(kCornerIndices);
  b.meshNode(b.mesh({{"POSITION", positions}}, indices));
  compress(b, positions, encodedVertices(kCorners), kCorners.size(), sizeof(glm::vec3), "ATTRIBUTES");
  const bool triangles = std::string(mode) == "TRIANGLES";
  std::vector<unsigned char> bytes(
      triangles ? meshopt_encodeIndexBufferBound(kCornerIndices.size(), kCorners.size())
                : meshopt_encodeIndexSequenceBound(kCornerIndices.size(), kCorners.size()));
  bytes.resize(triangles ? meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), kCornerIndices.data(),
                                                     kCornerIndices.size())
                         : meshopt_encodeIndexSequence(bytes.data(), bytes.size(), kCornerIndices.data(),
                                                       kCornerIndices.size()));
  compress(b, indices, bytes, kCornerIndices.size(), 4, mode);
  b.root["extensionsRequired"] = {"EXT_meshopt_compression"};
  return b;
}

TEST(MeshoptCompression, GivesBackWhatWasCompressed) {
  for (const char* mode : {"TRIANGLES", "INDICES"}) {
    const Scene scene = loadBuilt(compressedQuad(mode));
    EXPECT_EQ(scene.triangles(), 2u) << mode;
    // Without normals the triangles are split: six vertices, in the order of the indices but for its
    // rotation.
    const Primitive& p = firstPrimitive(scene);
    ASSERT_EQ(p.positions.size(), 6u) << mode;
    for (const glm::vec3& corner : kCorners) EXPECT_THAT(p.positions, Contains(corner)) << mode;
    EXPECT_TRUE(scene.warnings.empty());
  }
}

TEST(MeshoptCompression, FiltersAreUndone) {
  GltfBuilder b;
  const std::vector<glm::vec3> normals{{0, 0, 1}, {0.6f, 0, 0.8f}, {0, -0.6f, 0.8f}};
  const int positions = b.vec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  std::vector<glm::vec4> wide;
  for (const glm::vec3& n : normals) wide.emplace_back(n, 0);
  std::vector<glm::i8vec4> octahedral(3);
  meshopt_encodeFilterOct(octahedral.data(), 3, 4, 8, &wide[0].x);
  const int normal = b.accessor(octahedral, GltfBuilder::kByte, "VEC3");
  b.root["accessors"][at(normal)]["normalized"] = true;
  b.meshNode(b.mesh({{"POSITION", positions}, {"NORMAL", normal}}));
  compress(b, normal, encodedVertices(octahedral), 3, 4, "ATTRIBUTES", "OCTAHEDRAL")["byteStride"] = 4;
  std::vector<glm::vec3> places{{0, 0, 0}, {1.5f, 0, 0}, {0, 1024, 0}};
  std::vector<glm::uvec3> exponential(3);
  meshopt_encodeFilterExp(exponential.data(), 3, 12, 15, &places[0].x);
  compress(b, positions, encodedVertices(exponential), 3, 12, "ATTRIBUTES", "EXPONENTIAL");
  const Primitive p = firstPrimitive(loadBuilt(b));
  for (std::size_t i = 0; i < 3; ++i) {
    expectNear(p.normals[i], normals[i], 0.02f);
    expectNear(p.positions[i], places[i], 0.05f);
  }
}

/// A buffer that stands for what is decoded has no bytes of its own.
TEST(MeshoptCompression, FallbackBuffersNeedNoBytes) {
  GltfBuilder b = compressedQuad();
  std::size_t bytes = 0;
  for (json& view : b.root["bufferViews"])
    bytes = std::max(bytes, view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>());
  b.root["buffers"] = {
      {{"byteLength", bytes}},
      {{"byteLength", 1000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  for (json& view : b.root["bufferViews"])
    if (view.contains("extensions")) view["buffer"] = 1;
  EXPECT_EQ(loadBuilt(b).triangles(), 2u);
  // Without the extension such a view has nothing to show.
  for (json& view : b.root["bufferViews"]) view.erase("extensions");
  EXPECT_THAT(loadError(b.glb()), HasSubstr("buffer 1 has 0"));
}

TEST(MeshoptCompression, RefusesWhatDoesNotFit) {
  const auto refusal = [](const char* key, const json& value, std::size_t view = 0) {
    GltfBuilder b = compressedQuad();
    b.root["bufferViews"][view]["extensions"]["EXT_meshopt_compression"][key] = value;
    return loadError(b.glb());
  };
  const std::string place = "buffer view 0 EXT_meshopt_compression";
  EXPECT_THAT(refusal("buffer", 7), HasSubstr(place + ": buffer 7 does not exist"));
  EXPECT_THAT(refusal("byteLength", 1 << 20), HasSubstr(place + " covers 1048576 bytes"));
  EXPECT_THAT(refusal("byteStride", 10), HasSubstr("byteStride 10 with mode ATTRIBUTES; a multiple of 4"));
  EXPECT_THAT(refusal("byteStride", 512), HasSubstr("byteStride is 512; a whole number in 1 .. 256"));
  EXPECT_THAT(refusal("count", 5), HasSubstr("5 elements of 12 bytes; the view has 48 bytes"));
  EXPECT_THAT(refusal("count", 100'000'000), HasSubstr("cannot hold 100000000 elements"));
  EXPECT_THAT(refusal("count", std::int64_t{9'000'000'000'000'000}), HasSubstr("exceed the limit"));
  EXPECT_THAT(refusal("mode", "POINTS"), HasSubstr("mode is \"POINTS\"; ATTRIBUTES, TRIANGLES or INDICES"));
  EXPECT_THAT(refusal("filter", "QUATERNION"), HasSubstr("byteStride 12 with filter QUATERNION; 8"));
  EXPECT_THAT(refusal("filter", "OCTAHEDRAL"), HasSubstr("4 or 8"));
  EXPECT_THAT(refusal("mode", "TRIANGLES"), HasSubstr("byteStride 12 with mode TRIANGLES; 2 or 4"));
  EXPECT_THAT(refusal("filter", "EXPONENTIAL", 1), HasSubstr("filters are for ATTRIBUTES"));
  EXPECT_THAT(refusal("count", 4, 1), HasSubstr("a multiple of 3"));
  EXPECT_THAT(refusal("byteLength", 20), HasSubstr("cannot be decoded"));
}

}  // namespace
}  // namespace limn::test
