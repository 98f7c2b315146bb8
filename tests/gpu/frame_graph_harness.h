// Frame graphs that run: a context, a pool and two passes to build graphs of.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/frame/frame_graph.h"
#include "tests/gpu/gl_test.h"

namespace limn::frame {

inline constexpr int kSize = 16;
inline const gpu::TextureDesc kValueDesc{.format = GL_R32F, .width = kSize, .height = kSize};

inline constexpr gpu::EmbeddedSource kSources[] = {
    {"set.comp.glsl",
     "layout(local_size_x = 8, local_size_y = 8) in;\n"
     "layout(r32f) writeonly uniform image2D target;\n"
     "void main() { imageStore(target, ivec2(gl_GlobalInvocationID.xy), vec4(LIMN_VALUE)); }\n"},
    {"add.comp.glsl",
     "layout(local_size_x = 8, local_size_y = 8) in;\n"
     "layout(r32f) writeonly uniform image2D target;\n"
     "uniform sampler2D source;\n"
     "void main() {\n"
     "  ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
     "  imageStore(target, p, texelFetch(source, p, 0) + LIMN_VALUE);\n"
     "}\n"},
    {"scale.comp.glsl",
     "layout(local_size_x = 64) in;\n"
     "layout(std430) readonly buffer Source { uint source[]; };\n"
     "layout(std430) writeonly buffer Target { uint target[]; };\n"
     "void main() {\n"
     "  uint i = gl_GlobalInvocationID.x;\n"
     "  if (i < source.length() && i < target.length()) target[i] = source[i] * LIMN_VALUE;\n"
     "}\n"},
};

class FrameGraphGpu : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    pool_.emplace(device());
    shaders().mount("techniques/test/", kSources);
  }
  void TearDown() override {
    pool_.reset();
    GlTest::TearDown();
  }

  void prepare(FrameGraph& graph) { graph.prepare(device(), shaders(), *pool_); }

  static gpu::ProgramDesc program(const std::string& file, const std::string& value) {
    return {{"techniques/test/" + file + ".comp.glsl"}, {{"LIMN_VALUE", value}}};
  }

  /// A texture full of `value`.
  static TextureHandle set(FrameGraph& graph, const char* name, int value, bool cacheable = false) {
    PassBuilder pass = graph.addPass(name);
    if (cacheable) pass.cacheable();
    const TextureHandle target =
        pass.write(graph.createTexture(name, kValueDesc), Access::imageStore, "target", "");
    const ProgramHandle run = pass.program(program("set", std::to_string(value)));
    pass.execute([=](PassContext& context) {
      context.use(run);
      context.dispatch(kSize, kSize, 1, 8, 8);
    });
    return target;
  }

  /// `source` plus `value`.
  static TextureHandle add(FrameGraph& graph, const char* name, TextureHandle source, int value,
                           bool cacheable = false) {
    PassBuilder pass = graph.addPass(name);
    if (cacheable) pass.cacheable();
    pass.read(source, Access::sampled, "source", "");
    const TextureHandle target =
        pass.write(graph.createTexture(name, kValueDesc), Access::imageStore, "target", "");
    const ProgramHandle run = pass.program(program("add", std::to_string(value)));
    pass.execute([=](PassContext& context) {
      context.use(run);
      context.dispatch(kSize, kSize, 1, 8, 8);
    });
    return target;
  }

  static std::vector<float> read(const gpu::Texture& texture) {
    std::vector<float> values(kSize * kSize);
    texture.read(0, GL_RED, GL_FLOAT, values.data(), values.size() * sizeof(float));
    return values;
  }

  static std::vector<std::string> states(const FrameGraph& graph) {
    std::vector<std::string> text;
    for (const PassReport& row : graph.explain())
      text.push_back(row.name + " " + std::string(name(row.state)));
    return text;
  }

  std::optional<ResourcePool> pool_;
};

}  // namespace limn::frame
