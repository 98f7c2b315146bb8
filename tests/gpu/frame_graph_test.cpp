// Frame graphs that run: results, memory, cache.
#include <gmock/gmock.h>

#include <array>
#include <map>
#include <numeric>

#include "tests/gpu/frame_graph_harness.h"

namespace limn::frame {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

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
    pass.read(current, Access::storageLoad, "Source", "");
    current = pass.write(graph.createBuffer("scaled", {400}), Access::storageStore, "Target", "");
    const ProgramHandle run = pass.program(program("scale", factor + std::string("u")));
    pass.execute([=](PassContext& context) {
      context.use(run);
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
  EXPECT_EQ(graph.transientBytes(), 2 * kSize * kSize * 4);
  EXPECT_EQ(graph.transientBytesUnaliased(), 9 * kSize * kSize * 4);
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

TEST_F(FrameGraphGpu, aGraphKeepsNoMemoryOfTheLastBesideItsOwn) {
  int64_t one = 0;
  for (const bool both : {false, true, false}) {
    FrameGraph graph;
    const TextureHandle start = set(graph, "start", 1);
    graph.output(both ? add(graph, "sum", start, 2) : start);
    prepare(graph);
    if (one == 0) one = pool_->bytes();
    EXPECT_EQ(pool_->bytes(), both ? 2 * one : one);
  }
}

TEST_F(FrameGraphGpu, cachedPassesRunAgainWhenTheirInputsChange) {
  gpu::Texture source(device(), "source", kValueDesc);
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

constexpr gpu::EmbeddedSource kUpdatedSources[] = {
    {"held.glsl",
     "#ifdef HELD_COUNT\n"
     "layout(std140) uniform Held { uvec4 held[HELD_COUNT]; };\n"
     "#else\n"
     "layout(std430) readonly buffer Held { uvec4 held[]; };\n"
     "#endif\n"},
    {"seen.comp.glsl",
     "#include \"held.glsl\"\n"
     "layout(local_size_x = 16) in;\n"
     "layout(std430) writeonly buffer Seen { uvec4 seen[]; };\n"
     "void main() { seen[gl_GlobalInvocationID.x] = held[gl_GlobalInvocationID.x]; }\n"},
    {"seen.vert.glsl",
     "#include \"held.glsl\"\n"
     "layout(location = 0) flat out uint value;\n"
     "void main() {\n"
     "  gl_Position = vec4(4.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0, 0.0, 1.0);\n"
     "  value = held[gl_VertexID].x;\n"
     "}\n"},
    {"seen.frag.glsl",
     "layout(location = 0) flat in uint value;\n"
     "layout(location = 0) out uint seen;\n"
     "void main() { seen = value; }\n"},
};

/// Passes that say what they read of a buffer of values.
class UpdatedBuffers : public FrameGraphGpu {
 protected:
  using Value = std::array<uint32_t, 4>;
  static constexpr uint32_t kCount = 16;
  struct Read {
    Access access;
    bool drawn;  ///< by a vertex shader
  };
  using Seen = std::function<std::vector<uint32_t>()>;

  static std::vector<Value> full(uint32_t value) {
    return std::vector<Value>(kCount, Value{value, value, value, value});
  }

  static Seen see(FrameGraph& graph, BufferHandle held, const Read& read) {
    std::map<std::string, std::string> defines;
    if (read.access == Access::uniformBuffer) defines["HELD_COUNT"] = std::to_string(kCount);
    PassBuilder pass = graph.addPass("see");
    pass.cacheable().read(held, read.access, "Held", "");
    return read.drawn ? draw(graph, pass, std::move(defines)) : copy(graph, pass, std::move(defines));
  }

 private:
  static Seen copy(FrameGraph& graph, PassBuilder& pass, std::map<std::string, std::string> defines) {
    const BufferHandle seen =
        pass.write(graph.createBuffer("seen", {kCount * sizeof(Value)}), Access::storageStore, "Seen", "");
    const ProgramHandle run = pass.program({{"techniques/updated/seen.comp.glsl"}, std::move(defines)});
    pass.execute([run](PassContext& context) {
      context.use(run);
      context.dispatch(kCount, 1, 1, kCount, 1);
    });
    graph.output(seen);
    return [&graph, seen] {
      std::vector<uint32_t> values(4 * kCount);
      graph.buffer(seen).read(0, values.data(), values.size() * sizeof(uint32_t));
      return values;
    };
  }

  static Seen draw(FrameGraph& graph, PassBuilder& pass, std::map<std::string, std::string> defines) {
    const TextureHandle seen =
        pass.write(graph.createTexture("seen", {.format = GL_R32UI, .width = kSize, .height = kSize}),
                   Access::colourAttachment, "");
    const ProgramHandle run = pass.program(
        {{"techniques/updated/seen.vert.glsl", "techniques/updated/seen.frag.glsl"}, std::move(defines)});
    pass.execute([run, seen](PassContext& context) {
      const gpu::VertexArray empty(device(), {});
      context.bindFramebuffer({{seen}});
      context.use(run);
      context.gl().BindVertexArray(empty.id());
      context.gl().DrawArrays(GL_TRIANGLES, 0, 3);
    });
    graph.output(seen);
    return [&graph, seen] {
      std::vector<uint32_t> values(kSize * kSize);
      graph.texture(seen).read(0, GL_RED_INTEGER, GL_UNSIGNED_INT, values.data(),
                               values.size() * sizeof(uint32_t));
      return values;
    };
  }
};

/// Views of shadow maps are such a buffer: maps are drawn with it as a storage block, and read with it as a
/// uniform block. Lights are another, a storage block of several passes. What a frame that is given up wrote
/// there is written over before anybody reads it. Before that a pass draws with another uniform block, as the
/// one that fills the G-buffer does.
TEST_F(UpdatedBuffers, areReadAsTheyWereUpdatedLast) {
  shaders().mount("techniques/updated/", kUpdatedSources);
  constexpr Read uniform{Access::uniformBuffer, false}, storage{Access::storageLoad, false},
      drawn{Access::storageLoad, true}, camera{Access::uniformBuffer, true};
  const std::vector<std::vector<Read>> all{{uniform},          {storage},        {drawn},
                                           {storage, uniform}, {drawn, uniform}, {drawn, storage},
                                           {storage, storage}};
  for (std::vector<Read> reads : all) {
    reads.insert(reads.begin(), camera);
    auto held = gpu::Buffer::of<Value>(device(), "held", full(0), gpu::BufferUse::updated);
    auto frame = gpu::Buffer::of<Value>(device(), "frame", full(0), gpu::BufferUse::updated);
    FrameGraph graph;
    const BufferHandle imported = graph.importBuffer("held", held),
                       importedFrame = graph.importBuffer("frame", frame);
    const auto update = [&](uint32_t value) {
      const std::vector<Value> values = full(value);
      for (gpu::Buffer* buffer : {&frame, &held}) buffer->update(0, values.data(), kCount * sizeof(Value));
      graph.touch(importedFrame);
      graph.touch(imported);
    };
    graph.output(set(graph, "first", 1));
    std::vector<Seen> seen;
    for (size_t i = 0; i < reads.size(); ++i)
      seen.push_back(see(graph, i == 0 ? importedFrame : imported, reads[i]));
    prepare(graph);
    graph.execute();
    for (size_t ranBefore = 0; ranBefore <= reads.size(); ++ranBefore) {  // passes of what is given up
      for (uint32_t unread = 0; unread < 4; ++unread) {
        for (uint32_t i = 0; i < unread; ++i) {
          update(100 + i);
          size_t left = ranBefore;
          EXPECT_FALSE(graph.execute(Timing::off, [&left] { return left-- == 0; }));
        }
        const uint32_t value = unread % 2;
        update(value);
        EXPECT_TRUE(graph.execute());
        for (size_t i = 0; i < seen.size(); ++i)
          EXPECT_THAT(seen[i](), Each(value))
              << name(reads[i].access) << (reads[i].drawn ? " of vertices" : "") << ", pass " << i << " of "
              << seen.size() << ", after " << unread << " frames given up behind " << ranBefore << " passes";
      }
    }
  }
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
  gpu::Texture source(device(), "source", kValueDesc);
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

}  // namespace
}  // namespace limn::frame
