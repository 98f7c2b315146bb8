// Random shadow maps, and lookups of boxes in what is derived from them.
#pragma once

#include <algorithm>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/shadow/derived_maps.h"
#include "tests/gpu/bind_by_name.h"
#include "tests/gpu/gl_test.h"

namespace limn::shadow {

struct Size {
  int width, height, layers;
};
inline constexpr Size kSizes[] = {{64, 64, 3}, {100, 100, 3}, {257, 257, 3}, {100, 33, 1}, {1, 1, 1}};

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

  /// (least, greatest) depth of the texels (x, y)..(z, w); outside the map it is 1.
  glm::vec2 bounds(glm::ivec4 box, int layer) const {
    glm::vec2 found(2, -1);
    for (int y = box.y; y <= box.w; ++y) {
      for (int x = box.x; x <= box.z; ++x) {
        const bool inside = x >= 0 && y >= 0 && x < size_.width && y < size_.height;
        const float z = inside ? depth(x, y, layer) : 1;
        found = {std::min(found.x, z), std::max(found.y, z)};
      }
    }
    return found;
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

/// Random kernels over a map, some of whose parts lie outside: (lo, hi) in texels and (layer, receiver
/// depth).
struct Kernel {
  glm::vec4 box, receiver;
};

inline std::vector<Kernel> randomKernels(const Size& size, bool whole) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0.f, 1.f);
  std::vector<Kernel> kernels(500);
  for (Kernel& k : kernels) {
    const glm::vec2 extent(size.width, size.height),
        lo = (1.2f * glm::vec2(unit(random), unit(random)) - 0.1f) * extent,
        hi = lo + 0.01f + 0.5f * unit(random) * glm::vec2(unit(random), unit(random)) * extent;
    k.box = {lo, hi};
    if (whole) k.box = {glm::floor(lo), glm::floor(hi)};
    k.receiver = {std::floor(unit(random) * static_cast<float>(size.layers)), unit(random), 0, 0};
  }
  return kernels;
}

inline constexpr const char* kLookupShader = R"(
#include "glsl/shadow/min_max_pyramid.glsl"
#include "glsl/shadow/min_max_windows.glsl"
#include "glsl/shadow/n_buffer.glsl"
#include "glsl/shadow/summed_area_table.glsl"
layout(local_size_x = 64) in;
struct Kernel { vec4 box; vec4 receiver; };
layout(std430) readonly buffer Kernels { Kernel kernels[]; };
layout(std430) writeonly buffer Results { vec4 results[]; };
#ifdef BOUNDS
uniform sampler2DArray bounds;
#else
uniform usampler2DArray table;
uniform uint table_format;
#endif
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(kernels.length())) return;
  Kernel k = kernels[i];
  int layer = int(k.receiver.x);
#ifdef BOUNDS
  results[i] = vec4(BOUNDS(bounds, ivec2(k.box.xy), ivec2(k.box.zw), layer), 0.0, 0.0);
#else
  SatBox box = sat_lookup_box(table, ivec2(floor(k.box.xy)), ivec2(floor(k.box.zw)), layer, table_format);
  results[i] = vec4(sat_lookup_moments(table, k.box.xy, k.box.zw, layer, k.receiver.y, table_format),
                    wide_unsigned_float(box.z), float(box.texels));
#endif
}
)";

/// What the lookups of `kLookupShader` give for every kernel.
inline std::vector<glm::vec4> lookup(gpu::Device& device, gpu::Program& program, const gpu::Texture& texture,
                                     const std::vector<Kernel>& kernels) {
  const gpu::Buffer in = gpu::Buffer::of<Kernel>(device, "kernels", kernels);
  const gpu::Buffer out(device, "results", kernels.size() * sizeof(glm::vec4));
  const gl::Functions& gl = device.gl();
  program.use();
  const bool bounds =
      std::ranges::any_of(program.resources(), [](const auto& r) { return r.name == "bounds"; });
  test::bindByName(gl, program, bounds ? "bounds" : "table", texture);
  test::bindByName(gl, program, "Kernels", in);
  test::bindByName(gl, program, "Results", out);
  gl.DispatchCompute(static_cast<GLuint>((kernels.size() + 63) / 64), 1, 1);
  gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<glm::vec4> results(kernels.size());
  out.read(0, results.data(), results.size() * sizeof(glm::vec4));
  return results;
}

}  // namespace limn::shadow
