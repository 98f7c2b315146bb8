// Executing a frame graph allocates nothing on the heap.
#include <gtest/gtest.h>

#include "core/frame/frame_graph.h"
#include "tests/gpu/gl_test.h"
#include "tests/heap/counted_allocations.h"

namespace limn::frame {
namespace {

const gpu::TextureDesc kValueDesc{.format = GL_R32F, .width = 16, .height = 16};

constexpr gpu::EmbeddedSource kSources[] = {
    {"copy.comp.glsl",
     "layout(local_size_x = 8, local_size_y = 8) in;\n"
     "layout(r32f) writeonly uniform image2D target;\n"
     "uniform sampler2D source;\n"
     "void main() {\n"
     "  ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
     "  imageStore(target, p, texelFetch(source, p, 0));\n"
     "}\n"},
};

class FrameGraphHeap : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    pool_.emplace(device());
  }
  void TearDown() override {
    pool_.reset();
    GlTest::TearDown();
  }
  std::optional<ResourcePool> pool_;
};

TEST_F(FrameGraphHeap, executingAllocatesNothing) {
  shaders().mount("techniques/test/", kSources);
  FrameGraph graph;
  PassBuilder draw = graph.addPass("draw");
  TextureHandle current =
      draw.cacheable().write(graph.createTexture("drawn", kValueDesc), Access::colourAttachment, "");
  draw.execute([=](PassContext& context) {
    context.bindFramebuffer({{current}});
    const float one[4] = {1, 1, 1, 1};
    context.gl().ClearBufferfv(GL_COLOR, 0, one);
  });
  for (int i = 0; i < 8; ++i) {
    PassBuilder copy = graph.addPass("copy");
    copy.read(current, Access::sampled, "source", "");
    current = copy.write(graph.createTexture("copied", kValueDesc), Access::imageStore, "target", "");
    const ProgramHandle program = copy.program({{"techniques/test/copy.comp.glsl"}, {}});
    copy.execute([=](PassContext& context) {
      context.use(program);
      context.dispatch(16, 16, 1, 8, 8);
    });
  }
  graph.output(current);
  graph.prepare(device(), shaders(), *pool_);
  for (const Timing timing : {Timing::off, Timing::query, Timing::finish}) {
    for (int frame = 0; frame < 4;
         ++frame) {  // framebuffers, queries and the driver's own things are made here
      graph.invalidate();
      graph.execute(timing);
    }
    gl().Finish();
    const test::CountedAllocations allocations;
    for (int frame = 0; frame < 10; ++frame) {
      if (frame % 2 == 0) graph.invalidate();
      graph.execute(timing);
    }
    EXPECT_EQ(allocations.count(), 0) << name(timing);
  }
}

}  // namespace
}  // namespace limn::frame
