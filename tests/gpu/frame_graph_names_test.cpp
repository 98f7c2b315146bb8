// Binding by name: what a pass calls its resources meets what its programs call theirs, and what does not fit
// is refused with pass and file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <string_view>

#include "tests/cli/process.h"
#include "tests/gpu/frame_graph_harness.h"

namespace limn::frame {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class FrameGraphNames : public FrameGraphGpu {
 protected:
  /// The message with which a graph is refused that has one pass, which `declare` declares, with the program
  /// add.comp.glsl: a sampler `source` and an image `target`.
  std::string refusal(const std::function<void(FrameGraph&, PassBuilder&, TextureHandle)>& declare) {
    FrameGraph graph;
    const TextureHandle start = set(graph, "start", 1);
    PassBuilder pass = graph.addPass("use", "test");
    declare(graph, pass, start);
    pass.program(program("add", "2"));
    pass.sideEffect().execute([](PassContext&) {});
    return errorOf([&] { prepare(graph); });
  }
  static TextureHandle target(FrameGraph& graph) { return graph.createTexture("sum", kValueDesc); }
};

TEST_F(FrameGraphNames, WhatAProgramUsesIsNamedByThePass) {
  const std::string missing = refusal([](FrameGraph& graph, PassBuilder& pass, TextureHandle start) {
    pass.read(start, Access::sampled, "");
    std::ignore = pass.write(target(graph), Access::imageStore, "target", "");
  });
  EXPECT_EQ(missing,
            "frame graph: techniques/test/add.comp.glsl (LIMN_VALUE=2) uses the sampler 'source', but pass "
            "'test/use' names target");
}

TEST_F(FrameGraphNames, ANameStandsInAProgramOfThePass) {
  const std::string unknown = refusal([](FrameGraph& graph, PassBuilder& pass, TextureHandle start) {
    pass.read(start, Access::sampled, "source", "").also("sauce");
    std::ignore = pass.write(target(graph), Access::imageStore, "target", "");
  });
  EXPECT_EQ(unknown,
            "frame graph: pass 'test/use' names 'sauce', which is not in techniques/test/add.comp.glsl "
            "(LIMN_VALUE=2)");
}

TEST_F(FrameGraphNames, ANameStandsForOneThing) {
  const std::string twice = refusal([](FrameGraph& graph, PassBuilder& pass, TextureHandle start) {
    pass.read(start, Access::sampled, "source", "");
    std::ignore = pass.write(target(graph), Access::imageStore, "source", "");
  });
  EXPECT_THAT(twice, HasSubstr("pass 'test/use' has two resources named 'source'"));
}

TEST_F(FrameGraphNames, ANameStandsForWhatTheProgramTakesItFor) {
  const std::string image = refusal([](FrameGraph& graph, PassBuilder& pass, TextureHandle start) {
    pass.read(start, Access::imageLoad, "source", "");
    std::ignore = pass.write(target(graph), Access::imageStore, "target", "");
  });
  EXPECT_EQ(
      image,
      "frame graph: 'source' is a sampler in techniques/test/add.comp.glsl (LIMN_VALUE=2), but imageLoad "
      "in pass 'test/use'");
  const std::string attachment = refusal([](FrameGraph& graph, PassBuilder& pass, TextureHandle start) {
    pass.read(start, Access::sampled, "source", "");
    std::ignore = pass.write(target(graph), Access::colourAttachment, "target", "");
  });
  EXPECT_THAT(attachment,
              HasSubstr("pass 'test/use' has 'sum' as colourAttachment, which no shader calls 'target'"));
}

TEST_F(FrameGraphNames, SlotsHoldAnotherThingForEachDispatch) {
  FrameGraph graph;
  const TextureHandle start = set(graph, "start", 1);
  PassBuilder pass = graph.addPass("use");
  pass.read(start, Access::sampled, "source", "");
  const TextureHandle a = pass.write(graph.createTexture("a", kValueDesc), Access::imageStore, "");
  const TextureHandle b = pass.write(graph.createTexture("b", kValueDesc), Access::imageStore, "");
  const SlotHandle slot = pass.slot("target");
  const ProgramHandle run = pass.program(program("add", "2"));
  pass.execute([=](PassContext& context) {
    context.use(run);
    for (const TextureHandle& each : {a, b}) {
      context.bind(slot, each);
      context.dispatch(kSize, kSize, 1, 8, 8);
    }
  });
  graph.output(a);
  graph.output(b);
  prepare(graph);
  graph.execute();
  EXPECT_THAT(read(graph.texture(a)), Each(3.f));
  EXPECT_THAT(read(graph.texture(b)), Each(3.f));
}

/// A pass may load one part of a texture and store another: each of the two contents has an access of its
/// own.
TEST_F(FrameGraphNames, SlotsAreBoundForTheAccessToTheirContents) {
  FrameGraph graph;
  const TextureHandle start = set(graph, "start", 1), source = set(graph, "source", 2);
  PassBuilder pass = graph.addPass("use");
  pass.read(source, Access::sampled, "source", "").read(start, Access::imageLoad, "one part");
  const TextureHandle written = pass.write(start, Access::imageStore, "the other");
  const SlotHandle slot = pass.slot("target");
  const ProgramHandle run = pass.program(program("add", "2"));
  std::vector<GLint> bound;
  pass.execute([=, &bound](PassContext& context) {
    context.use(run);
    for (const TextureHandle& each : {start, written}) {
      context.bind(slot, each);
      GLint access = 0;
      context.gl().GetIntegeri_v(GL_IMAGE_BINDING_ACCESS, 0, &access);
      bound.push_back(access);
    }
    context.dispatch(kSize, kSize, 1, 8, 8);
  });
  graph.output(written);
  prepare(graph);
  graph.execute();
  EXPECT_THAT(bound, ElementsAre(GL_READ_ONLY, GL_WRITE_ONLY));
  EXPECT_THAT(read(graph.texture(written)), Each(4.f));
}

TEST_F(FrameGraphNames, SlotsTakeOnlyWhatThePassDeclared) {
  FrameGraph graph;
  const TextureHandle start = set(graph, "start", 1);
  const TextureHandle other = set(graph, "other", 1);
  PassBuilder pass = graph.addPass("use");
  pass.read(start, Access::sampled, "source", "");
  const SlotHandle slot = pass.slot("target");
  const ProgramHandle run = pass.program(program("add", "2"));
  pass.sideEffect().execute([=](PassContext& context) {
    context.use(run);
    context.bind(slot, other);
  });
  graph.output(other);
  prepare(graph);
  EXPECT_THAT(errorOf([&] { graph.execute(); }), HasSubstr("pass 'use' uses texture 'other'"));
}

TEST_F(FrameGraphNames, ConstantsLieOutsideTheGraph) {
  const std::vector<uint32_t> numbers(64, 5);
  const auto source = gpu::Buffer::of<uint32_t>(device(), "numbers", numbers);
  FrameGraph graph;
  PassBuilder pass = graph.addPass("scale");
  pass.constant("Source", source);
  const BufferHandle to = pass.write(graph.createBuffer("scaled", {256}), Access::storageStore, "Target", "");
  const ProgramHandle run = pass.program(program("scale", "3u"));
  pass.execute([=](PassContext& context) {
    context.use(run);
    context.dispatch(64, 1, 1, 64, 1);
  });
  graph.output(to);
  prepare(graph);
  graph.execute();
  std::vector<uint32_t> result(64);
  graph.buffer(to).read(0, result.data(), 256);
  EXPECT_THAT(result, Each(15u));
}

/// Buffers have room for more than they hold, which length() of an array in a storage block must not count.
TEST_F(FrameGraphNames, StorageBlocksAreAsLongAsTheirBuffers) {
  const std::vector<uint32_t> numbers(64, 5);
  const auto source = gpu::Buffer::of<uint32_t>(device(), "numbers", numbers);
  for (const std::string_view way : {"constant", "slot", "imported"}) {
    FrameGraph graph;
    PassBuilder pass = graph.addPass("scale");
    std::optional<SlotHandle> slot;
    if (way == "constant") pass.constant("Source", source);
    if (way == "slot") slot = pass.slot("Source");
    if (way == "imported")
      pass.read(graph.importBuffer("numbers", source), Access::storageLoad, "Source", "");
    const BufferHandle to =
        pass.write(graph.createBuffer("scaled", {256}), Access::storageStore, "Target", "");
    const ProgramHandle run = pass.program(program("scale", "3u"));
    std::vector<GLint64> bound;
    pass.execute([=, &bound, &source](PassContext& context) {
      context.use(run);
      if (slot) context.bind(*slot, source);
      for (GLuint unit = 0; unit < 2; ++unit)
        context.gl().GetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, unit, &bound.emplace_back());
      context.dispatch(64, 1, 1, 64, 1);
    });
    graph.output(to);
    prepare(graph);
    graph.execute();
    EXPECT_THAT(bound, Each(256)) << way;
  }
}

/// A program of another text has its resources elsewhere.
TEST_F(FrameGraphNames, PlacesAreFoundAgainWhenShadersWereReloaded) {
  const test::TemporaryFolder folder;
  const auto write = [&](const char* text, int seconds) {
    const auto path = folder / "add.comp.glsl";
    std::ofstream(path) << text;
    std::filesystem::last_write_time(
        path, std::filesystem::file_time_type::clock::now() + std::chrono::seconds(seconds));
  };
  shaders().mount("techniques/reloaded/", {}, folder.path());
  write(
      "layout(local_size_x = 8, local_size_y = 8) in;\n"
      "layout(r32f) writeonly uniform image2D target;\n"
      "uniform sampler2D source;\n"
      "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
      "  imageStore(target, p, texelFetch(source, p, 0)); }\n",
      1);
  FrameGraph graph;
  const TextureHandle one = set(graph, "one", 1), ten = set(graph, "ten", 10);
  PassBuilder pass = graph.addPass("use");
  pass.read(one, Access::sampled, "source", "");
  const TextureHandle to = pass.write(target(graph), Access::imageStore, "target", "");
  pass.read(ten, Access::sampled, "");
  const SlotHandle other = pass.slot("another");
  const ProgramHandle run = pass.program({{"techniques/reloaded/add.comp.glsl"}, {}});
  pass.execute([=](PassContext& context) {
    context.use(run);
    context.bind(other, ten);
    context.dispatch(kSize, kSize, 1, 8, 8);
  });
  graph.output(to);
  EXPECT_THAT(errorOf([&] { prepare(graph); }), HasSubstr("pass 'use' names 'another', which is not in"));
  write(
      "layout(local_size_x = 8, local_size_y = 8) in;\n"
      "// another one comes later\n"
      "layout(r32f) writeonly uniform image2D target;\n"
      "uniform sampler2D source;\n"
      "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
      "  imageStore(target, p, texelFetch(source, p, 0)); }\n",
      2);
  EXPECT_EQ(shaders().reload().reloaded, 1);
  prepare(graph);
  graph.execute();
  EXPECT_THAT(read(graph.texture(to)), Each(1.f));
  write(
      "layout(local_size_x = 8, local_size_y = 8) in;\n"
      "layout(r32f) writeonly uniform image2D target;\n"
      "uniform sampler2D another;\n"
      "uniform sampler2D source;\n"
      "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
      "  imageStore(target, p, texelFetch(source, p, 0) + texelFetch(another, p, 0)); }\n",
      3);
  EXPECT_EQ(shaders().reload().reloaded, 1);
  graph.execute();
  EXPECT_THAT(read(graph.texture(to)), Each(11.f));
  // Twice without a frame between: OpenGL may give the deleted program's name to the last one, whose sampler
  // is at another unit.
  for (const char* factor : {"3", "2"}) {
    const std::string text = std::string(
                                 "layout(local_size_x = 8, local_size_y = 8) in;\n"
                                 "layout(r32f) writeonly uniform image2D target;\n"
                                 "uniform sampler2D source;\n"
                                 "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
                                 "  imageStore(target, p, texelFetch(source, p, 0) * ") +
                             factor + "); }\n";
    write(text.c_str(), *factor == '3' ? 4 : 5);
    EXPECT_EQ(shaders().reload().reloaded, 1);
  }
  graph.execute();
  EXPECT_THAT(read(graph.texture(to)), Each(2.f));
  // What the pass does not name is refused in every frame, not in the first alone.
  write(
      "layout(local_size_x = 8, local_size_y = 8) in;\n"
      "layout(r32f) writeonly uniform image2D target;\n"
      "uniform sampler2D source;\n"
      "uniform sampler2D unnamed;\n"
      "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
      "  imageStore(target, p, texelFetch(source, p, 0) + texelFetch(unnamed, p, 0)); }\n",
      6);
  EXPECT_EQ(shaders().reload().reloaded, 1);
  for (int frame = 0; frame < 2; ++frame)
    EXPECT_THAT(errorOf([&] { graph.execute(); }), HasSubstr("uses the sampler 'unnamed', but pass 'use'"))
        << "frame " << frame;
}

/// Graphs share programs, so that whoever has them reloaded need not know of each.
TEST_F(FrameGraphNames, WhatAReloadedProgramMadeIsMadeAgain) {
  const test::TemporaryFolder folder;
  const auto write = [&](int value, int seconds) {
    const auto path = folder / "value.comp.glsl";
    std::ofstream(path) << "layout(local_size_x = 8, local_size_y = 8) in;\n"
                           "layout(r32f) writeonly uniform image2D target;\n"
                           "void main() { imageStore(target, ivec2(gl_GlobalInvocationID.xy), vec4("
                        << value << ")); }\n";
    std::filesystem::last_write_time(
        path, std::filesystem::file_time_type::clock::now() + std::chrono::seconds(seconds));
  };
  shaders().mount("techniques/reloaded/", {}, folder.path());
  write(5, 1);
  FrameGraph graph;
  graph.output(set(graph, "other", 1, true));
  PassBuilder pass = graph.addPass("value");
  const TextureHandle value = pass.write(target(graph), Access::imageStore, "target", "");
  const ProgramHandle run = pass.program({{"techniques/reloaded/value.comp.glsl"}, {}});
  pass.cacheable().execute([run](PassContext& context) {
    context.use(run);
    context.dispatch(kSize, kSize, 1, 8, 8);
  });
  const TextureHandle sum = add(graph, "sum", value, 2, true);
  graph.output(sum);
  prepare(graph);
  graph.execute();
  EXPECT_THAT(read(graph.texture(sum)), Each(7.f));
  write(6, 2);
  EXPECT_EQ(shaders().reload().reloaded, 1);
  graph.execute();
  EXPECT_THAT(states(graph), ElementsAre("other cached", "value run", "sum run"));
  EXPECT_THAT(read(graph.texture(sum)), Each(8.f));
  graph.execute();
  EXPECT_THAT(states(graph), Each(HasSubstr(" cached")));
}

}  // namespace
}  // namespace limn::frame
