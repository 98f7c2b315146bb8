// Maps derived from shadow maps against the same computed on the CPU, texel by texel.
#include "core/shadow/derived_maps.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "glsl/shadow/min_max_pyramid.glsl"
#include "glsl/shadow/summed_area_table.glsl"
#include "tests/gpu/derived_maps_harness.h"

namespace limn::shadow {
namespace {

TEST_F(DerivedMapsTest, MinMaxPyramidIsTheBoundsOfEveryFootprint) {
  for (const Size& size : kSizes) {
    makeSource(size);
    frame::FrameGraph graph;
    DerivedMaps maps(device());
    const MinMaxPyramid pyramid = maps.minMaxPyramid(graph, graph.importTexture("source", source_), false);
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

/// Of a map of 257 texels, in one pass: what boxes of eight texels are looked up in. Larger pyramids serve
/// them as well.
TEST_F(DerivedMapsTest, PyramidsForNarrowBoxesHaveNoMoreLevelsThanTheseNeed) {
  makeSource({257, 257, 2});
  // Levels of a pyramid for boxes of eight texels, and of a whole one.
  std::vector<std::vector<glm::vec2>> made[2];
  for (const int side : {8, 0}) {
    frame::FrameGraph graph;
    const frame::TextureHandle source = graph.importTexture("source", source_);
    DerivedMaps maps(device());
    const MinMaxPyramid pyramid = maps.minMaxPyramid(graph, source, false, side);
    EXPECT_EQ(pyramid.levels, side > 0 ? 4 : gpu::fullMipLevels(257, 257));
    EXPECT_EQ(maps.minMaxPyramid(graph, source, false, 5).texture, pyramid.texture);
    EXPECT_EQ(maps.minMaxPyramid(graph, source, false, side > 0 ? 8 : 1000).texture, pyramid.texture);
    graph.output(pyramid.texture);
    graph.prepare(device(), shaders(), *pool_);
    graph.execute();
    EXPECT_EQ(graph.explain().size(), side > 0 ? 1u : 3u);
    EXPECT_EQ(graph.texture(pyramid.texture).desc().levels, pyramid.levels);
    for (int level = 0; level < 4; ++level)
      made[side > 0 ? 0 : 1].push_back(
          read<glm::vec2>(graph.texture(pyramid.texture), level, GL_RG, GL_FLOAT, 1));
  }
  EXPECT_TRUE(made[0] == made[1]);
}

/// The words that a table must hold, from sums in 64 bits.
std::vector<uint32_t> expectedTable(const Size& size, const std::vector<float>& depths, uint32_t format) {
  const uint64_t scale = glsl::sat_scale(format);
  const bool two = glsl::sat_two_words(format), squares = glsl::sat_has_squares(format);
  const auto w = static_cast<size_t>(size.width), h = static_cast<size_t>(size.height);
  std::vector<uint32_t> words;
  for (size_t layer = 0; layer < static_cast<size_t>(size.layers); ++layer) {
    std::vector<uint64_t> above(w, 0), aboveSquares(w, 0);
    for (size_t y = 0; y < h; ++y) {
      uint64_t row = 0, rowSquares = 0;
      for (size_t x = 0; x < w; ++x) {
        const uint64_t z = glsl::sat_quantise(depths[(layer * h + y) * w + x], format);
        row += z;
        rowSquares += two ? z * z : (z * z + scale / 2) / scale;
        const uint64_t a = above[x] += row, b = aboveSquares[x] += rowSquares;
        words.push_back(static_cast<uint32_t>(a));
        if (squares) words.push_back(static_cast<uint32_t>(b));
        if (squares && two) words.push_back(static_cast<uint32_t>(b >> 32));
        if (two) words.push_back(static_cast<uint32_t>(a >> 32));
      }
    }
  }
  return words;
}

TEST_F(DerivedMapsTest, SummedAreaTablesAreExactToTheBitByBothMethods) {
  constexpr SatMethod rows = SatMethod::rowParallel, shared = SatMethod::sharedMemory;
  constexpr SatDesc descs[] = {{.moments = SatMoments::z, .method = rows},
                               {.moments = SatMoments::z, .method = shared},
                               {.words = 2, .moments = SatMoments::z, .method = rows},
                               {.words = 1, .method = rows},
                               {.words = 1, .method = shared},
                               {.method = rows},
                               {.method = shared},
                               {.bits = 24, .method = rows},
                               {.bits = 8, .words = 1, .method = rows}};
  for (const Size& size : kSizes) {
    makeSource(size);
    for (const SatDesc& desc : descs) {
      frame::FrameGraph graph;
      DerivedMaps maps(device());
      const SummedAreaTable table =
          maps.summedAreaTable(graph, graph.importTexture("source", source_), false, desc);
      graph.output(table.texture);
      graph.prepare(device(), shaders(), *pool_);
      graph.execute();
      const gpu::Texture& texture = graph.texture(table.texture);
      const GLenum format = texture.desc().format;
      const size_t words = format == GL_R32UI ? 1 : format == GL_RG32UI ? 2 : 4;
      const GLenum client = words == 1 ? GL_RED_INTEGER : words == 2 ? GL_RG_INTEGER : GL_RGBA_INTEGER;
      EXPECT_TRUE(read<uint32_t>(texture, 0, client, GL_UNSIGNED_INT, words) ==
                  expectedTable(size, depth_, table.format))
          << size.width << " x " << size.height << ", " << desc.bits << " bits, " << words
          << " words, method " << static_cast<int>(desc.method);
    }
  }
}

TEST_F(DerivedMapsTest, MomentsLookedUpAgreeWithDouble) {
  const gpu::EmbeddedSource sources[] = {{"lookup.comp.glsl", kLookupShader}};
  shaders().mount("test/", sources);
  const Size size{100, 77, 3};
  makeSource(size);
  frame::FrameGraph graph;
  DerivedMaps maps(device());
  const SummedAreaTable table =
      maps.summedAreaTable(graph, graph.importTexture("source", source_), false, {});
  graph.output(table.texture);
  graph.prepare(device(), shaders(), *pool_);
  graph.execute();
  gpu::Program& program = shaders().program({.files = {"test/lookup.comp.glsl"}, .defines = {}});
  program.set("table_format", table.format);
  const std::vector<Kernel> kernels = randomKernels(size, false);
  const auto results = lookup(device(), program, graph.texture(table.texture), kernels);
  for (size_t i = 0; i < kernels.size(); ++i) {
    const auto& [box, receiver] = kernels[i];
    const auto overlap = [](float a, float b, int texel) {
      return std::max(0.0, std::min<double>(b, texel + 1) - std::max<double>(a, texel));
    };
    glm::dvec2 moments(0);
    double weights = 0;
    uint64_t sum = 0, texels = 0;
    for (int y = static_cast<int>(std::floor(box.y)); y <= static_cast<int>(std::floor(box.w)); ++y) {
      for (int x = static_cast<int>(std::floor(box.x)); x <= static_cast<int>(std::floor(box.z)); ++x) {
        const bool inside = x >= 0 && y >= 0 && x < size.width && y < size.height;
        const uint32_t z =
            inside ? glsl::sat_quantise(depth(x, y, static_cast<int>(receiver.x)), table.format) : 65535u;
        const double w = overlap(box.x, box.z, x) * overlap(box.y, box.w, y), m = receiver.y - z / 65535.0;
        moments += w * glm::dvec2(m, m * m);
        weights += w;
        if (static_cast<float>(x) >= std::floor(box.z) || static_cast<float>(y) >= std::floor(box.w))
          continue;
        sum += z;
        ++texels;
      }
    }
    moments /= weights;
    const double root = std::sqrt(moments.y);
    ASSERT_NEAR(results[i].x, moments.x, 2e-5 * root + 1.2e-7) << i;
    ASSERT_NEAR(results[i].y, moments.y, 4e-5 * moments.y + 2.4e-7 * root) << i;
    ASSERT_NEAR(results[i].z, static_cast<double>(sum), 1.2e-7 * static_cast<double>(sum)) << i;
    ASSERT_EQ(results[i].w, static_cast<float>(texels)) << i;
  }
}

TEST_F(DerivedMapsTest, MinMaxLookupsAreConservativeAndTightForSingleTexels) {
  const gpu::EmbeddedSource sources[] = {{"lookup.comp.glsl", kLookupShader}};
  shaders().mount("test/", sources);
  const Size size{100, 77, 3};
  makeSource(size);
  frame::FrameGraph graph;
  DerivedMaps maps(device());
  const MinMaxPyramid pyramid = maps.minMaxPyramid(graph, graph.importTexture("source", source_), false);
  graph.output(pyramid.texture);
  graph.prepare(device(), shaders(), *pool_);
  graph.execute();
  gpu::Program& program =
      shaders().program({.files = {"test/lookup.comp.glsl"}, .defines = {{"BOUNDS", "min_max_depth"}}});
  const std::vector<Kernel> kernels = randomKernels(size, true);
  const auto results = lookup(device(), program, graph.texture(pyramid.texture), kernels);
  for (size_t i = 0; i < kernels.size(); ++i) {
    const glm::ivec4 box(kernels[i].box);
    const glm::vec2 truth = bounds(box, static_cast<int>(kernels[i].receiver.x));
    ASSERT_LE(results[i].x, truth.x) << i;
    ASSERT_GE(results[i].y, truth.y) << i;
    if (box.x == box.z && box.y == box.w) {
      ASSERT_EQ(glm::vec2(results[i]), truth) << i;
    }
  }
}

TEST_F(DerivedMapsTest, EachIsBuiltOnceLeftOutUnusedAndKeptWhileNothingChanges) {
  makeSource({64, 64, 2});
  frame::FrameGraph graph;
  DerivedMaps maps(device());
  const frame::TextureHandle source = graph.importTexture("source", source_);
  const MinMaxPyramid pyramid = maps.minMaxPyramid(graph, source, true);
  EXPECT_EQ(pyramid.texture, maps.minMaxPyramid(graph, source, true).texture);
  const frame::TextureHandle windows = maps.nBuffer(graph, source, true);
  EXPECT_EQ(windows, maps.nBuffer(graph, source, true));
  const frame::TextureHandle overlapping = maps.minMaxWindows(graph, source, true);
  EXPECT_EQ(overlapping, maps.minMaxWindows(graph, source, true));
  EXPECT_FALSE(overlapping == pyramid.texture);
  const SummedAreaTable table = maps.summedAreaTable(graph, source, true, {.moments = SatMoments::z});
  EXPECT_EQ(table.texture,
            maps.summedAreaTable(graph, source, true, {.words = 1, .moments = SatMoments::z}).texture);
  EXPECT_FALSE(table.texture == maps.summedAreaTable(graph, source, true, {}).texture);
  graph.output(pyramid.texture);
  graph.output(windows);
  graph.output(overlapping);
  graph.output(table.texture);
  graph.prepare(device(), shaders(), *pool_);
  const auto states = [&] {
    std::vector<std::pair<std::string, frame::PassState>> list;
    for (const frame::PassReport& row : graph.explain()) list.emplace_back(row.name, row.state);
    return list;
  };
  // A pyramid of seven levels (four and three at once), two tables of two passes, of which the first is
  // wanted, an N-buffer of six levels and overlapping windows of four (the last two at once).
  const auto expectStates = [&](frame::PassState used) {
    const auto list = states();
    EXPECT_EQ(list.size(), 15u);
    for (const auto& [name, state] : list) {
      const bool wanted = name.starts_with("min-max") || name.starts_with("N-buffer") ||
                          (name.starts_with("summed") && !name.ends_with(" 2"));
      EXPECT_EQ(state, wanted ? used : frame::PassState::leftOut) << name;
    }
  };
  graph.execute();
  expectStates(frame::PassState::run);
  graph.execute();
  expectStates(frame::PassState::cached);
  graph.touch(source);
  graph.execute();
  expectStates(frame::PassState::run);

  // Every further level, and the columns, read what the pass before stored.
  for (const frame::PassReport& row : graph.explain()) {
    if (row.state == frame::PassState::leftOut || row.name.ends_with("level 0") ||
        row.name.ends_with("levels 0 to 3") || row.name.ends_with("rows"))
      continue;
    EXPECT_TRUE(row.barriers & GL_SHADER_IMAGE_ACCESS_BARRIER_BIT) << row.name;
  }
}

TEST_F(DerivedMapsTest, RefusesOtherSourcesAndDescriptionsOutOfRange) {
  frame::FrameGraph graph;
  DerivedMaps maps(device());
  const frame::TextureHandle wrong =
      graph.createTexture("wrong", {.format = GL_R32F, .width = 4, .height = 4});
  EXPECT_THROW(maps.minMaxPyramid(graph, wrong, false), Error);
  const frame::TextureHandle large = graph.createTexture(
      "large",
      {.target = GL_TEXTURE_2D_ARRAY, .format = GL_R32F, .width = 8192, .height = 8192, .layers = 5});
  EXPECT_THROW(maps.summedAreaTable(graph, large, false, {}), UsageError);
  EXPECT_THROW(maps.nBuffer(graph, large, false), UsageError);
  const frame::TextureHandle many = graph.createTexture("many", {.target = GL_TEXTURE_2D_ARRAY,
                                                                 .format = GL_R32F,
                                                                 .width = 4,
                                                                 .height = 4,
                                                                 .layers = device().limits().maxArrayLayers});
  EXPECT_THROW(maps.nBuffer(graph, many, false), UsageError);
  EXPECT_THROW(maps.summedAreaTable(graph, large, false, {.bits = 7}), UsageError);
  EXPECT_THROW(maps.summedAreaTable(graph, large, false, {.bits = 25}), UsageError);
  EXPECT_THROW(maps.summedAreaTable(graph, large, false, {.words = 3}), UsageError);
}

}  // namespace
}  // namespace limn::shadow
