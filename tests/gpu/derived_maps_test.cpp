// Maps derived from shadow maps against the same computed on the CPU, texel by texel.
#include "core/shadow/derived_maps.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "glsl/min_max_pyramid.glsl"
#include "tests/gpu/gl_test.h"

namespace limn::shadow {
namespace {

struct Size {
  int width, height, layers;
};
constexpr Size sizes[] = {{64, 64, 3}, {100, 100, 3}, {257, 257, 3}, {100, 33, 1}, {1, 1, 1}};

class DerivedMapsTest : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    pool_.emplace(device());
  }
  void TearDown() override {
    pool_.reset();
    source_ = {};
    GlTest::TearDown();
  }

  /// A new random source map; 0 and 1 are frequent.
  void makeSource(const Size& size, unsigned seed = 1) {
    size_ = size;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(-0.1f, 1.1f);
    depth_.resize(static_cast<size_t>(size.width) * static_cast<size_t>(size.height) *
                  static_cast<size_t>(size.layers));
    for (float& z : depth_) z = std::clamp(value(random), 0.f, 1.f);
    source_ = gpu::Texture(device(), "source",
                           {.target = GL_TEXTURE_2D_ARRAY,
                            .format = GL_R32F,
                            .width = size.width,
                            .height = size.height,
                            .layers = size.layers});
    const size_t layer = depth_.size() / static_cast<size_t>(size.layers);
    for (int i = 0; i < size.layers; ++i)
      source_.upload(0, i, GL_RED, GL_FLOAT, depth_.data() + static_cast<size_t>(i) * layer);
  }

  float depth(int x, int y, int layer) const {
    return depth_[(static_cast<size_t>(layer) * static_cast<size_t>(size_.height) + static_cast<size_t>(y)) *
                      static_cast<size_t>(size_.width) +
                  static_cast<size_t>(x)];
  }

  template <class T>
  static std::vector<T> read(const gpu::Texture& texture, int level, GLenum format, GLenum type,
                             size_t components) {
    const gpu::TextureDesc& d = texture.desc();
    std::vector<T> values(static_cast<size_t>(std::max(d.width >> level, 1)) *
                          static_cast<size_t>(std::max(d.height >> level, 1)) *
                          static_cast<size_t>(d.layers) * components);
    texture.read(level, format, type, values.data(), values.size() * sizeof(T));
    return values;
  }

  Size size_{};
  std::vector<float> depth_;
  gpu::Texture source_;
  std::optional<frame::ResourcePool> pool_;
};

TEST_F(DerivedMapsTest, MinMaxPyramidIsTheBoundsOfEveryFootprint) {
  for (const Size& size : sizes) {
    makeSource(size);
    frame::FrameGraph graph;
    DerivedMaps maps(device());
    maps.begin(graph);
    const MinMaxPyramid pyramid = maps.minMaxPyramid(graph.importTexture("source", source_), false);
    graph.output(pyramid.texture);
    graph.prepare(device(), shaders(), *pool_);
    graph.execute();
    EXPECT_EQ(pyramid.levels, gpu::fullMipLevels(size.width, size.height));
    for (int level = 0; level < pyramid.levels; ++level) {
      const int w = std::max(size.width >> level, 1), h = std::max(size.height >> level, 1);
      std::vector<glm::vec2> expected(static_cast<size_t>(w * h * size.layers), glm::vec2(2, -1));
      for (int layer = 0; layer < size.layers; ++layer) {
        for (int y = 0; y < size.height; ++y) {
          for (int x = 0; x < size.width; ++x) {
            glm::vec2& e =
                expected[static_cast<size_t>((layer * h + glsl::min_max_texel(y, level, size.height)) * w +
                                             glsl::min_max_texel(x, level, size.width))];
            e = {std::min(e.x, depth(x, y, layer)), std::max(e.y, depth(x, y, layer))};
          }
        }
      }
      EXPECT_EQ(read<glm::vec2>(graph.texture(pyramid.texture), level, GL_RG, GL_FLOAT, 1), expected)
          << size.width << " x " << size.height << " level " << level;
    }
  }
}

TEST_F(DerivedMapsTest, TwoTexelsPerAxisOfTheChosenLevelCoverTheBox) {
  const int size = 100, levels = gpu::fullMipLevels(size, size);
  for (int first = 0; first < size; ++first) {
    for (int last = first; last < size; ++last) {
      const int level = glsl::min_max_level(last - first + 1, levels);
      ASSERT_LT(level, levels);
      ASSERT_LE(glsl::min_max_texel(last, level, size) - glsl::min_max_texel(first, level, size), 1);
    }
  }
}

TEST_F(DerivedMapsTest, MomentMipsKeepTheMeansOfTheMapOnEveryLevel) {
  for (const Size& size : sizes) {
    makeSource(size);
    frame::FrameGraph graph;
    DerivedMaps maps(device());
    maps.begin(graph);
    const frame::TextureHandle mips = maps.momentMips(graph.importTexture("source", source_), false);
    graph.output(mips);
    graph.prepare(device(), shaders(), *pool_);
    graph.execute();
    const auto layer = static_cast<size_t>(size.width * size.height);
    glm::dvec2 mean(0);
    for (size_t i = 0; i < layer; ++i) mean += glm::dvec2(depth_[i], double{depth_[i]} * depth_[i]);
    mean /= static_cast<double>(layer);
    for (int level = 0; level < gpu::fullMipLevels(size.width, size.height); ++level) {
      const auto values = read<glm::vec2>(graph.texture(mips), level, GL_RG, GL_FLOAT, 1);
      const size_t count = values.size() / static_cast<size_t>(size.layers);
      glm::dvec2 sum(0);
      for (size_t i = 0; i < count; ++i) sum += glm::dvec2(values[i]);
      sum /= static_cast<double>(count);
      EXPECT_NEAR(sum.x, mean.x, 1e-6) << size.width << " level " << level;
      EXPECT_NEAR(sum.y, mean.y, 1e-6) << size.width << " level " << level;
      if (level == 1 && size.width == 64) {
        const double quad = (double{depth(2, 4, 0)} + depth(3, 4, 0) + depth(2, 5, 0) + depth(3, 5, 0)) / 4;
        EXPECT_NEAR(values[2 * 32 + 1].x, quad, 1e-7);
      }
    }
  }
}

TEST_F(DerivedMapsTest, EachIsBuiltOnceLeftOutUnusedAndKeptWhileNothingChanges) {
  makeSource({64, 64, 2});
  frame::FrameGraph graph;
  DerivedMaps maps(device());
  maps.begin(graph);
  const frame::TextureHandle source = graph.importTexture("source", source_);
  const MinMaxPyramid pyramid = maps.minMaxPyramid(source, true);
  EXPECT_EQ(pyramid.texture, maps.minMaxPyramid(source, true).texture);
  EXPECT_FALSE(maps.momentMips(source, true) == pyramid.texture);
  graph.output(pyramid.texture);
  graph.prepare(device(), shaders(), *pool_);
  const auto states = [&] {
    std::vector<std::pair<std::string, frame::PassState>> list;
    for (const frame::PassReport& row : graph.explain()) list.emplace_back(row.name, row.state);
    return list;
  };
  const auto expectStates = [&](frame::PassState used) {
    const auto list = states();
    EXPECT_EQ(list.size(), 14u);
    for (const auto& [name, state] : list)
      EXPECT_EQ(state, name.starts_with("min-max") ? used : frame::PassState::leftOut) << name;
  };
  graph.execute();
  expectStates(frame::PassState::run);
  graph.execute();
  expectStates(frame::PassState::cached);
  graph.touch(source);
  graph.execute();
  expectStates(frame::PassState::run);

  // Every level reads what the pass before stored.
  for (const frame::PassReport& row : graph.explain()) {
    if (row.state == frame::PassState::leftOut || row.name.ends_with("level 0")) continue;
    EXPECT_TRUE(row.barriers & GL_SHADER_IMAGE_ACCESS_BARRIER_BIT) << row.name;
  }
}

TEST_F(DerivedMapsTest, RefusesOtherSources) {
  frame::FrameGraph graph;
  DerivedMaps maps(device());
  maps.begin(graph);
  const frame::TextureHandle wrong =
      graph.createTexture("wrong", {.format = GL_R32F, .width = 4, .height = 4});
  EXPECT_THROW(maps.minMaxPyramid(wrong, false), Error);
}

}  // namespace
}  // namespace limn::shadow
