// Frame graphs that run: results, memory, cache, state, times.
#include "core/frame/frame_graph.h"

#include <gmock/gmock.h>

#include <numeric>

#include "core/base/error.h"
#include "tests/gpu/gl_test.h"

namespace limn::frame {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

constexpr int size = 16;
const gpu::TextureDesc value_desc{.format = GL_R32F, .width = size, .height = size};

constexpr gpu::EmbeddedSource sources[] = {
    {"set.comp.glsl",
     "layout(local_size_x = 8, local_size_y = 8) in;\n"
     "layout(binding = 0, r32f) writeonly uniform image2D target;\n"
     "void main() { imageStore(target, ivec2(gl_GlobalInvocationID.xy), vec4(LIMN_VALUE)); }\n"},
    {"add.comp.glsl",
     "layout(local_size_x = 8, local_size_y = 8) in;\n"
     "layout(binding = 0, r32f) writeonly uniform image2D target;\n"
     "layout(binding = 0) uniform sampler2D source;\n"
     "void main() {\n"
     "  ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
     "  imageStore(target, p, texelFetch(source, p, 0) + LIMN_VALUE);\n"
     "}\n"},
    {"scale.comp.glsl",
     "layout(local_size_x = 64) in;\n"
     "layout(std430, binding = 0) readonly buffer Source { uint source[]; };\n"
     "layout(std430, binding = 1) writeonly buffer Target { uint target[]; };\n"
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
    shaders().mount("techniques/test/", sources);
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
    const TextureHandle target = pass.write(graph.createTexture(name, value_desc), Access::imageStore, "");
    const ProgramHandle run = pass.program(program("set", std::to_string(value)));
    pass.execute([=](PassContext& context) {
      context.program(run).use();
      context.bindImage(0, target, GL_WRITE_ONLY);
      context.dispatch(size, size, 1, 8, 8);
    });
    return target;
  }

  /// `source` plus `value`.
  static TextureHandle add(FrameGraph& graph, const char* name, TextureHandle source, int value,
                           bool cacheable = false) {
    PassBuilder pass = graph.addPass(name);
    if (cacheable) pass.cacheable();
    pass.read(source, Access::sampled, "");
    const TextureHandle target = pass.write(graph.createTexture(name, value_desc), Access::imageStore, "");
    const ProgramHandle run = pass.program(program("add", std::to_string(value)));
    pass.execute([=](PassContext& context) {
      context.program(run).use();
      context.bindSampled(0, source);
      context.bindImage(0, target, GL_WRITE_ONLY);
      context.dispatch(size, size, 1, 8, 8);
    });
    return target;
  }

  static std::vector<float> read(const gpu::Texture& texture) {
    std::vector<float> values(size * size);
    texture.read(0, GL_RED, GL_FLOAT, values.data(), values.size() * sizeof(float));
    return values;
  }

  static std::vector<std::string> states(const FrameGraph& graph) {
    std::vector<std::string> text;
    for (const PassReport& row : graph.explain())
      text.push_back(row.name + " " + std::string(name(row.state)));
    return text;
  }

  static std::string errorOf(const std::function<void()>& action) {
    try {
      action();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  std::optional<ResourcePool> pool_;
};

TEST_F(FrameGraphGpu, anEmptyGraphAllocatesNothing) {
  const gpu::Counters before = device().counters();
  FrameGraph graph;
  prepare(graph);
  graph.execute();
  graph.execute(Timing::query);
  EXPECT_EQ(device().counters(), before);
  EXPECT_EQ(pool_->bytes(), 0);
  EXPECT_TRUE(graph.passTimes().empty());
}

TEST_F(FrameGraphGpu, aLeftOutPassCompilesAndAllocatesNothing) {
  const gpu::Counters before = device().counters();
  FrameGraph graph;
  add(graph, "sum", set(graph, "start", 1), 2);
  graph.addPass("no such program").program({{"techniques/test/missing.comp.glsl"}, {}});
  prepare(graph);
  graph.execute();
  EXPECT_EQ(device().counters(), before);
}

TEST_F(FrameGraphGpu, buffersFlowThroughPasses) {
  std::vector<uint32_t> numbers(100);
  std::iota(numbers.begin(), numbers.end(), 1u);
  const auto source = gpu::Buffer::of<uint32_t>(device(), "numbers", numbers);
  FrameGraph graph;
  BufferHandle current = graph.importBuffer("numbers", source);
  for (const char* factor : {"3", "5", "7"}) {
    PassBuilder pass = graph.addPass("scale");
    pass.read(current, Access::storageLoad, "");
    const BufferHandle from = current;
    current = pass.write(graph.createBuffer("scaled", {400}), Access::storageStore, "");
    const ProgramHandle run = pass.program(program("scale", factor + std::string("u")));
    pass.execute([=, to = current](PassContext& context) {
      context.program(run).use();
      context.bindStorage(0, from);
      context.bindStorage(1, to);
      context.dispatch(128, 1, 1, 64, 1);
    });
  }
  graph.output(current);
  prepare(graph);
  graph.execute();
  std::vector<uint32_t> result(100);
  graph.buffer(current).read(0, result.data(), 400);
  for (uint32_t i = 0; i < 100; ++i) ASSERT_EQ(result[i], (i + 1) * 105);
}

TEST_F(FrameGraphGpu, aliasedMemoryGivesTheSameResults) {
  FrameGraph graph;
  TextureHandle current = set(graph, "set", 1);
  for (int i = 0; i < 8; ++i) current = add(graph, "add", current, 1 << i);
  graph.output(current);
  prepare(graph);
  EXPECT_EQ(graph.transientBytes(), 2 * size * size * 4);
  EXPECT_EQ(graph.transientBytesUnaliased(), 9 * size * size * 4);
  EXPECT_EQ(pool_->bytes(), graph.transientBytes());
  for (int frame = 0; frame < 3; ++frame) {
    graph.execute();
    EXPECT_THAT(read(graph.texture(current)), Each(256.0f));
  }
}

TEST_F(FrameGraphGpu, aRebuiltGraphFindsItsMemoryAgain) {
  int64_t bytes = 0;
  for (int i = 0; i < 3; ++i) {
    FrameGraph graph;
    const TextureHandle result = add(graph, "sum", set(graph, "start", 1), 2);
    graph.output(result);
    prepare(graph);
    graph.execute();
    EXPECT_THAT(read(graph.texture(result)), Each(3.0f));
    if (i == 0) bytes = device().counters().textureBytes;
    EXPECT_EQ(device().counters().textureBytes, bytes);
    pool_->trim();
    EXPECT_EQ(device().counters().textureBytes, bytes) << "memory in use is not freed";
  }
  pool_->trim();
  EXPECT_EQ(pool_->bytes(), 0);
}

TEST_F(FrameGraphGpu, cachedPassesRunAgainWhenTheirInputsChange) {
  gpu::Texture source(device(), "source", value_desc);
  source.clear({1, 0, 0, 0});
  FrameGraph graph;
  const TextureHandle imported = graph.importTexture("source", source);
  const TextureHandle first = add(graph, "first", imported, 10, true);
  const TextureHandle second = add(graph, "second", first, 100, true);
  const TextureHandle other = set(graph, "other", 7, true);
  const TextureHandle result = add(graph, "result", second, 1000);
  graph.output(result);
  graph.output(other);
  prepare(graph);
  graph.execute();
  EXPECT_THAT(states(graph), ElementsAre("first run", "second run", "other run", "result run"));
  EXPECT_THAT(read(graph.texture(result)), Each(1111.0f));

  source.clear({2, 0, 0, 0});  // unnoticed until touched
  graph.execute();
  EXPECT_THAT(states(graph), ElementsAre("first cached", "second cached", "other cached", "result run"));
  EXPECT_EQ(graph.explain()[0].reason, "inputs unchanged");
  EXPECT_THAT(read(graph.texture(result)), Each(1111.0f));

  graph.touch(imported);
  graph.execute();
  EXPECT_THAT(states(graph), ElementsAre("first run", "second run", "other cached", "result run"));
  EXPECT_THAT(read(graph.texture(result)), Each(1112.0f));
  EXPECT_THAT(read(graph.texture(other)), Each(7.0f));

  graph.invalidate();
  graph.execute();
  EXPECT_THAT(states(graph), ElementsAre("first run", "second run", "other run", "result run"));
}

TEST_F(FrameGraphGpu, aCacheablePassAfterOneThatAlwaysRunsIsNeverCached) {
  FrameGraph graph;
  graph.output(add(graph, "sum", set(graph, "start", 1), 2, true));
  prepare(graph);
  for (int frame = 0; frame < 3; ++frame) {
    graph.execute();
    EXPECT_THAT(states(graph), ElementsAre("start run", "sum run"));
  }
}

TEST_F(FrameGraphGpu, aPassThatReadsOnePartAndWritesAnotherIsCached) {
  gpu::Texture source(device(), "source", value_desc);
  source.clear({1, 0, 0, 0});
  FrameGraph graph;
  const TextureHandle imported = graph.importTexture("source", source);
  PassBuilder pass = graph.addPass("complete");
  pass.cacheable().read(imported, Access::imageLoad, "the first part");
  const TextureHandle completed = pass.write(imported, Access::imageStore, "the second");
  pass.execute([](PassContext&) {});
  graph.output(add(graph, "sum", completed, 10, true));
  prepare(graph);
  graph.execute();
  graph.execute();
  EXPECT_THAT(states(graph), ElementsAre("complete cached", "sum cached"));
  graph.touch(imported);
  graph.execute();
  EXPECT_THAT(states(graph), ElementsAre("complete run", "sum run"));
}

// The second contents replace the first in the same memory: whoever needs the first needs its pass to run
// again.
TEST_F(FrameGraphGpu, contentsThatAreOverwrittenWithinTheFrameAreNotCached) {
  for (const bool readerCacheable : {false, true}) {
    FrameGraph graph;
    const TextureHandle first = set(graph, "first", 1, true);
    const TextureHandle seen = add(graph, "reader", first, 10, readerCacheable);
    PassBuilder pass = graph.addPass("second");
    const TextureHandle second = pass.cacheable().write(first, Access::copyTarget, "");
    pass.execute([=](PassContext& context) {
      const float two[4] = {2, 0, 0, 0};
      context.gl().ClearTexImage(context.texture(second).id(), 0, GL_RED, GL_FLOAT, two);
    });
    graph.output(seen);
    graph.output(second);
    prepare(graph);
    for (int frame = 0; frame < 3; ++frame) {
      graph.execute();
      EXPECT_THAT(read(graph.texture(seen)), Each(11.0f));
      EXPECT_THAT(read(graph.texture(second)), Each(2.0f));
    }
    const char* state = readerCacheable ? "cached" : "run";
    EXPECT_THAT(states(graph), ElementsAre(std::string("first ") + state, std::string("reader ") + state,
                                           std::string("second ") + state));
  }
}

TEST_F(FrameGraphGpu, aThrowingPassLeavesNothingCachedAndTheStateRestored) {
  bool fail = true;
  FrameGraph graph;
  const TextureHandle start = set(graph, "start", 1, true);
  PassBuilder pass = graph.addPass("fails");
  pass.read(start, Access::sampled, "").sideEffect().execute([&](PassContext& context) {
    context.gl().Enable(GL_BLEND);
    if (fail) throw Error("on purpose");
  });
  prepare(graph);
  EXPECT_EQ(errorOf([&] { graph.execute(Timing::query); }), "on purpose");
  EXPECT_EQ(gl().IsEnabled(GL_BLEND), GL_FALSE);
  GLint depth = 0;
  gl().GetIntegerv(GL_DEBUG_GROUP_STACK_DEPTH, &depth);
  EXPECT_EQ(depth, 1);
  fail = false;
  graph.execute(Timing::query);
  EXPECT_THAT(states(graph), ElementsAre("start run", "fails run"));
}

TEST_F(FrameGraphGpu, eachPassFindsTheBaselineState) {
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

TEST_F(FrameGraphGpu, framebuffersAreMadeOnceAndSized) {
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

TEST_F(FrameGraphGpu, memoryIsLabelledWithWhatItHolds) {
  FrameGraph graph;
  const TextureHandle a = add(graph, "two", add(graph, "one", set(graph, "zero", 0), 1), 2);
  graph.output(a);
  prepare(graph);
  char label[64] = {};
  gl().GetObjectLabel(GL_TEXTURE, graph.texture(a).id(), sizeof label, nullptr, label);
  EXPECT_STREQ(label, "zero | two");
}

TEST_F(FrameGraphGpu, undeclaredUsesAreRefusedInDebugContexts) {
  struct Case {
    std::function<void(PassContext&, TextureHandle)> use;
    const char* message;
  };
  const Case cases[] = {
      {[](PassContext& c, TextureHandle t) { c.bindImage(0, t, GL_READ_ONLY); },
       "pass 'use' loads from image 'start' (version 1), which it did not declare as imageLoad or "
       "imageLoadStore"},
      {[](PassContext& c, TextureHandle t) { c.bindImage(0, t, GL_WRITE_ONLY); },
       "pass 'use' stores to image 'start' (version 1), which it did not declare as imageStore or "
       "imageLoadStore"},
      {[](PassContext& c, TextureHandle t) { c.bindFramebuffer({{t}}); },
       "pass 'use' draws to 'start' (version 1), which it did not declare as colourAttachment or "
       "colourBlend"},
      {[](PassContext& c, TextureHandle t) {
         --t.version;
         c.bindSampled(0, t);
       },
       "pass 'use' samples texture 'start' (version 0), which it did not declare as sampled"},
      {[](PassContext& c, TextureHandle) { c.texture({}); },
       "pass 'use' uses a texture handle that is null or of another graph"},
      {[](PassContext& c, TextureHandle) { c.program({0}); },
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

TEST_F(FrameGraphGpu, passTimesNameThePassesThatRan) {
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

TEST_F(FrameGraphGpu, theDerivedBarriersAreWhatIsIssued) {
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

}  // namespace
}  // namespace limn::frame
