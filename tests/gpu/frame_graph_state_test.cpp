// Frame graphs that run: what passes find, what is refused, times, barriers.
#include <gmock/gmock.h>

#include "tests/gpu/frame_graph_harness.h"

namespace limn::frame {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;

class FrameGraphState : public FrameGraphGpu {};

TEST_F(FrameGraphState, eachPassFindsTheBaselineState) {
  FrameGraph graph;
  int checked = 0;
  for (const char* name : {"a", "b"}) {
    graph.addPass(name).sideEffect().execute([&](PassContext& context) {
      const gl::Functions& gl = context.gl();
      for (const GLenum capability : {GL_DEPTH_TEST, GL_BLEND, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST,
                                      GL_POLYGON_OFFSET_FILL}) {
        EXPECT_EQ(gl.IsEnabled(capability), GL_FALSE) << capability;
        gl.Enable(capability);
      }
      GLint value[4] = {};
      gl.GetIntegerv(GL_DEPTH_WRITEMASK, value);
      EXPECT_EQ(value[0], GL_TRUE);
      gl.GetIntegerv(GL_COLOR_WRITEMASK, value);
      EXPECT_THAT(value, Each(GL_TRUE));
      gl.GetIntegerv(GL_DEPTH_FUNC, value);
      EXPECT_EQ(value[0], GL_LESS);
      gl.GetIntegerv(GL_BLEND_SRC_RGB, value);
      EXPECT_EQ(value[0], GL_ONE);
      gl.GetIntegerv(GL_BLEND_DST_RGB, value);
      EXPECT_EQ(value[0], GL_ZERO);
      gl.GetIntegerv(GL_DEBUG_GROUP_STACK_DEPTH, value);
      EXPECT_EQ(value[0], 2);
      gl.DepthMask(GL_FALSE);
      gl.ColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
      gl.DepthFunc(GL_GREATER);
      gl.BlendFunc(GL_DST_COLOR, GL_ONE);
      ++checked;
    });
  }
  prepare(graph);
  graph.execute();
  EXPECT_EQ(checked, 2);
  EXPECT_EQ(gl().IsEnabled(GL_DEPTH_TEST), GL_FALSE);
}

TEST_F(FrameGraphState, framebuffersAreMadeOnceAndSized) {
  gpu::TextureDesc colour{.format = GL_RGBA8, .width = 40, .height = 20, .levels = 2};
  gpu::TextureDesc depth{.format = GL_DEPTH_COMPONENT32F, .width = 20, .height = 10};
  FrameGraph graph;
  PassBuilder pass = graph.addPass("draw");
  const TextureHandle target =
      pass.write(graph.createTexture("colour", colour), Access::colourAttachment, "");
  const TextureHandle z = pass.write(graph.createTexture("depth", depth), Access::depthAttachment, "");
  pass.execute([=](PassContext& context) {
    context.bindFramebuffer({{target, 1}}, {z});
    GLint viewport[4];
    context.gl().GetIntegerv(GL_VIEWPORT, viewport);
    EXPECT_THAT(viewport, ElementsAre(0, 0, 20, 10));
    const float orange[4] = {1.0f, 0.6f, 0.2f, 1.0f};
    context.gl().ClearBufferfv(GL_COLOR, 0, orange);
  });
  graph.output(target);
  prepare(graph);
  const int before = device().counters().framebuffers;
  for (int frame = 0; frame < 3; ++frame) graph.execute();
  EXPECT_EQ(device().counters().framebuffers, before + 1);
  std::vector<uint8_t> texels(20 * 10 * 4);
  graph.texture(target).read(1, GL_RGBA, GL_UNSIGNED_BYTE, texels.data(), texels.size());
  EXPECT_EQ((std::vector<uint8_t>(texels.begin(), texels.begin() + 4)),
            (std::vector<uint8_t>{255, 153, 51, 255}));
}

TEST_F(FrameGraphState, memoryIsLabelledWithWhatItHolds) {
  FrameGraph graph;
  const TextureHandle a = add(graph, "two", add(graph, "one", set(graph, "zero", 0), 1), 2);
  graph.output(a);
  prepare(graph);
  char label[64] = {};
  gl().GetObjectLabel(GL_TEXTURE, graph.texture(a).id(), sizeof label, nullptr, label);
  EXPECT_STREQ(label, "zero | two");
}

TEST_F(FrameGraphState, undeclaredUsesAreRefusedInDebugContexts) {
  struct Case {
    std::function<void(PassContext&, TextureHandle)> use;
    const char* message;
  };
  const Case cases[] = {
      {[](PassContext& c, TextureHandle t) { c.bindFramebuffer({{t}}); },
       "pass 'use' draws to 'start' (version 1), which it did not declare as colourAttachment or "
       "colourBlend"},
      {[](PassContext& c, TextureHandle t) {
         --t.version;
         c.texture(t);
       },
       "pass 'use' uses texture 'start' (version 0), which it did not declare"},
      {[](PassContext& c, TextureHandle) { c.texture({}); },
       "pass 'use' uses a texture handle that is null or of another graph"},
      {[](PassContext& c, TextureHandle) { c.use({0}); },
       "pass 'use' uses a program that it did not declare"},
  };
  for (const Case& test : cases) {
    FrameGraph graph;
    const TextureHandle start = set(graph, "start", 1);
    PassBuilder pass = graph.addPass("use");
    pass.read(start, Access::sampled, "").sideEffect();
    pass.execute([&](PassContext& context) { test.use(context, start); });
    prepare(graph);
    EXPECT_EQ(errorOf([&] { graph.execute(); }), test.message);
  }
}

TEST_F(FrameGraphState, passTimesNameThePassesThatRan) {
  FrameGraph graph;
  const TextureHandle kept = set(graph, "kept", 1, true);
  graph.output(add(graph, "sum", kept, 2));
  prepare(graph);
  EXPECT_TRUE(graph.passTimes().empty());
  for (const Timing timing : {Timing::finish, Timing::query}) {
    graph.invalidate();
    for (const bool cached : {false, true, true}) {
      graph.execute(timing);
      if (cached) graph.execute();  // a frame without timing changes nothing
      std::vector<std::string> names;
      for (const PassTime& time : graph.passTimes()) {
        names.push_back(time.technique + "/" + time.name);
        EXPECT_GE(time.milliseconds, 0.0);
        EXPECT_LT(time.milliseconds, 10e3);
      }
      if (cached) {
        EXPECT_THAT(names, ElementsAre("core/sum"));
      } else {
        EXPECT_THAT(names, ElementsAre("core/kept", "core/sum"));
      }
    }
  }
}

/// Records what is issued by taking the place of one function of the context's table.
class BarrierRecorder {
 public:
  explicit BarrierRecorder(const gl::Functions& gl) : table_(const_cast<gl::Functions&>(gl)) {
    original_ = std::exchange(table_.MemoryBarrier, [](GLbitfield bits) { issued.push_back(bits); });
  }
  ~BarrierRecorder() { table_.MemoryBarrier = original_; }
  static std::vector<GLbitfield> take() { return std::exchange(issued, {}); }

 private:
  static inline std::vector<GLbitfield> issued;
  gl::Functions& table_;
  decltype(gl::Functions::MemoryBarrier) original_;
};

TEST_F(FrameGraphState, theDerivedBarriersAreWhatIsIssued) {
  FrameGraph graph;
  const TextureHandle kept = set(graph, "kept", 1, true);
  const TextureHandle more = add(graph, "more", kept, 1, true);
  const TextureHandle result = add(graph, "result", more, 2);
  graph.addPass("read back").read(result, Access::copySource, "").sideEffect().execute([](PassContext&) {});
  prepare(graph);
  const GLbitfield image = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT, fetch = GL_TEXTURE_FETCH_BARRIER_BIT;
  std::vector<GLbitfield> derived;
  for (const PassReport& row : graph.explain()) derived.push_back(row.barriers);
  EXPECT_THAT(derived, ElementsAre(image, fetch, fetch, GL_TEXTURE_UPDATE_BARRIER_BIT));

  const BarrierRecorder recorder(gl());
  graph.execute();
  EXPECT_THAT(BarrierRecorder::take(),
              ElementsAre(GL_ALL_BARRIER_BITS, fetch, fetch, GL_TEXTURE_UPDATE_BARRIER_BIT));
  graph.execute();  // the bits of the two passes that are skipped go to the next
  EXPECT_THAT(BarrierRecorder::take(), ElementsAre(image | fetch, GL_TEXTURE_UPDATE_BARRIER_BIT));
  graph.invalidate();
  graph.execute();
  EXPECT_THAT(BarrierRecorder::take(), ElementsAreArray(derived));
}

TEST_F(FrameGraphState, nothingIsPendingAfterAFrameThatEndedEarly) {
  FrameGraph graph;
  const TextureHandle start = set(graph, "start", 1);
  PassBuilder pass = graph.addPass("fails once");
  bool fails = true;
  pass.read(start, Access::sampled, "").sideEffect().execute([&fails](PassContext&) {
    if (std::exchange(fails, false)) throw Error("once");
  });
  prepare(graph);
  const GLbitfield image = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT, fetch = GL_TEXTURE_FETCH_BARRIER_BIT;
  const BarrierRecorder recorder(gl());
  EXPECT_EQ(errorOf([&] { graph.execute(); }), "once");
  EXPECT_THAT(BarrierRecorder::take(), ElementsAre(GL_ALL_BARRIER_BITS, fetch, GL_ALL_BARRIER_BITS));
  int left = 1;
  EXPECT_FALSE(graph.execute(Timing::off, [&left] { return left-- == 0; }));
  EXPECT_THAT(BarrierRecorder::take(), ElementsAre(image, GL_ALL_BARRIER_BITS));
  EXPECT_TRUE(graph.execute());
  EXPECT_THAT(BarrierRecorder::take(), ElementsAre(image, fetch));
}

}  // namespace
}  // namespace limn::frame
