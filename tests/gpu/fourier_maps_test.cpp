// Fourier basis maps against brute force over the texels of the shadow map.
#include "core/shadow/fourier_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "glsl/shadow/fourier_shadow.glsl"
#include "tests/gpu/bind_by_name.h"
#include "tests/gpu/gl_test.h"

namespace limn::shadow {
namespace {

constexpr int kMapWidth = 100, kMapHeight = 77, kLayers = 3;

constexpr const char* kLookupShader = R"(
#include "glsl/shadow/fourier_lookup.glsl"
layout(local_size_x = 64) in;
struct Kernel { vec4 box; vec4 receiver; };
layout(std430) readonly buffer Kernels { Kernel kernels[]; };
layout(std430) writeonly buffer Results { vec4 results[]; };
void main() {
  uint at = gl_GlobalInvocationID.x;
  if (at >= uint(kernels.length())) return;
  Kernel k = kernels[at];
  int layer = int(k.receiver.x);
  ivec2 size = textureSize(fourier_depth_maps, 0).xy;
  vec3 sum = vec3(0.0);  // of s, n and 1
#if FOURIER_SAT
  FourierAxis x = fourier_axis(k.box.x, k.box.z, size.x, 3, false);
  FourierAxis y = fourier_axis(k.box.y, k.box.w, size.y, 2, false);
  for (int i = -fourier_cut; i < x.parts + fourier_cut; ++i) {
    ivec2 columns = clamp(ivec2(fourier_part(x, i), fourier_part(x, i + 1)), ivec2(0), size.xx);
    for (int j = -fourier_cut; j < y.parts + fourier_cut; ++j) {
      ivec2 rows = clamp(ivec2(fourier_part(y, j), fourier_part(y, j + 1)), ivec2(0), size.yy);
      float texels = float((columns.y - columns.x) * (rows.y - rows.x));
      FourierMeans means = fourier_means(fourier_edge(columns, rows.x, layer), fourier_edge(columns, rows.y, layer),
                                         texels, float(fourier_sum_scale(size.x * size.y)));
      float weight = texels * fourier_part_weight(x, i) * fourier_part_weight(y, j);
      sum += weight * vec3(fourier_shadow(means, k.receiver.y), 1.0);
    }
  }
#else
  sum = vec3(fourier_shadow(fourier_means(k.box.xy, k.box.zw, size, layer), k.receiver.y), 1.0);
#endif
  results[at] = vec4(sum.xy / sum.z, fourier_ranges[layer].zero, fourier_ranges[layer].scale);
}
)";

struct Kernel {
  glm::vec4 box, receiver;
};

class FourierMapsTest : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    pool_.emplace(device());
    std::mt19937 random(1);
    std::uniform_real_distribution<float> value(-0.1f, 1.1f);
    depth_.resize(size_t{kMapWidth} * kMapHeight * kLayers);
    for (float& z : depth_) z = std::clamp(value(random), 0.f, 1.f);
    source_ = gpu::Texture(device(), "source",
                           {.target = GL_TEXTURE_2D_ARRAY,
                            .format = GL_R32F,
                            .width = kMapWidth,
                            .height = kMapHeight,
                            .layers = kLayers});
    for (int i = 0; i < kLayers; ++i)
      source_.upload(0, i, GL_RED, GL_FLOAT,
                     depth_.data() + size_t{kMapWidth} * kMapHeight * static_cast<size_t>(i));
  }
  void TearDown() override {
    pool_.reset();
    source_ = {};
    GlTest::TearDown();
  }

  float depth(int x, int y, int layer) const {
    return depth_[static_cast<size_t>((layer * kMapHeight + y) * kMapWidth + x)];
  }

  /// Builds the maps in `graph` and runs it.
  FourierMaps build(frame::FrameGraph& graph, const FourierDesc& desc) {
    DerivedMaps derived(device());
    const frame::TextureHandle source = graph.importTexture("source", source_);
    FourierMaps maps =
        addFourierMaps(graph, device(), source, derived.minMaxPyramid(graph, source, false), false, desc);
    graph.output(maps.basis);
    graph.output(maps.depthBasis);
    graph.output(maps.depth);
    graph.output(maps.ranges);
    graph.prepare(device(), shaders(), *pool_);
    graph.execute();
    return maps;
  }

  static std::vector<int> words(const gpu::Texture& texture, size_t components) {
    const gpu::TextureDesc& d = texture.desc();
    std::vector<int> values(static_cast<size_t>(d.width * d.height * d.layers) * components);
    texture.read(0, components == 1 ? GL_RED_INTEGER : GL_RGBA_INTEGER, GL_INT, values.data(),
                 values.size() * 4);
    return values;
  }

  static std::vector<Kernel> randomKernels(float range) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0.f, 1.f);
    std::vector<Kernel> kernels(300);
    for (Kernel& k : kernels) {
      const glm::vec2 extent(kMapWidth, kMapHeight), a = extent * glm::vec2(unit(random), unit(random)),
                                                     b = extent * glm::vec2(unit(random), unit(random));
      k.box = {glm::min(a, b), glm::max(a, b) + 0.01f};
      k.box.z = std::min(k.box.z, float(kMapWidth)), k.box.w = std::min(k.box.w, float(kMapHeight));
      k.receiver = {std::floor(unit(random) * kLayers), unit(random) * range, 0, 0};
    }
    kernels[0].box = {0, 0, kMapWidth, kMapHeight};
    kernels[1].receiver.y = 0;
    kernels[2].receiver.y = range;
    return kernels;
  }

  std::vector<glm::vec4> lookUp(frame::FrameGraph& graph, const FourierMaps& maps,
                                const std::vector<Kernel>& kernels) {
    const gpu::EmbeddedSource sources[] = {{"lookup.comp.glsl", kLookupShader}};
    shaders().mount("test/", sources);
    gpu::Program& program =
        shaders().program({.files = {"test/lookup.comp.glsl"}, .defines = maps.defines()});
    const gpu::Sampler trilinear(device(), GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
    const gpu::Buffer in = gpu::Buffer::of<Kernel>(device(), "kernels", kernels);
    const gpu::Buffer out(device(), "results", kernels.size() * sizeof(glm::vec4));
    const gl::Functions& gl = device().gl();
    program.use();
    const std::pair<const char*, frame::TextureHandle> named[] = {
        {"fourier_basis_maps", maps.basis},
        {"fourier_depth_basis_maps", maps.depthBasis},
        {"fourier_depth_maps", maps.depth}};
    for (const auto& [name, map] : named)
      test::bindByName(gl, program, name, graph.texture(map),
                       maps.desc.filter == FourierFilter::mip ? &trilinear : nullptr);
    test::bindByName(gl, program, "Kernels", in);
    test::bindByName(gl, program, "Results", out);
    test::bindByName(gl, program, "FourierRanges", graph.buffer(maps.ranges));
    gl.DispatchCompute(static_cast<GLuint>((kernels.size() + 63) / 64), 1, 1);
    gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    for (const auto& [name, map] : named) test::bindByName(gl, program, name, graph.texture(map));
    std::vector<glm::vec4> results(kernels.size());
    out.read(0, results.data(), results.size() * sizeof(glm::vec4));
    return results;
  }

  std::vector<float> depth_;
  gpu::Texture source_;
  std::optional<frame::ResourcePool> pool_;
};

TEST_F(FourierMapsTest, BothMethodsSumTheSameToTheBit) {
  for (const int order : {1, 4, 7}) {
    std::vector<std::vector<int>> tables[2];
    for (const SatMethod method : {SatMethod::rowParallel, SatMethod::sharedMemory}) {
      frame::FrameGraph graph;
      const FourierMaps maps = build(graph, {.order = order, .method = method});
      auto& t = tables[method == SatMethod::rowParallel ? 0 : 1];
      for (const frame::TextureHandle map : {maps.basis, maps.depthBasis})
        t.push_back(words(graph.texture(map), 4));
      t.push_back(words(graph.texture(maps.depth), 1));
    }
    EXPECT_TRUE(tables[0] == tables[1]) << order;
  }
}

TEST_F(FourierMapsTest, KernelsOfSumsAreTheMeansOfTheirTexels) {
  for (const int order : {1, 2, 3, 4, 16}) {
    for (const FourierWindow window : {FourierWindow::none, FourierWindow::lanczos}) {
      frame::FrameGraph graph;
      const FourierMaps maps = build(graph, {.order = order, .window = window, .fit = FourierFit::map});
      const double range = maps.constants.range, delta = maps.constants.delta;
      const auto kernels = randomKernels(float(range));
      const auto results = lookUp(graph, maps, kernels);
      for (size_t i = 0; i < kernels.size(); ++i) {
        const auto& [box, receiver] = kernels[i];
        double lit = 0, blocked = 0, weights = 0;
        for (int y = int(box.y); y < std::min(int(std::ceil(box.w)), kMapHeight); ++y) {
          for (int x = int(box.x); x < std::min(int(std::ceil(box.z)), kMapWidth); ++x) {
            const double w = (std::min<double>(box.z, x + 1) - std::max<double>(box.x, x)) *
                             (std::min<double>(box.w, y + 1) - std::max<double>(box.y, y));
            const double z = range * depth(x, y, int(receiver.x)),
                         s = fourierSeries(z - receiver.y + delta, order, window);
            weights += w;
            lit += w * s;
            blocked += w * (1 - s) * z;
          }
        }
        ASSERT_NEAR(results[i].x, lit / weights, maps.noise + 2e-5) << order << " kernel " << i;
        ASSERT_NEAR(results[i].y, blocked / weights, 2 * maps.noise + 2e-5) << order << " kernel " << i;
      }
    }
  }
}

TEST_F(FourierMapsTest, TheCoarsestMipLevelIsTheMeanOfTheMap) {
  for (const int order : {1, 4}) {
    frame::FrameGraph graph;
    const FourierMaps maps =
        build(graph, {.order = order, .filter = FourierFilter::mip, .fit = FourierFit::map});
    auto kernels = randomKernels(float(maps.constants.range));
    for (Kernel& k : kernels) k.box = {-1000, -1000, 1000, 1000};
    const auto results = lookUp(graph, maps, kernels);
    for (size_t i = 0; i < kernels.size(); ++i) {
      double lit = 0;
      for (int y = 0; y < kMapHeight; ++y) {
        for (int x = 0; x < kMapWidth; ++x) {
          lit += fourierSeries(maps.constants.range * depth(x, y, int(kernels[i].receiver.x)) -
                                   double{kernels[i].receiver.y} + maps.constants.delta,
                               order, FourierWindow::none);
        }
      }
      // Each of seven levels rounds to 8 bits once.
      ASSERT_NEAR(results[i].x, lit / (kMapWidth * kMapHeight), 4 * maps.noise) << i;
    }
  }
}

/// A map of more than 128 texels, so that cells of 4 x 4 of them, or more at the edges, are looked at: some
/// hold both what is there and nothing. Off the plane lies 0.1 of depth; a cell adds what the plane changes
/// over it, 0.3 * 4 / 300 + 0.1 * 7 / 231 at most.
TEST_F(FourierMapsTest, RangesHoldAllThatIsThere) {
  constexpr int width = 300, height = 231;
  // A tilted plane with something before it, and nothing in one corner and in the last rows.
  std::vector<float> map;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float z = 0.4f + 0.3f * float(x) / width + 0.1f * float(y) / height;
      if (x > 90 && x < 120 && y > 70) z -= 0.1f;
      map.push_back((x < 5 && y < 5) || y >= height - 2 ? 1.f : z);
    }
  }
  source_ = gpu::Texture(
      device(), "source",
      {.target = GL_TEXTURE_2D_ARRAY, .format = GL_R32F, .width = width, .height = height, .layers = 1});
  source_.upload(0, 0, GL_RED, GL_FLOAT, map.data());
  for (const FourierFit fit : {FourierFit::map, FourierFit::range, FourierFit::plane}) {
    frame::FrameGraph graph;
    const FourierMaps maps = build(graph, {.fit = fit});
    glsl::FourierRange range{};
    graph.buffer(maps.ranges).read(0, &range, sizeof range);
    const auto most = float(maps.constants.range);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const float stored = map[static_cast<size_t>(y * width + x)];
        if (stored == 1) continue;
        const glm::vec2 uv((float(x) + 0.5f) / width, (float(y) + 0.5f) / height);
        const float d = glsl::fourier_depth(range, uv, stored);
        ASSERT_GE(d, -1e-5f);
        ASSERT_LE(d, most + 1e-5f);
      }
    }
    const float extent = most / range.scale;
    if (fit == FourierFit::map) {
      EXPECT_NEAR(extent, 1, 1e-6);
    }
    if (fit == FourierFit::range) {
      EXPECT_NEAR(extent, 0.4f, 0.02f);
    }
    if (fit == FourierFit::plane) {
      EXPECT_NEAR(extent, 0.11f, 0.03f);
    }
  }
}

TEST_F(FourierMapsTest, WhatDoesNotFitIsRefusedInOneLine) {
  frame::FrameGraph graph;
  DerivedMaps derived(device());
  const frame::TextureHandle source = graph.createTexture(
      "large", {.target = GL_TEXTURE_2D_ARRAY, .format = GL_R32F, .width = 8192, .height = 8192});
  try {
    addFourierMaps(graph, device(), source, {}, false, {.order = 16});
    FAIL() << "16 GiB were accepted";
  } catch (const UsageError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("8192"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
  EXPECT_THROW(addFourierMaps(graph, device(), source, {}, false, {.order = 65}), UsageError);
}

}  // namespace
}  // namespace limn::shadow
