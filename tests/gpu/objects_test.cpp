#include "core/gpu/objects.h"

#include <gmock/gmock.h>

#include <array>
#include <functional>
#include <numeric>

#include "core/base/error.h"
#include "core/gpu/format.h"
#include "tests/gpu/gl_test.h"

namespace limn::gpu {
namespace {

using ::testing::HasSubstr;

class ObjectsTest : public GlTest {};

TEST_F(ObjectsTest, buffersRoundTrip) {
  std::vector<uint32_t> values(100);
  std::iota(values.begin(), values.end(), 5u);
  auto buffer = Buffer::of<uint32_t>(device(), "values", values, BufferUse::updated);
  EXPECT_EQ(buffer.size(), 400u);
  const uint32_t changed = 77;
  buffer.update(40, &changed, sizeof changed);
  values[10] = changed;
  std::vector<uint32_t> readBack(values.size());
  buffer.read(0, readBack.data(), buffer.size());
  EXPECT_EQ(readBack, values);
  buffer.clear(9);
  buffer.read(0, readBack.data(), buffer.size());
  EXPECT_EQ(readBack, std::vector<uint32_t>(values.size(), 9));
}

TEST_F(ObjectsTest, emptyBuffersCanBeBound) {
  const Buffer buffer(device(), "empty", 0);
  EXPECT_EQ(buffer.size(), 0u);
  gl().BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer.id());
  buffer.read(0, nullptr, 0);
  gl().BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, 0);
}

TEST_F(ObjectsTest, buffersRefuseWhatIsOutside) {
  Buffer buffer(device(), "small", 16, BufferUse::updated);
  std::array<char, 32> data{};
  EXPECT_EQ(errorOf([&] { buffer.update(8, data.data(), 16); }),
            "buffer update of 16 bytes at 8 is outside its 16 bytes");
  EXPECT_THAT(errorOf([&] { buffer.read(~size_t{0}, data.data(), 2); }), HasSubstr("outside its 16 bytes"));
  Buffer fixed(device(), "fixed", 16);
  EXPECT_THAT(errorOf([&] { fixed.update(0, data.data(), 16); }), HasSubstr("BufferUse::updated"));
}

TEST_F(ObjectsTest, hugeBuffersAreRefused) {
  EXPECT_THAT(errorOf([] { Buffer(device(), "huge", ~size_t{0}); }), HasSubstr("larger than memory can be"));
}

TEST_F(ObjectsTest, countersFollowEveryObject) {
  const Counters before = device().counters();
  {
    Buffer buffer(device(), "b", 100);
    Texture texture(device(), "t", {.format = GL_RGBA16F, .width = 8, .height = 4, .levels = 0});
    const Attachment colour[] = {{&texture}};
    Framebuffer framebuffer(device(), "f", colour);
    Sampler sampler(device(), GL_LINEAR, GL_LINEAR);
    VertexArray vertexArray(device(), {});
    Query query(device(), GL_TIME_ELAPSED);
    const Counters& now = device().counters();
    EXPECT_EQ(now.buffers, before.buffers + 1);
    EXPECT_EQ(now.bufferBytes, before.bufferBytes + 100);
    EXPECT_EQ(now.textures, before.textures + 1);
    EXPECT_EQ(now.textureBytes, before.textureBytes + 8 * (32 + 8 + 2 + 1));
    EXPECT_EQ(now.framebuffers, before.framebuffers + 1);
    EXPECT_EQ(now.samplers, before.samplers + 1);
    EXPECT_EQ(now.vertexArrays, before.vertexArrays + 1);
    EXPECT_EQ(now.queries, before.queries + 1);
  }
  EXPECT_EQ(device().counters(), before);
}

TEST_F(ObjectsTest, movingTransfersOwnership) {
  const Counters before = device().counters();
  {
    Texture a(device(), "a", {.width = 4, .height = 4});
    const GLuint id = a.id();
    Texture b(std::move(a));
    EXPECT_EQ(b.id(), id);
    EXPECT_FALSE(a);  // NOLINT: the moved-from state is the subject
    Texture c(device(), "c", {.width = 16, .height = 16});
    c = std::move(b);
    EXPECT_EQ(c.id(), id);
    EXPECT_EQ(c.desc().width, 4);
    EXPECT_EQ(device().counters().textures, before.textures + 1)
        << "what was assigned over is destroyed at once";
    std::vector<Buffer> buffers;
    buffers.reserve(10);
    for (int i = 0; i < 10; ++i) buffers.emplace_back(device(), "b", size_t(i) + 1);
    EXPECT_EQ(device().counters().buffers, before.buffers + 10);
    buffers.erase(buffers.begin() + 2);
    EXPECT_EQ(device().counters().bufferBytes, before.bufferBytes + 55 - 3);
  }
  EXPECT_EQ(device().counters(), before);
}

TEST_F(ObjectsTest, everyTargetUploadsAndReads) {
  const TextureDesc descriptions[] = {
      {GL_TEXTURE_2D, GL_R32F, 5, 3, 1, 0},       {GL_TEXTURE_2D_ARRAY, GL_R32F, 5, 3, 4, 2},
      {GL_TEXTURE_CUBE_MAP, GL_R32F, 4, 4, 6, 0}, {GL_TEXTURE_CUBE_MAP_ARRAY, GL_R32F, 4, 4, 12, 0},
      {GL_TEXTURE_3D, GL_R32F, 5, 3, 4, 0},
  };
  for (const TextureDesc& desc : descriptions) {
    SCOPED_TRACE(desc.target);
    Texture texture(device(), "texture", desc);
    for (int level = 0; level < texture.desc().levels; ++level) {
      const int texels = std::max(1, desc.width >> level) * std::max(1, desc.height >> level);
      std::vector<float> values(size_t(texels) * size_t(texture.layersOf(level)));
      std::iota(values.begin(), values.end(), static_cast<float>(100 * level));
      for (int layer = 0; layer < texture.layersOf(level); ++layer) {
        texture.upload(level, layer, GL_RED, GL_FLOAT, values.data() + layer * texels);
      }
      std::vector<float> readBack(values.size());
      texture.read(level, GL_RED, GL_FLOAT, readBack.data(), readBack.size() * sizeof(float));
      EXPECT_EQ(readBack, values) << "level " << level;
    }
  }
}

TEST_F(ObjectsTest, everyFormatCanBeMadeAndRead) {
  for (GLenum format = 0; format < 0x10000; ++format) {
    const auto info = findFormat(format);
    if (!info) continue;
    SCOPED_TRACE(info->name);
    const Texture texture(device(), info->name, {.format = format, .width = 3, .height = 3});
    // DEPTH_COMPONENT24 occupies four bytes and so does its client type; every other one is tightly packed as
    // well.
    EXPECT_EQ(clientPixelBytes(info->clientFormat, info->clientType), size_t(info->bytes));
    std::vector<char> texels(9 * size_t(info->bytes));
    texture.read(0, info->clientFormat, info->clientType, texels.data(), texels.size());
  }
}

TEST_F(ObjectsTest, clearsReachEveryLevelAndLayer) {
  Texture colour(
      device(), "colour",
      {.target = GL_TEXTURE_2D_ARRAY, .format = GL_RG32F, .width = 4, .height = 4, .layers = 3, .levels = 0});
  colour.clear({1, 2, 3, 4});
  std::vector<float> texels(2 * 2 * 3 * 2);
  colour.read(1, GL_RG, GL_FLOAT, texels.data(), texels.size() * sizeof(float));
  for (size_t i = 0; i < texels.size(); ++i) EXPECT_EQ(texels[i], i % 2 == 0 ? 1 : 2);

  Texture depth(device(), "depth", {.format = GL_DEPTH_COMPONENT32F, .width = 2, .height = 2});
  depth.clear({0.25f, 0, 0, 0});
  std::array<float, 4> depths{};
  depth.read(0, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data(), sizeof depths);
  for (const float value : depths) EXPECT_EQ(value, 0.25f);

  Texture integers(device(), "integers", {.format = GL_RG32UI, .width = 2, .height = 2});
  integers.clearUint({4000000000u, 7, 0, 0});
  std::array<uint32_t, 8> words{};
  integers.read(0, GL_RG_INTEGER, GL_UNSIGNED_INT, words.data(), sizeof words);
  for (size_t i = 0; i < words.size(); ++i) EXPECT_EQ(words[i], i % 2 == 0 ? 4000000000u : 7u);

  EXPECT_THAT(errorOf([&] { integers.clear({1, 1, 1, 1}); }), HasSubstr("RG32UI"));
  EXPECT_THAT(errorOf([&] { colour.clearUint({1, 1, 1, 1}); }), HasSubstr("RG32F"));
}

TEST_F(ObjectsTest, impossibleTexturesAreRefusedByName) {
  const int beyond = device().limits().maxTextureSize + 1;
  const auto refused = [](const TextureDesc& desc) {
    return errorOf([&] { Texture(device(), "shadow", desc); });
  };
  EXPECT_THAT(refused({.width = beyond}), HasSubstr("2D texture 'shadow'"));
  EXPECT_THAT(refused({.width = 0}), HasSubstr("width and height may be 1 to"));
  EXPECT_THAT(refused({.height = -5}), HasSubstr("width and height may be 1 to"));
  EXPECT_THAT(refused({.layers = 2}), HasSubstr("layers may be 1 to 1"));
  EXPECT_THAT(refused({.width = 8, .height = 8, .levels = 5}), HasSubstr("levels may be 0 (all) to 4"));
  EXPECT_THAT(refused({.format = GL_RGBA}), HasSubstr("format 0x1908"));
  EXPECT_THAT(refused({.target = GL_TEXTURE_1D}), HasSubstr("target"));
  EXPECT_THAT(refused({.target = GL_TEXTURE_CUBE_MAP, .width = 8, .height = 4, .layers = 6}),
              HasSubstr("square"));
  EXPECT_THAT(refused({.target = GL_TEXTURE_CUBE_MAP_ARRAY, .width = 8, .height = 8, .layers = 7}),
              HasSubstr("sixes"));
}

TEST_F(ObjectsTest, readsOfTheWrongSizeAreRefused) {
  const Texture texture(device(), "t", {.format = GL_RGBA32F, .width = 4, .height = 4});
  std::vector<float> texels(64);
  EXPECT_EQ(errorOf([&] { texture.read(0, GL_RGBA, GL_FLOAT, texels.data(), 255); }),
            "texture read of level 0 into 255 bytes: it has 256 bytes");
  EXPECT_THAT(errorOf([&] { texture.read(1, GL_RGBA, GL_FLOAT, texels.data(), 64); }), HasSubstr("1 levels"));
}

TEST_F(ObjectsTest, mipChainsEndAtOneTexel) {
  EXPECT_EQ(fullMipLevels(1, 1), 1);
  EXPECT_EQ(fullMipLevels(256, 1), 9);
  EXPECT_EQ(fullMipLevels(255, 3), 8);
  EXPECT_EQ(fullMipLevels(4, 4, 64), 7);
  EXPECT_EQ(
      textureBytes(
          {.target = GL_TEXTURE_3D, .format = GL_R8, .width = 4, .height = 4, .layers = 4, .levels = 0}),
      64 + 8 + 1);
  EXPECT_EQ(textureBytes({.target = GL_TEXTURE_2D_ARRAY,
                          .format = GL_R8,
                          .width = 4,
                          .height = 4,
                          .layers = 4,
                          .levels = 0}),
            64 + 16 + 4);
}

TEST_F(ObjectsTest, framebuffersTakeLayers) {
  const Texture maps(
      device(), "maps",
      {.target = GL_TEXTURE_2D_ARRAY, .format = GL_R32F, .width = 4, .height = 4, .layers = 3});
  const Texture depth(
      device(), "depth",
      {.target = GL_TEXTURE_2D_ARRAY, .format = GL_DEPTH_COMPONENT32F, .width = 4, .height = 4, .layers = 3});
  const Attachment all[] = {{&maps}};
  const Framebuffer layered(device(), "layered", all, {&depth});
  const Attachment one[] = {{&maps, 0, 1}};
  const Framebuffer single(device(), "single", one);
  const Framebuffer depthOnly(device(), "depth only", {}, {&depth});

  const float zero[] = {0, 0, 0, 0}, five[] = {5, 0, 0, 0};
  gl().ClearNamedFramebufferfv(layered.id(), GL_COLOR, 0, zero);
  gl().ClearNamedFramebufferfv(single.id(), GL_COLOR, 0, five);
  std::array<float, 48> texels{};
  maps.read(0, GL_RED, GL_FLOAT, texels.data(), sizeof texels);
  for (size_t i = 0; i < texels.size(); ++i) EXPECT_EQ(texels[i], i / 16 == 1 ? 5 : 0);
}

TEST_F(ObjectsTest, brokenFramebuffersAreRefused) {
  const Texture colour(device(), "c", {.format = GL_RGB9_E5, .width = 4, .height = 4});  // not renderable
  const Attachment unrenderable[] = {{&colour}};
  EXPECT_THAT(errorOf([&] { Framebuffer(device(), "odd", unrenderable); }),
              HasSubstr("framebuffer 'odd' is incomplete"));
  const Attachment outside[] = {{&colour, 3}};
  EXPECT_THAT(errorOf([&] { Framebuffer(device(), "odd", outside); }), HasSubstr("level 3"));
  EXPECT_THAT(errorOf([&] { Framebuffer(device(), "none", {}); }), HasSubstr("MISSING_ATTACHMENT"));
}

TEST_F(ObjectsTest, timersAndVertexArraysWork) {
  Query query(device(), GL_TIME_ELAPSED);
  query.begin();
  query.end();
  EXPECT_LT(query.result(), 10'000'000'000u);
  const VertexAttribute attributes[] = {{0, 3, GL_FLOAT}, {1, 1, GL_UNSIGNED_INT, false, true, 12, 0}};
  const VertexArray array(device(), attributes);
  EXPECT_TRUE(array);
}

}  // namespace
}  // namespace limn::gpu
