// Meshes compressed by Draco: what comes back, and what is refused. tests/support/draco_samples.cpp says what
// the samples hold.
#include <glm/glm.hpp>

#include "core/scene_io/private/draco_message.h"
#include "tests/support/address_limit.h"
#include "tests/support/paths.h"
#include "tests/support/png.h"
#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using json = nlohmann::json;
using scene::DracoMesh;
using scene::Primitive;
using scene::Scene;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kExtension = "KHR_draco_mesh_compression";
constexpr int kVertices = 20, kIndices = 72;

std::vector<std::byte> sample(const std::string& name) {
  return readFile(std::filesystem::path(kBinaryDir) / "tests/draco" / (name + ".drc"));
}

/// A textured primitive whose bytes are those of a sample.
GltfBuilder compressedGrid(const std::vector<std::byte>& bytes) {
  GltfBuilder b;
  const int material = b.texturedMaterial(png(2, 2, std::vector<std::uint8_t>(16, 255)));
  const auto accessor = [&](int componentType, const char* type, int count) {
    return b.append("accessors", {{"componentType", componentType}, {"count", count}, {"type", type}});
  };
  const int indices = accessor(GltfBuilder::kUshort, "SCALAR", kIndices);
  const int position = accessor(GltfBuilder::kFloat, "VEC3", kVertices);
  const int normal = accessor(GltfBuilder::kFloat, "VEC3", kVertices);
  const int uv = accessor(GltfBuilder::kFloat, "VEC2", kVertices);
  const int color = accessor(GltfBuilder::kUbyte, "VEC4", kVertices);
  b.root["accessors"].back()["normalized"] = true;
  const int mesh =
      b.mesh({{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}, {"COLOR_0", color}}, indices,
             material);
  b.root["meshes"][0]["primitives"][0]["extensions"][kExtension] = {
      {"bufferView", b.view(bytes.data(), bytes.size())},
      {"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}, {"COLOR_0", 3}}}};
  b.root["extensionsRequired"] = {kExtension};
  b.meshNode(mesh);
  return b;
}

json& extensionOf(GltfBuilder& b) {
  return b.root["meshes"][0]["primitives"][0]["extensions"][kExtension];
}

/// Each vertex is one of the grid's, and the triangles cover the grid once.
void expectGrid(const Scene& scene, float tolerance) {
  ASSERT_EQ(scene.meshes.at(0).primitives.size(), 1u);
  const Primitive& p = scene.meshes[0].primitives[0];
  ASSERT_EQ(p.positions.size(), std::size_t{kVertices});
  ASSERT_EQ(p.indices.size(), std::size_t{kIndices});
  ASSERT_EQ(p.colours.size(), p.positions.size());
  ASSERT_EQ(p.uvs.size(), p.positions.size());
  for (std::size_t i = 0; i < p.positions.size(); ++i) {
    const float x = std::round(p.positions[i].x), y = std::round(p.positions[i].y);
    expectNear(p.positions[i], {x, y, x * y / 8}, tolerance);
    expectNear(p.normals[i], static_cast<int>(x) % 2 == 0 ? glm::vec3(0.6f, 0, 0.8f) : glm::vec3(0, 0, 1),
               tolerance);
    EXPECT_NEAR(p.uvs[i].x, x / 4, tolerance);
    EXPECT_NEAR(p.uvs[i].y, y / 3, tolerance);
    expectNear(glm::vec3(p.colours[i]), glm::vec3(60 * x, 80 * y, 7) / 255.0f);
  }
  float area = 0;
  for (std::size_t i = 0; i < p.indices.size(); i += 3) {
    const glm::vec3 a = p.positions[p.indices[i]], b = p.positions[p.indices[i + 1]],
                    c = p.positions[p.indices[i + 2]];
    const float twice = glm::cross(b - a, c - a).z;
    EXPECT_NEAR(twice, 1, 4 * tolerance);  // in the order of the file: its front is up
    area += twice / 2;
  }
  EXPECT_NEAR(area, 12, 0.01f);
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
}

TEST(DracoCompression, GivesBackWhatWasCompressed) {
  expectGrid(loadBuilt(compressedGrid(sample("sequential"))), 1e-6f);
  expectGrid(loadBuilt(compressedGrid(sample("edgebreaker"))), 1e-3f);  // 14 bits
}

TEST(DracoCompression, PrimitivesOfOneSceneAreDecodedTogether) {
  GltfBuilder b = compressedGrid(sample("edgebreaker"));
  b.root["meshes"].push_back(b.root["meshes"][0]);
  b.meshNode(1);
  b.triangle();
  const Scene scene = loadBuilt(b);
  ASSERT_EQ(scene.meshes.size(), 3u);
  EXPECT_EQ(scene.triangles(), 24u + 24u + 1u);
  EXPECT_EQ(scene.meshes[0].primitives[0].positions, scene.meshes[1].primitives[0].positions);
}

/// A file may hold the plain arrays beside the compressed ones: these are read, whatever the others hold.
TEST(DracoCompression, PlainArraysComeFirst) {
  GltfBuilder b;
  b.meshNode(b.mesh({{"POSITION", b.vec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}}, b.indices({0, 1, 2})));
  const std::vector<std::byte> damaged(10);
  extensionOf(b) = {{"bufferView", b.view(damaged.data(), damaged.size())},
                    {"attributes", {{"POSITION", 0}}}};
  EXPECT_EQ(loadBuilt(b).triangles(), 1u);
}

TEST(DracoCompression, RefusesWhatDoesNotFit) {
  const auto refusal = [](const auto& change) {
    GltfBuilder b = compressedGrid(sample("edgebreaker"));
    change(b);
    return loadError(b.glb());
  };
  const std::string place = "mesh 0 primitive 0 KHR_draco_mesh_compression: ";
  EXPECT_THAT(refusal([](GltfBuilder& b) { b.root["accessors"][0]["count"] = 75; }),
              HasSubstr(place + "it has 72 indices; the accessor has 75"));
  EXPECT_THAT(refusal([](GltfBuilder& b) {
                for (std::size_t i = 1; i < 5; ++i) b.root["accessors"][i]["count"] = 21;
              }),
              HasSubstr(place + "it has 20 vertices; the accessors have 21"));
  EXPECT_THAT(refusal([](GltfBuilder& b) { b.root["accessors"][2]["count"] = 21; }),
              HasSubstr("has 21 elements, others have 20"));
  EXPECT_THAT(refusal([](GltfBuilder& b) { b.root["accessors"][3]["type"] = "VEC3"; }),
              HasSubstr(place + "its attribute 2 has 2 components; the accessor has 3"));
  EXPECT_THAT(refusal([](GltfBuilder& b) { b.root["accessors"][3]["type"] = "MAT4"; }),
              HasSubstr("TEXCOORD_0 is of matrices"));
  EXPECT_THAT(refusal([](GltfBuilder& b) { extensionOf(b)["attributes"]["NORMAL"] = 9; }),
              HasSubstr(place + "it has no attribute 9"));
  EXPECT_THAT(refusal([](GltfBuilder& b) { extensionOf(b)["attributes"]["TANGENT"] = 1; }),
              HasSubstr(place + "the primitive has no TANGENT"));
  EXPECT_THAT(refusal([](GltfBuilder& b) { extensionOf(b)["bufferView"] = 9; }),
              HasSubstr(place.substr(0, place.size() - 2) + ": buffer view 9 does not exist"));
  EXPECT_THAT(refusal([](GltfBuilder& b) { extensionOf(b)["bufferView"] = -1; }),
              HasSubstr("KHR_draco_mesh_compression.bufferView is -1"));
  EXPECT_THAT(refusal([](GltfBuilder& b) { b.root["meshes"][0]["primitives"][0]["mode"] = 5; }),
              HasSubstr(place + "mode 5; 4, triangles, is accepted"));
  EXPECT_THAT(refusal([](GltfBuilder& b) { b.root["meshes"][0]["primitives"][0].erase("indices"); }),
              HasSubstr(place + "the primitive has no indices"));
  EXPECT_THAT(refusal([](GltfBuilder& b) { b.root["meshes"][0]["primitives"][0]["indices"] = 77; }),
              HasSubstr(place + "accessor 77 does not exist"));
  EXPECT_THAT(refusal([](GltfBuilder& b) { b.root["accessors"][0]["count"] = 1'000'000'000'000; }),
              HasSubstr("exceed the limit"));
  EXPECT_THAT(loadError(compressedGrid(sample("cloud")).glb()), HasSubstr(place + "not a mesh that Draco"));
  EXPECT_THAT(loadError(compressedGrid(std::vector<std::byte>(3)).glb()), HasSubstr(place + "not a mesh"));
}

/// Primitives that say of themselves that they are empty may all name the same large view.
TEST(DracoCompression, WhatIsHandedToTheDecoderIsLimited) {
  GltfBuilder b = compressedGrid(std::vector<std::byte>(16 * 100));
  for (std::size_t i = 0; i < 5; ++i) b.root["accessors"][i]["count"] = 0;
  json& meshes = b.root["meshes"];
  for (int copy = 1; copy < 4; ++copy) meshes.push_back(json(meshes[0]));
  scene::LoadLimits limits;
  limits.vertices = 399;
  EXPECT_THAT(loadError(b.glb(), limits),
              AllOf(HasSubstr("mesh 3 primitive 0"), HasSubstr("exceed the limit of 399")));
}

#if !defined(LIMN_SANITIZED)
/// Many primitives may name one accessor of which the file says more than is read.
TEST(DracoCompression, WhatElseAccessorsSayIsNotHeldForEachPrimitive) {
  GltfBuilder b = compressedGrid(sample("edgebreaker"));
  b.root["accessors"][1]["extras"] = std::string(std::size_t{4} << 20, 'a');
  json& primitives = b.root["meshes"][0]["primitives"];
  for (int copy = 1; copy < 512; ++copy) primitives.push_back(json(primitives[0]));
  const std::vector<std::byte> bytes = b.glb();
  const AddressLimit limit(rlim_t{1} << 30);
  EXPECT_EQ(scene::loadMemory(bytes).triangles(), 512u * 24u);
}
#endif

TEST(DracoCompression, DamagedMeshesNeverCrash) {
  const std::vector<std::byte> whole = sample("edgebreaker");
  for (std::size_t i = 0; i < whole.size(); i += 1 + whole.size() / 24) {
    loadError(compressedGrid({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(i)}).glb());
    std::vector<std::byte> damaged = whole;
    damaged[i] ^= std::byte{0xff};
    loadError(compressedGrid(damaged).glb());
  }
}

/// The program that decodes may have been taken over by what it read.
TEST(DracoCompression, AnswersAreNotTrusted) {
  const std::vector<std::byte> bytes(7);
  const std::vector<DracoMesh> meshes{{bytes, 3, 3, {{0, GltfBuilder::kFloat, 3}}}};
  const auto asked = scene::decodeDracoRequest(scene::encodeDracoRequest(meshes));
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_EQ(asked[0].answerBytes(), 3u * 4 + 3 * 12);
  EXPECT_EQ(asked[0].bytes.size(), bytes.size());
  const std::vector<std::byte> arrays(meshes[0].answerBytes());
  std::vector<std::byte> message = scene::encodeDracoAnswer(arrays);
  EXPECT_EQ(scene::decodeDracoAnswer(message, meshes).arrays.size(), arrays.size());
  for (std::size_t size = 0; size < message.size(); ++size)
    EXPECT_THROW(scene::decodeDracoAnswer(std::span(message).first(size), meshes), Error) << size;
  message[0] = {};
  EXPECT_THROW(scene::decodeDracoAnswer(message, meshes), Error);
  EXPECT_THROW(scene::decodeDracoAnswer(scene::encodeDracoAnswer(bytes), meshes), Error);
  EXPECT_EQ(scene::decodeDracoAnswer(scene::encodeDracoRefusal(0, "a\nb"), meshes).reason, "a?b");
  EXPECT_THROW(scene::decodeDracoAnswer(scene::encodeDracoRefusal(0, ""), meshes), Error);
  EXPECT_THROW(scene::decodeDracoAnswer(scene::encodeDracoRefusal(1, "no such mesh"), meshes), Error);
}

}  // namespace
}  // namespace limn::test
