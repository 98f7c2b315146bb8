// Overlapping min-max windows of shadow maps against bounds computed on the CPU, texel by texel.
#include "glsl/shadow/min_max_windows.glsl"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/gpu/derived_maps_harness.h"

namespace limn::shadow {
namespace {

/// Boxes of a texel up to all of the map, of all shapes, at its edges and corners and reaching out of it.
std::vector<Kernel> boxesEverywhere(const Size& size) {
  std::mt19937 random(7);
  const auto between = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, std::max(high, low))(random);
  };
  std::vector<Kernel> kernels(600);
  for (Kernel& k : kernels) {
    // As many narrow ones as wide ones.
    const auto side = [&](int most) { return between(1, std::max(most >> between(0, 8), 1)); };
    const glm::ivec2 map(size.width, size.height), extent(side(size.width), side(size.height));
    glm::ivec2 low(0);
    for (int axis = 0; axis < 2; ++axis) {
      const int at[] = {between(0, map[axis] - extent[axis]), 0, map[axis] - extent[axis], -extent[axis] / 2,
                        map[axis] - extent[axis] / 2 - 1};
      low[axis] = at[between(0, 4)];
    }
    k.box = {low, low + extent - 1};
    k.receiver = {static_cast<float>(between(0, size.layers - 1)), 0, 0, 0};
  }
  return kernels;
}

class MinMaxWindowsTest : public DerivedMapsTest {
 protected:
  /// Windows of the random map of that size, ready to look up.
  const gpu::Texture& build(frame::FrameGraph& graph, const Size& size) {
    makeSource(size);
    DerivedMaps maps(device());
    const frame::TextureHandle windows =
        maps.minMaxWindows(graph, graph.importTexture("source", source_), false);
    graph.output(windows);
    graph.prepare(device(), shaders(), *pool_);
    graph.execute();
    return graph.texture(windows);
  }
};

TEST_F(MinMaxWindowsTest, EachHoldsTheBoundsOfItsTexelsAsFarAsTheMapReaches) {
  for (const Size& size : kSizes) {
    frame::FrameGraph graph;
    const gpu::Texture& windows = build(graph, size);
    EXPECT_EQ(windows.desc().levels, glsl::min_max_windows_levels(std::max(size.width, size.height)));
    for (int level = 0; level < windows.desc().levels; ++level) {
      const int w = std::max(size.width >> level, 1), h = std::max(size.height >> level, 1);
      const int reach = glsl::min_max_window(level) - 1;
      const auto values = read<glm::vec2>(windows, level, GL_RG, GL_FLOAT, 1);
      for (int layer = 0; layer < size.layers; ++layer) {
        for (int y = 0; y < h; ++y) {
          for (int x = 0; x < w; ++x) {
            const glm::ivec2 low = glm::ivec2(x, y) << level,
                             high = glm::min(low + reach, glm::ivec2(size.width, size.height) - 1);
            ASSERT_EQ(values[static_cast<size_t>((layer * h + y) * w + x)], bounds({low, high}, layer))
                << size.width << " x " << size.height << " level " << level << " at " << x << ", " << y;
          }
        }
      }
    }
  }
}

TEST_F(MinMaxWindowsTest, LookupsAreConservativeAndExactWhereWindowsFit) {
  const gpu::EmbeddedSource sources[] = {{"lookup.comp.glsl", kLookupShader}};
  shaders().mount("test/", sources);
  std::vector<Size> maps(std::begin(kSizes), std::end(kSizes));
  maps.insert(maps.end(), {{513, 513, 1}, {2048, 2048, 1}});
  gpu::Program& program = shaders().program(
      {.files = {"test/lookup.comp.glsl"}, .defines = {{"BOUNDS", "min_max_windows_depth"}}});
  for (const Size& size : maps) {
    SCOPED_TRACE(fmt::format("{} x {}", size.width, size.height));
    frame::FrameGraph graph;
    const gpu::Texture& windows = build(graph, size);
    std::vector<Kernel> kernels = boxesEverywhere(size);
    // All four windows of four texels.
    for (int i = 0; i + 8 <= std::min(size.width, size.height); i += 5)
      kernels.push_back({{i, i, i + 7 - i % 4, i + 7 - i % 3}, {0, 0, 0, 0}});
    const auto results = lookup(device(), program, windows, kernels);
    int exact = 0;
    for (size_t i = 0; i < kernels.size(); ++i) {
      const glm::ivec4 box(kernels[i].box);
      const glm::vec2 truth = bounds(box, static_cast<int>(kernels[i].receiver.x));
      ASSERT_LE(results[i].x, truth.x) << i;
      ASSERT_GE(results[i].y, truth.y) << i;
      const glm::ivec2 extent = glm::ivec2(box.z, box.w) - glm::ivec2(box) + 1;
      const bool inside = box.x >= 0 && box.y >= 0 && box.z < size.width && box.w < size.height;
      const int least = std::min(extent.x, extent.y), most = std::max(extent.x, extent.y);
      if (!inside || least < glsl::min_max_window(0) || most > 2 * glsl::min_max_window(0)) continue;
      ASSERT_EQ(glm::vec2(results[i]), truth) << i;
      ++exact;
    }
    EXPECT_GT(exact, size.height > 1 ? 4 : -1);
  }
}

TEST_F(MinMaxWindowsTest, TwoWindowsCoverABoxAndReachBeyondItByLessThanWhereTheNextOneBegins) {
  for (const int size : {1, 33, 64, 100, 257}) {
    for (int first = 0; first < size; ++first) {
      for (int last = first; last < size; ++last) {
        int level = glsl::min_max_windows_level(last - first + 1);
        if (!glsl::min_max_windows_cover(first, last, level)) ++level;
        ASSERT_TRUE(glsl::min_max_windows_cover(first, last, level));
        ASSERT_LT(level, glsl::min_max_windows_levels(size));
        const int a = glsl::min_max_windows_first(first, level, size),
                  b = glsl::min_max_windows_second(last, a, level), stride = 1 << level,
                  window = glsl::min_max_window(level);
        ASSERT_LT(b, std::max(size >> level, 1));
        ASSERT_LE(a * stride, first);
        ASSERT_LE(b * stride, a * stride + window) << "a gap";
        ASSERT_GE(std::min(b * stride + window, size), last + 1);
        if (a == std::max(size >> level, 1) - 1)
          continue;  // what the map's edge cuts off has no window of its own
        ASSERT_LT(first - a * stride, stride);
        if (last - first + 1 >= window) {
          ASSERT_LT(b * stride + window - 1 - last, stride);
        }
      }
    }
  }
}

}  // namespace
}  // namespace limn::shadow
