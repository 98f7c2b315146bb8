// Ordering, culling, reported problems, sharing of memory and the graph's own description.
#include "core/frame/frame_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "core/base/error.h"

namespace limn::frame {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const gpu::TextureDesc kResult{.format = GL_RGBA16F, .width = 64, .height = 32};
constexpr int64_t kColourBytes = 64 * 32 * 8;

/// A pass that turns `input` (if any) into a new texture.
TextureHandle filter(FrameGraph& graph, const char* name, TextureHandle input = {}) {
  const TextureHandle target = graph.createTexture(std::string(name) + " result", kResult);
  PassBuilder pass = graph.addPass(name);
  if (input) pass.read(input, Access::sampled, "input");
  return pass.write(target, Access::imageStore, "result");
}

std::vector<std::string> orderOf(const FrameGraph& graph) {
  std::vector<std::string> names;
  for (const PassReport& row : graph.explain()) {
    if (row.state != PassState::leftOut) names.push_back(row.name);
  }
  return names;
}

std::string reasonOf(const FrameGraph& graph, std::string_view name) {
  for (const PassReport& row : graph.explain()) {
    if (row.name == name) return row.reason;
  }
  return "no such pass";
}

std::string problemsOf(FrameGraph& graph) {
  try {
    graph.plan();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(FrameGraphOrder, IndependentPassesKeepTheOrderOfDeclaration) {
  FrameGraph graph;
  for (const char* name : {"c", "a", "b"}) graph.output(filter(graph, name));
  graph.plan();
  EXPECT_THAT(orderOf(graph), ElementsAre("c", "a", "b"));
}

TEST(FrameGraphOrder, AReaderOfAnOlderVersionRunsBeforeTheOverwriter) {
  FrameGraph graph;
  const TextureHandle shared = graph.createTexture("shared", kResult);
  const TextureHandle first = graph.addPass("first").write(shared, Access::imageStore, "");
  PassBuilder second = graph.addPass("second");
  const TextureHandle overwritten = second.write(first, Access::imageStore, "");
  PassBuilder reader = graph.addPass("reader");
  reader.read(first, Access::sampled, "the first contents");
  graph.output(reader.write(graph.createTexture("seen", kResult), Access::imageStore, ""));
  graph.output(overwritten);
  graph.plan();
  EXPECT_THAT(orderOf(graph), ElementsAre("first", "reader", "second"));
}

TEST(FrameGraphOrder, AnOverwriterOfALeftOutPassStillWaitsForReadersBefore) {
  FrameGraph graph;
  const TextureHandle v1 =
      graph.addPass("first").write(graph.createTexture("shared", kResult), Access::imageStore, "");
  const TextureHandle v2 = graph.addPass("unread").write(v1, Access::imageStore, "");
  graph.output(graph.addPass("last").write(v2, Access::imageStore, ""));
  PassBuilder reader = graph.addPass("reader");
  reader.read(v1, Access::sampled, "");
  graph.output(reader.write(graph.createTexture("seen", kResult), Access::imageStore, ""));
  graph.plan();
  EXPECT_THAT(orderOf(graph), ElementsAre("first", "reader", "last"));
  EXPECT_EQ(reasonOf(graph, "unread"), "nothing reads shared");
}

TEST(FrameGraphOrder, RepeatedNamesAreNumberedPerTechnique) {
  FrameGraph graph;
  for (const char* technique : {"a", "a", "b", "a"}) graph.addPass("blur", technique).sideEffect();
  graph.plan();
  EXPECT_THAT(orderOf(graph), ElementsAre("blur", "blur 2", "blur", "blur 3"));
}

TEST(FrameGraphCulling, WithoutOutputsEverythingIsLeftOut) {
  FrameGraph graph;
  filter(graph, "end", filter(graph, "middle", filter(graph, "start")));
  graph.addPass("idle");
  graph.plan();
  EXPECT_THAT(orderOf(graph), ElementsAre());
  EXPECT_EQ(reasonOf(graph, "end"), "nothing reads end result");
  EXPECT_EQ(reasonOf(graph, "middle"), "only feeds end, which is left out");
  EXPECT_EQ(reasonOf(graph, "start"), "only feeds middle, which is left out");
  EXPECT_EQ(reasonOf(graph, "idle"), "writes nothing");
  EXPECT_EQ(graph.transientBytes(), 0);
  EXPECT_EQ(graph.transientBytesUnaliased(), 0);
}

TEST(FrameGraphCulling, ReasonsNameEveryUserWithItsTechnique) {
  FrameGraph graph;
  const TextureHandle start = filter(graph, "start");
  filter(graph, "left", start);
  PassBuilder right = graph.addPass("right", "pcss");
  right.read(start, Access::sampled, "");
  graph.plan();
  EXPECT_EQ(reasonOf(graph, "start"), "only feeds left and pcss/right, which are left out");
}

TEST(FrameGraphCulling, OutputsAndSideEffectsKeepWhatTheyNeed) {
  FrameGraph graph;
  const TextureHandle a = filter(graph, "a");
  const TextureHandle b = filter(graph, "b", a);
  graph.addPass("show").read(b, Access::sampled, "").sideEffect();
  filter(graph, "c", a);
  graph.plan();
  EXPECT_THAT(orderOf(graph), ElementsAre("a", "b", "show"));
}

TEST(FrameGraphCulling, BlendingNeedsTheContentsBeforeAndOverwritingDoesNot) {
  for (const Access access : {Access::colourBlend, Access::colourAttachment}) {
    FrameGraph graph;
    const TextureHandle cleared =
        graph.addPass("clear").write(graph.createTexture("sum", kResult), Access::colourAttachment, "");
    graph.output(graph.addPass("draw").write(cleared, access, ""));
    graph.plan();
    if (access == Access::colourBlend) {
      EXPECT_THAT(orderOf(graph), ElementsAre("clear", "draw"));
    } else {
      EXPECT_THAT(orderOf(graph), ElementsAre("draw"));
    }
  }
}

TEST(FrameGraphCulling, PassesThatWereNotDeclaredAreReportedLast) {
  FrameGraph graph;
  graph.leaveOut("caustics", "volume_caustics", "no specular surface");
  filter(graph, "unused");
  graph.plan();
  const std::vector<PassReport> rows = graph.explain();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].name, "caustics");
  EXPECT_EQ(rows[1].technique, "volume_caustics");
  EXPECT_EQ(rows[1].state, PassState::leftOut);
  EXPECT_EQ(rows[1].reason, "no specular surface");
}

TEST(FrameGraphRoles, AreThoseOfTheOwnerUnlessAPassSaysOtherwise) {
  FrameGraph graph;
  const auto add = [&](const char* name, const char* owner) {
    PassBuilder pass = graph.addPass(name, owner);
    pass.sideEffect();
    return pass;
  };
  add("gbuffer", "core");
  add("visibility", "pcf");
  add("shadow maps", "shadow").role(PassRole::map);
  add("pyramid", "shadow").role(PassRole::filter);
  graph.leaveOut("caustics", "volume_caustics", "no specular surface");
  graph.leaveOut("lights", "core", "no light");
  graph.plan();
  std::vector<PassRole> roles;
  for (const PassReport& row : graph.explain()) roles.push_back(row.role);
  EXPECT_THAT(roles, ElementsAre(PassRole::core, PassRole::technique, PassRole::map, PassRole::filter,
                                 PassRole::technique, PassRole::core));
}

TEST(FrameGraphProblems, ContentsNobodyWroteAreNamedWithTheirUse) {
  FrameGraph graph;
  graph.addPass("blur", "vssm")
      .read(graph.createTexture("moments", kResult), Access::sampled, "moments")
      .sideEffect();
  EXPECT_EQ(problemsOf(graph),
            "frame graph: pass 'vssm/blur' reads 'moments' as sampled (moments) before any pass wrote it");
}

TEST(FrameGraphProblems, BlendingOnNothingIsAProblem) {
  FrameGraph graph;
  graph.output(graph.addPass("draw").write(graph.createTexture("sum", kResult), Access::colourBlend, "sum"));
  EXPECT_THAT(problemsOf(graph), HasSubstr("reads 'sum' as colourBlend (sum) before any pass wrote it"));
}

TEST(FrameGraphProblems, TwoWritersOfOneVersionAreBothNamed) {
  FrameGraph graph;
  const TextureHandle target = graph.createTexture("target", kResult);
  graph.output(graph.addPass("a").write(target, Access::imageStore, ""));
  graph.output(graph.addPass("b").write(target, Access::imageStore, ""));
  EXPECT_THAT(problemsOf(graph), HasSubstr("passes 'a' and 'b' both write on top of version 0 of 'target'"));
}

TEST(FrameGraphProblems, AreAllReportedAtOnceInOneLine) {
  FrameGraph graph, other;
  const TextureHandle foreign = other.createTexture("foreign", kResult);
  const BufferHandle buffer = graph.createBuffer("buffer", {64});
  graph.addPass("a").read(foreign, Access::sampled, "colour").sideEffect();
  graph.addPass("b").read(TextureHandle{}, Access::sampled, "depth").sideEffect();
  graph.addPass("c").read(buffer, Access::sampled, "").sideEffect();
  graph.addPass("d").read(buffer, Access::storageStore, "").sideEffect();
  graph.output(buffer);
  const std::string text = problemsOf(graph);
  EXPECT_THAT(text, HasSubstr("frame graph: 5 problems: (1) "));
  EXPECT_THAT(text, HasSubstr("pass 'a' reads a texture handle of another graph (colour)"));
  EXPECT_THAT(text, HasSubstr("pass 'b' reads a null texture handle (depth)"));
  EXPECT_THAT(text, HasSubstr("pass 'c' reads buffer 'buffer' as sampled, which is no read of a buffer"));
  EXPECT_THAT(text,
              HasSubstr("pass 'd' reads buffer 'buffer' as storageStore, which is no read of a buffer"));
  EXPECT_THAT(text, HasSubstr("output 'buffer' is written by no pass"));
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_THROW(graph.explain(), Error);
}

TEST(FrameGraphProblems, WhatIsRefusedGivesItsNameToNothingElse) {
  FrameGraph graph;
  const BufferHandle corners =
      graph.addPass("fill").write(graph.createBuffer("corners", {64}), Access::storageStore, "");
  PassBuilder draw = graph.addPass("draw");
  draw.read(corners, Access::vertexBuffer, "").read(TextureHandle{}, Access::sampled, "map", "colours");
  draw.sideEffect();
  EXPECT_EQ(problemsOf(graph), "frame graph: pass 'draw' reads a null texture handle (colours)");
}

/// A graph that is built again often lies where the one before it lay.
TEST(FrameGraphProblems, HandlesOfAGraphThatIsGoneAreRefused) {
  std::optional<FrameGraph> graph(std::in_place);
  const TextureHandle old = graph->createTexture("old", kResult);
  for (int i = 0; i < 8; ++i) {
    graph.emplace();
    graph->createTexture("new", kResult);
    EXPECT_THROW(graph->desc(old), Error) << i;
  }
}

TEST(FrameGraphProblems, PassesThatNeedEachOtherHaveNoOrder) {
  FrameGraph graph;
  const TextureHandle x = graph.addPass("x").write(graph.createTexture("x", kResult), Access::imageStore, "");
  PassBuilder overwriter = graph.addPass("overwriter");
  const TextureHandle x2 = overwriter.write(x, Access::imageStore, "");
  const TextureHandle y = overwriter.write(graph.createTexture("y", kResult), Access::imageStore, "");
  PassBuilder reader = graph.addPass("reader");
  reader.read(x, Access::sampled, "").read(y, Access::sampled, "").sideEffect();
  graph.output(x2);
  EXPECT_THAT(problemsOf(graph), HasSubstr("no order satisfies passes 'overwriter' and 'reader'"));
}

TEST(FrameGraphProblems, AnOutputThatIsOverwrittenIsRefused) {
  FrameGraph graph;
  const TextureHandle a = graph.addPass("a").write(graph.createTexture("x", kResult), Access::imageStore, "");
  graph.output(a);
  graph.output(graph.addPass("b").write(a, Access::imageLoadStore, ""));
  EXPECT_THAT(problemsOf(graph), HasSubstr("output 'x' (version 1) is overwritten by pass 'b'"));
}

TEST(FrameGraphProblems, OneObjectIsImportedOnce) {
  FrameGraph graph;
  const gpu::Texture texture;
  graph.importTexture("here", texture);
  graph.importTexture("there", texture);
  EXPECT_THAT(problemsOf(graph), HasSubstr("'here' and 'there' import the same object"));
}

TEST(FrameGraphProblems, OnlyImportedResourcesAreTouched) {
  FrameGraph graph;
  const TextureHandle own = graph.createTexture("own", kResult);
  EXPECT_THROW(graph.touch(own), Error);
  EXPECT_THROW(graph.touch(BufferHandle{}), Error);
}

TEST(FrameGraphMemory, AChainOfEqualTexturesNeedsTwo) {
  FrameGraph graph;
  TextureHandle previous;
  for (const char* name : {"a", "b", "c", "d", "e"}) previous = filter(graph, name, previous);
  graph.addPass("show").read(previous, Access::sampled, "").sideEffect();
  graph.plan();
  EXPECT_EQ(graph.transientBytes(), 2 * kColourBytes);
  EXPECT_EQ(graph.transientBytesUnaliased(), 5 * kColourBytes);
}

TEST(FrameGraphMemory, OutputsKeepTheirMemoryToTheEnd) {
  FrameGraph graph;
  TextureHandle previous;
  for (const char* name : {"a", "b", "c", "d"}) {
    previous = filter(graph, name, previous);
    graph.output(previous);
  }
  graph.plan();
  EXPECT_EQ(graph.transientBytes(), 4 * kColourBytes);
}

TEST(FrameGraphMemory, DifferentDescriptionsDoNotShare) {
  FrameGraph graph;
  const TextureHandle a = filter(graph, "a");
  graph.addPass("use a").read(a, Access::sampled, "").sideEffect();
  gpu::TextureDesc wider = kResult;
  wider.width = 128;
  const TextureHandle b = graph.addPass("b").write(graph.createTexture("b", wider), Access::imageStore, "");
  graph.addPass("use b").read(b, Access::sampled, "").sideEffect();
  graph.plan();
  EXPECT_EQ(graph.transientBytes(), 3 * kColourBytes);
}

TEST(FrameGraphMemory, ResultsOfCacheablePassesAreNeverShared) {
  FrameGraph graph;
  const TextureHandle kept = graph.createTexture("kept", kResult);
  PassBuilder fill = graph.addPass("fill");
  const TextureHandle filled = fill.cacheable().write(kept, Access::imageStore, "");
  graph.addPass("use").read(filled, Access::sampled, "").sideEffect();
  const TextureHandle later = filter(graph, "later");
  graph.addPass("use later").read(later, Access::sampled, "").sideEffect();
  graph.plan();
  EXPECT_EQ(graph.transientBytes(), 2 * kColourBytes);
}

TEST(FrameGraphMemory, BuffersShareBySizeClass) {
  FrameGraph graph;
  for (const size_t bytes : {1000u, 1020u, 3000u}) {
    const BufferHandle buffer = graph.createBuffer("b", {bytes});
    PassBuilder write = graph.addPass("write");
    const BufferHandle written = write.write(buffer, Access::storageStore, "");
    graph.addPass("read").read(written, Access::storageLoad, "").sideEffect();
  }
  graph.plan();
  EXPECT_EQ(graph.transientBytes(), 1024 + 3072);
  EXPECT_EQ(graph.transientBytesUnaliased(), 1024 + 1024 + 3072);
}

TEST(FrameGraphMemory, MipChainsAreResolvedInTheDescription) {
  FrameGraph graph;
  gpu::TextureDesc full = kResult;
  full.levels = 0;
  EXPECT_EQ(graph.desc(graph.createTexture("chain", full)).levels, 7);
  const gpu::TextureDesc volume{
      .target = GL_TEXTURE_3D, .format = GL_R32F, .width = 8, .height = 4, .layers = 64, .levels = 0};
  EXPECT_EQ(graph.desc(graph.createTexture("volume", volume)).levels, 7) << "depths are halved, too";
}

TEST(FrameGraphReport, BytesCountWithTheFirstWriter) {
  FrameGraph graph;
  const TextureHandle cleared = graph.addPass("clear").write(graph.createTexture("sum", kResult),
                                                             Access::colourAttachment, "cleared sum");
  graph.output(graph.addPass("draw").write(cleared, Access::colourBlend, "more light"));
  graph.plan();
  const std::vector<PassReport> rows = graph.explain();
  EXPECT_EQ(rows[0].bytes, kColourBytes);
  EXPECT_EQ(rows[1].bytes, 0);
  ASSERT_EQ(rows[1].accesses.size(), 1u);
  EXPECT_EQ(rows[1].accesses[0].text(), "sum (colourBlend): more light");
  EXPECT_TRUE(rows[1].accesses[0].write);
  EXPECT_EQ(rows[1].accesses[0].texture, kResult);
}

TEST(FrameGraphReport, GraphvizQuotesNamesAndDashesWhatIsLeftOut) {
  FrameGraph graph;
  const TextureHandle a = filter(graph, "say \"hi\"\\\n");
  graph.output(filter(graph, "end", a));
  filter(graph, "unused", a);
  graph.leaveOut("skipped", "pcss", "light has no size");
  graph.plan();
  const std::string dot = graph.graphviz();
  EXPECT_THAT(dot, HasSubstr("label=\"say \\\"hi\\\"\\\\\\n\""));
  EXPECT_THAT(dot, HasSubstr("[shape=box, style=dashed, label=\"unused\\nnothing reads unused result\"]"));
  EXPECT_THAT(dot, HasSubstr("[shape=box, style=dashed, label=\"pcss/skipped\\nlight has no size\"]"));
  EXPECT_THAT(dot, HasSubstr("[shape=ellipse, style=dashed, peripheries=1, label=\"unused result\"]"));
  EXPECT_THAT(dot, HasSubstr("peripheries=2, label=\"end result\""));
  EXPECT_THAT(dot, HasSubstr("p0 -> r0_1 [style=solid, label=\"imageStore\", tooltip=\"result\"]"));
}

TEST(FrameGraphReport, NeedsAPlan) {
  FrameGraph graph;
  EXPECT_THROW(graph.explain(), Error);
  EXPECT_THROW(graph.execute(), Error);
  graph.plan();
  EXPECT_TRUE(graph.explain().empty());
  EXPECT_THROW(graph.execute(), Error);  // planned, not prepared
}

}  // namespace
}  // namespace limn::frame
