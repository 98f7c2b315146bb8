// N-buffers of shadow maps against bounds computed on the CPU, texel by texel.
#include "glsl/shadow/n_buffer.glsl"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/gpu/derived_maps_harness.h"

namespace limn::shadow {
namespace {

using NBufferTest = DerivedMapsTest;

/// Boxes of all sizes whose sides differ by at most one texel, some of whose parts lie outside.
std::vector<Kernel> nearlySquareKernels(const Size& size) {
  std::mt19937 random(6);
  const auto between = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  std::vector<Kernel> kernels(500);
  for (Kernel& k : kernels) {
    const int width = between(1, size.width), height = std::max(width + between(-1, 1), 1);
    const glm::ivec2 low(between(-2, size.width - width + 2),
                         between(-2, std::max(size.height - height, 0) + 2));
    k.box = {low, low + glm::ivec2(width, height) - 1};
    k.receiver = {static_cast<float>(between(0, size.layers - 1)), 0, 0, 0};
  }
  return kernels;
}

TEST_F(NBufferTest, LookupsAreExactForNearlySquareBoxesAndNeverWiderThanThePyramids) {
  const gpu::EmbeddedSource sources[] = {{"lookup.comp.glsl", kLookupShader}};
  shaders().mount("test/", sources);
  for (const Size& size : kSizes) {
    SCOPED_TRACE(fmt::format("{} x {}", size.width, size.height));
    makeSource(size);
    frame::FrameGraph graph;
    DerivedMaps maps(device());
    const frame::TextureHandle source = graph.importTexture("source", source_),
                               windows = maps.nBuffer(graph, source, false),
                               pyramid = maps.minMaxPyramid(graph, source, false).texture;
    graph.output(windows);
    graph.output(pyramid);
    graph.prepare(device(), shaders(), *pool_);
    graph.execute();
    std::vector<Kernel> kernels = nearlySquareKernels(size);
    const std::vector<Kernel> rectangles = randomKernels(size, true);
    kernels.insert(kernels.end(), rectangles.begin(), rectangles.end());
    const auto lookUp = [&](const char* function, frame::TextureHandle texture) {
      gpu::Program& program =
          shaders().program({.files = {"test/lookup.comp.glsl"}, .defines = {{"BOUNDS", function}}});
      return lookup(device(), program, graph.texture(texture), kernels);
    };
    const auto results = lookUp("n_buffer_depth", windows), wider = lookUp("min_max_depth", pyramid);
    int exact = 0, tighter = 0;
    for (size_t i = 0; i < kernels.size(); ++i) {
      const glm::ivec4 box(kernels[i].box);
      const glm::vec2 truth = bounds(box, static_cast<int>(kernels[i].receiver.x));
      const glm::ivec2 low = glm::max(glm::ivec2(box), 0),
                       high = glm::min(glm::ivec2(box.z, box.w), glm::ivec2(size.width, size.height) - 1),
                       extent = high - low + 1;
      const int window = 1 << glsl::n_buffer_level(std::max(extent.x, extent.y));
      ASSERT_LE(results[i].x, truth.x) << i;
      ASSERT_GE(results[i].y, truth.y) << i;
      ASSERT_GE(results[i].x, wider[i].x) << i;
      ASSERT_LE(results[i].y, wider[i].y) << i;
      tighter += glm::vec2(results[i]) != glm::vec2(wider[i]);
      if (std::min(extent.x, extent.y) < window) continue;  // also where the map's edge cuts a box short
      ASSERT_EQ(glm::vec2(results[i]), truth) << i;
      ++exact;
    }
    EXPECT_GT(exact, size.width > 1 ? 200 : 10);
    EXPECT_GT(tighter, size.width > 1 ? 10 : -1);
  }
}

TEST_F(NBufferTest, TwoWindowsOfTheChosenLevelCoverWhatLiesBetweenAndNoMore) {
  const int size = 100;
  for (int first = 0; first < size; ++first) {
    for (int last = first; last < size; ++last) {
      const int extent = last - first + 1, least = glsl::n_buffer_level(extent);
      for (int level = least; level < glsl::n_buffer_levels(size); ++level) {
        const int window = 1 << level, a = glsl::n_buffer_first(first, last, level),
                  b = glsl::n_buffer_second(last, a, level);
        ASSERT_GE(a, 0);
        ASSERT_LE(b, a + window);
        ASSERT_LE(a, first);
        ASSERT_GE(b + window - 1, last);
        if (extent < window) continue;
        ASSERT_EQ(a, first);
        ASSERT_EQ(b + window - 1, last);
      }
    }
  }
}

}  // namespace
}  // namespace limn::shadow
