// Looking at textures: any kind, layer, level and format, as the pass that was asked about saw it.
#include "core/render/inspector.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>

#include "tests/gpu/gl_test.h"

namespace limn::render {
namespace {

using frame::Access;
using frame::PassContext;
using frame::TextureHandle;

/// What a layer of a level is filled with.
float valueOf(int level, int layer) {
  return static_cast<float>(10 * level + layer + 1);
}

class InspectorTest : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    pool_.emplace(device());
    graph_.emplace();
  }
  void TearDown() override {
    inspector_.reset();
    graph_.reset();
    pool_.reset();
    GlTest::TearDown();
  }

  /// A pass that clears a region of a texture, or all of it, with `data`.
  template <class F>
  TextureHandle fill(const char* name, const gpu::TextureDesc& desc, F clear) {
    frame::PassBuilder pass = graph_->addPass(name);
    const TextureHandle texture =
        pass.write(graph_->createTexture(name, desc), Access::copyTarget, "test values");
    pass.execute([=](PassContext& context) { clear(context.gl(), context.texture(texture).id()); });
    return texture;
  }

  void look(TextureHandle texture) {
    inspector_.emplace(*graph_, texture, view_);
    graph_->prepare(device(), shaders(), *pool_);
    graph_->execute();
  }

  std::array<uint8_t, 4> displayed() const {
    const gpu::Texture& texture = inspector_->display();
    std::vector<uint8_t> texels(4 * static_cast<size_t>(texture.desc().width) *
                                static_cast<size_t>(texture.desc().height));
    texture.read(0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data(), texels.size());
    return {texels[0], texels[1], texels[2], texels[3]};
  }

  std::optional<frame::ResourcePool> pool_;
  std::optional<frame::FrameGraph> graph_;
  InspectionView view_;
  std::optional<TextureInspector> inspector_;
};

TEST_F(InspectorTest, everyKindOfTextureLayerAndLevel) {
  const gpu::TextureDesc kinds[] = {
      {.target = GL_TEXTURE_2D, .format = GL_R32F, .width = 12, .height = 8, .levels = 3},
      {.target = GL_TEXTURE_2D_ARRAY, .format = GL_R32F, .width = 12, .height = 8, .layers = 3, .levels = 2},
      {.target = GL_TEXTURE_CUBE_MAP, .format = GL_R32F, .width = 8, .height = 8, .layers = 6, .levels = 2},
      {.target = GL_TEXTURE_CUBE_MAP_ARRAY, .format = GL_R32F, .width = 8, .height = 8, .layers = 12},
      {.target = GL_TEXTURE_3D, .format = GL_R32F, .width = 8, .height = 8, .layers = 4, .levels = 2}};
  for (const gpu::TextureDesc& desc : kinds) {
    graph_.emplace();
    const TextureHandle texture = fill("layers", desc, [&desc](const gl::Functions& gl, GLuint id) {
      for (int level = 0; level < desc.levels; ++level) {
        const bool volume = desc.target == GL_TEXTURE_3D;
        for (int layer = 0; layer < (volume ? desc.layers >> level : desc.layers); ++layer) {
          const float value = valueOf(level, layer);
          gl.ClearTexSubImage(id, level, 0, 0, layer, std::max(1, desc.width >> level),
                              std::max(1, desc.height >> level), 1, GL_RED, GL_FLOAT, &value);
        }
      }
    });
    look(texture);
    for (int level = 0; level < desc.levels; ++level) {
      for (int layer = 0; layer < inspector_->layersOf(level); ++layer) {
        view_ = {.level = level, .layer = layer, .channel = 0, .low = 0, .high = 2 * valueOf(level, layer)};
        graph_->execute();
        const InspectedValues values = inspector_->read();
        EXPECT_EQ(values.size, glm::ivec2(desc.width >> level, desc.height >> level));
        const InspectedValues::Range range = values.range(0);
        EXPECT_EQ(range.low, valueOf(level, layer)) << desc.target << " " << level << " " << layer;
        EXPECT_EQ(range.high, range.low);
        EXPECT_NEAR(displayed()[0], 128, 1);
      }
    }
    inspector_.reset();
  }
}

TEST_F(InspectorTest, integerAndDepthFormats) {
  const auto look32 = [&](GLenum format, GLenum client, GLenum type, const void* texel) {
    inspector_.reset();
    graph_.emplace();
    look(fill("values", {.format = format, .width = 4, .height = 4},
              [=](const gl::Functions& gl, GLuint id) { gl.ClearTexImage(id, 0, client, type, texel); }));
    return inspector_->read();
  };
  const uint32_t large[4] = {4000000000u, 7, 0, 9};
  EXPECT_EQ(look32(GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, large).at(3, 3, 0), 4000000000.0);
  const int32_t below[4] = {-5, 6, -7, 8};
  const InspectedValues four = look32(GL_RGBA16I, GL_RGBA_INTEGER, GL_INT, below);
  for (int c = 0; c < 4; ++c) EXPECT_EQ(four.at(1, 2, c), below[c]);
  const InspectedValues two = look32(GL_RG16I, GL_RG_INTEGER, GL_INT, below);
  EXPECT_EQ(two.integers.size(), 2u * 4 * 4) << "no more than the texture has";
  EXPECT_EQ(two.at(3, 3, 1), 6);
  EXPECT_EQ(two.at(3, 3, 2), 0) << "it has none";
  const float half = 0.5f;
  for (const GLenum depth : {GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT32F}) {
    const InspectedValues values = look32(depth, GL_DEPTH_COMPONENT, GL_FLOAT, &half);
    EXPECT_EQ(values.components, 1);
    EXPECT_NEAR(values.at(0, 0, 0), 0.5, 1e-4);
    EXPECT_NEAR(displayed()[2], 128, 1) << "one channel is grey";
  }
}

TEST_F(InspectorTest, channelsColoursAndWhatIsNotFinite) {
  const float texel[4] = {0, 0.5f, 1, 2};
  look(fill("colours", {.format = GL_RGBA32F, .width = 4, .height = 4},
            [&](const gl::Functions& gl, GLuint id) { gl.ClearTexImage(id, 0, GL_RGBA, GL_FLOAT, texel); }));
  view_.channel = 4;
  graph_->execute();
  EXPECT_EQ(displayed()[0], 0);
  EXPECT_NEAR(displayed()[1], 128, 1);
  EXPECT_EQ(displayed()[2], 255);
  view_ = {.channel = 3, .low = 1, .high = 3};
  graph_->execute();
  EXPECT_NEAR(displayed()[0], 128, 1) << "alpha, between 1 and 3";

  inspector_.reset();
  graph_.emplace();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  view_ = {};
  look(fill("nan", {.format = GL_R32F, .width = 2, .height = 2},
            [&](const gl::Functions& gl, GLuint id) { gl.ClearTexImage(id, 0, GL_RED, GL_FLOAT, &nan); }));
  EXPECT_EQ(inspector_->read().range(0).notFinite, 4u);
  EXPECT_EQ(displayed(), (std::array<uint8_t, 4>{255, 0, 255, 255}));
}

/// Memory that several textures share shows what the pass that was asked about left there.
TEST_F(InspectorTest, contentsAreThoseOfThePass) {
  const gpu::TextureDesc desc{.format = GL_R32F, .width = 8, .height = 8};
  const auto pass = [&](const char* name, TextureHandle input, TextureHandle target, Access access,
                        float value) {
    frame::PassBuilder builder = graph_->addPass(name);
    if (input) builder.read(input, Access::copySource, "");
    const TextureHandle written = builder.write(target, access, "");
    builder.execute([=](PassContext& context) {
      context.gl().ClearTexImage(context.texture(written).id(), 0, GL_RED, GL_FLOAT, &value);
    });
    return written;
  };
  const TextureHandle a = pass("a", {}, graph_->createTexture("a", desc), Access::copyTarget, 1);
  const TextureHandle over = pass("over", {}, a, Access::imageLoadStore, 2);
  const TextureHandle b = pass("b", over, graph_->createTexture("b", desc), Access::copyTarget, 3);
  const TextureHandle c = pass("c", b, graph_->createTexture("c", desc), Access::copyTarget, 4);
  graph_->output(pass("d", c, graph_->createTexture("d", desc), Access::copyTarget, 5));
  EXPECT_FALSE(graph_->find("core", "a", 1));
  EXPECT_FALSE(graph_->find("core", "none", 0));
  ASSERT_EQ(graph_->find("core", "a", 0), a);
  ASSERT_EQ(graph_->find("core", "b", 0), over);
  look(graph_->find("core", "a", 0));
  EXPECT_EQ(inspector_->read().at(0, 0, 0), 1) << "before it was overwritten";
  graph_->execute();
  EXPECT_EQ(inspector_->read().at(7, 7, 0), 1) << "in the second frame, too";
  EXPECT_LT(graph_->transientBytes(), graph_->transientBytesUnaliased());
}

}  // namespace
}  // namespace limn::render
