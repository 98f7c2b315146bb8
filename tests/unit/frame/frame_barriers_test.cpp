// The barriers a frame graph derives, bit by bit (OpenGL 4.5 core, 7.13.2). A software renderer works without
// any, so the list itself is what is checked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/frame/frame_graph.h"

namespace limn::frame {
namespace {

using ::testing::ElementsAre;

constexpr GLbitfield kImage = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;
constexpr GLbitfield kStorage = GL_SHADER_STORAGE_BARRIER_BIT;
constexpr GLbitfield kFetch = GL_TEXTURE_FETCH_BARRIER_BIT;
const gpu::TextureDesc kColour{.format = GL_RGBA16F, .width = 64, .height = 32};

std::vector<GLbitfield> barriersOf(FrameGraph& graph) {
  graph.plan();
  std::vector<GLbitfield> bits;
  for (const PassReport& row : graph.explain()) bits.push_back(row.barriers);
  return bits;
}

/// Reads by any pass on behalf of the outside, which is what keeps the pass.
template <class Handle>
void look(FrameGraph& graph, Handle handle, Access access, const char* name = "look") {
  graph.addPass(name).read(handle, access, "").sideEffect();
}

struct Pair {
  Access access;
  GLbitfield bit;
};
void PrintTo(const Pair& pair, std::ostream* out) {
  *out << name(pair.access);
}

class TextureReadAfterStore : public ::testing::TestWithParam<Pair> {};
TEST_P(TextureReadAfterStore, GetsTheBitOfTheRead) {
  FrameGraph graph;
  const TextureHandle x =
      graph.addPass("store").write(graph.createTexture("x", kColour), Access::imageStore, "");
  look(graph, x, GetParam().access);
  // The store waits for the read of the frame before.
  EXPECT_THAT(barriersOf(graph), ElementsAre(kImage, GetParam().bit));
  EXPECT_EQ(graph.finalBarriers(), 0u);
}
INSTANTIATE_TEST_SUITE_P(Accesses, TextureReadAfterStore,
                         ::testing::Values(Pair{Access::sampled, GL_TEXTURE_FETCH_BARRIER_BIT},
                                           Pair{Access::imageLoad, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT},
                                           Pair{Access::copySource, GL_TEXTURE_UPDATE_BARRIER_BIT}));

class BufferReadAfterStore : public ::testing::TestWithParam<Pair> {};
TEST_P(BufferReadAfterStore, GetsTheBitOfTheRead) {
  FrameGraph graph;
  const BufferHandle x =
      graph.addPass("store").write(graph.createBuffer("x", {64}), Access::storageStore, "");
  look(graph, x, GetParam().access);
  EXPECT_THAT(barriersOf(graph), ElementsAre(kStorage, GetParam().bit));
  EXPECT_EQ(graph.finalBarriers(), 0u);
}
INSTANTIATE_TEST_SUITE_P(Accesses, BufferReadAfterStore,
                         ::testing::Values(Pair{Access::uniformBuffer, GL_UNIFORM_BARRIER_BIT},
                                           Pair{Access::storageLoad, GL_SHADER_STORAGE_BARRIER_BIT},
                                           Pair{Access::vertexBuffer, GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT},
                                           Pair{Access::indexBuffer, GL_ELEMENT_ARRAY_BARRIER_BIT},
                                           Pair{Access::indirectBuffer, GL_COMMAND_BARRIER_BIT},
                                           Pair{Access::copySource, GL_BUFFER_UPDATE_BARRIER_BIT}));

// What a later write needs. The store at the start of the next frame waits for the reads of this one only:
// what an attachment or a copy wrote is in order.
class TextureWriteAfterStore : public ::testing::TestWithParam<Pair> {};
TEST_P(TextureWriteAfterStore, GetsTheBitOfTheWrite) {
  FrameGraph graph;
  const TextureHandle x =
      graph.addPass("store").write(graph.createTexture("x", kColour), Access::imageStore, "");
  look(graph, x, Access::imageLoad);
  const TextureHandle y = graph.addPass("write").write(x, GetParam().access, "");
  look(graph, y, Access::copySource, "read back");
  const std::vector<GLbitfield> bits = barriersOf(graph);
  ASSERT_EQ(bits.size(), 4u);
  EXPECT_EQ(bits[0], kImage);
  EXPECT_EQ(bits[1], kImage);
  EXPECT_EQ(bits[2], GetParam().bit);
}
INSTANTIATE_TEST_SUITE_P(Accesses, TextureWriteAfterStore,
                         ::testing::Values(Pair{Access::colourAttachment, GL_FRAMEBUFFER_BARRIER_BIT},
                                           Pair{Access::depthAttachment, GL_FRAMEBUFFER_BARRIER_BIT},
                                           Pair{Access::colourBlend, GL_FRAMEBUFFER_BARRIER_BIT},
                                           Pair{Access::depthTest, GL_FRAMEBUFFER_BARRIER_BIT},
                                           Pair{Access::copyTarget, GL_TEXTURE_UPDATE_BARRIER_BIT},
                                           // write after read of the image load between them
                                           Pair{Access::imageStore, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT},
                                           Pair{Access::imageLoadStore, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT}));

TEST(FrameBarriers, WritesInCommandOrderNeedNone) {
  for (const Access write : {Access::colourAttachment, Access::depthAttachment, Access::copyTarget}) {
    for (const Access read : {Access::sampled, Access::imageLoad, Access::copySource}) {
      FrameGraph graph;
      const TextureHandle x = graph.addPass("write").write(graph.createTexture("x", kColour), write, "");
      look(graph, x, read);
      EXPECT_THAT(barriersOf(graph), ElementsAre(0u, 0u)) << name(write) << " then " << name(read);
    }
  }
}

TEST(FrameBarriers, StoresWaitForEarlierReads) {
  FrameGraph graph;
  const TextureHandle x =
      graph.addPass("draw").write(graph.createTexture("x", kColour), Access::colourAttachment, "");
  look(graph, x, Access::sampled);
  graph.output(graph.addPass("store").write(x, Access::imageStore, ""));
  EXPECT_THAT(barriersOf(graph), ElementsAre(0u, 0u, kImage));
}

TEST(FrameBarriers, StoresAfterAttachmentsNeedNone) {
  FrameGraph graph;
  const TextureHandle x =
      graph.addPass("draw").write(graph.createTexture("x", kColour), Access::colourAttachment, "");
  const TextureHandle y = graph.addPass("store").write(x, Access::imageLoadStore, "");
  const TextureHandle z = graph.addPass("over").write(y, Access::colourBlend, "");
  look(graph, z, Access::copySource);
  // "over" keeps texels of "store", so that the read back still needs its own bit; the draw of the next frame
  // waits for the store, which the framebuffer bit of "over" has covered.
  EXPECT_THAT(barriersOf(graph),
              ElementsAre(0u, 0u, GL_FRAMEBUFFER_BARRIER_BIT, GL_TEXTURE_UPDATE_BARRIER_BIT));
}

TEST(FrameBarriers, ContentsReplacedInCommandOrderNeedNoFurtherBit) {
  FrameGraph graph;
  const TextureHandle x =
      graph.addPass("store").write(graph.createTexture("x", kColour), Access::imageStore, "");
  look(graph, x, Access::copySource);
  const TextureHandle y = graph.addPass("draw").write(x, Access::colourAttachment, "");
  look(graph, y, Access::sampled);
  EXPECT_THAT(barriersOf(graph),
              ElementsAre(kImage, GL_TEXTURE_UPDATE_BARRIER_BIT, GL_FRAMEBUFFER_BARRIER_BIT, 0u));
}

TEST(FrameBarriers, StoreAfterStoreAndAtomics) {
  FrameGraph graph;
  const BufferHandle a =
      graph.addPass("clear").write(graph.createBuffer("histogram", {64}), Access::storageStore, "");
  const BufferHandle b = graph.addPass("count").write(a, Access::storageLoadStore, "");
  const BufferHandle c = graph.addPass("scan").write(b, Access::storageLoadStore, "");
  look(graph, c, Access::indirectBuffer);
  EXPECT_THAT(barriersOf(graph), ElementsAre(kStorage, kStorage, kStorage, GL_COMMAND_BARRIER_BIT));
}

TEST(FrameBarriers, OneBitCoversEveryEarlierWrite) {
  FrameGraph graph;
  const TextureHandle x = graph.addPass("x").write(graph.createTexture("x", kColour), Access::imageStore, "");
  const TextureHandle y = graph.addPass("y").write(graph.createTexture("y", kColour), Access::imageStore, "");
  look(graph, x, Access::sampled, "look at x");
  look(graph, y, Access::sampled, "look at y");
  look(graph, x, Access::imageLoad, "load x");
  look(graph, x, Access::sampled, "look at x again");
  // "x" waits for the reads of the last frame, and its bit covers "y" too.
  EXPECT_THAT(barriersOf(graph), ElementsAre(kImage, 0u, kFetch, 0u, kImage, 0u));
}

TEST(FrameBarriers, ALaterWriteNeedsTheBitAgain) {
  FrameGraph graph;
  const TextureHandle x = graph.addPass("x").write(graph.createTexture("x", kColour), Access::imageStore, "");
  look(graph, x, Access::sampled, "look at x");
  PassBuilder second = graph.addPass("y");
  const TextureHandle y =
      second.read(x, Access::sampled, "").write(graph.createTexture("y", kColour), Access::imageStore, "");
  look(graph, y, Access::sampled, "look at y");
  EXPECT_THAT(barriersOf(graph), ElementsAre(kImage, kFetch, 0u, kFetch));
}

TEST(FrameBarriers, AliasesOfOneObjectAreHazardsOfEachOther) {
  FrameGraph graph;
  const TextureHandle x =
      graph.addPass("x").write(graph.createTexture("x", kColour), Access::colourAttachment, "");
  look(graph, x, Access::sampled, "look at x");
  const TextureHandle y = graph.addPass("y").write(graph.createTexture("y", kColour), Access::imageStore, "");
  look(graph, y, Access::copySource, "look at y");
  const std::vector<GLbitfield> bits = barriersOf(graph);
  ASSERT_EQ(graph.transientBytes() * 2, graph.transientBytesUnaliased());
  // Drawing x waits for the store to y of the frame before, in the same memory; storing y waits for the look
  // at x.
  EXPECT_THAT(bits, ElementsAre(GL_FRAMEBUFFER_BARRIER_BIT, 0u, kImage, GL_TEXTURE_UPDATE_BARRIER_BIT));
}

TEST(FrameBarriers, WithoutAliasesTheSamePassesNeedLess) {
  FrameGraph graph;
  gpu::TextureDesc wider = kColour;
  wider.width = 128;
  const TextureHandle x =
      graph.addPass("x").write(graph.createTexture("x", kColour), Access::colourAttachment, "");
  look(graph, x, Access::sampled, "look at x");
  const TextureHandle y = graph.addPass("y").write(graph.createTexture("y", wider), Access::imageStore, "");
  look(graph, y, Access::copySource, "look at y");
  EXPECT_THAT(barriersOf(graph), ElementsAre(0u, 0u, kImage, GL_TEXTURE_UPDATE_BARRIER_BIT));
}

TEST(FrameBarriers, ImportedHistoryIsAHazardAcrossFrames) {
  FrameGraph graph;
  const gpu::Buffer object;
  const BufferHandle before = graph.importBuffer("history", object);
  PassBuilder use = graph.addPass("use");
  const BufferHandle result = use.read(before, Access::uniformBuffer, "last frame's")
                                  .write(graph.createBuffer("result", {64}), Access::storageStore, "");
  PassBuilder keep = graph.addPass("keep");
  keep.read(result, Access::storageLoad, "").sideEffect();
  const BufferHandle after = keep.write(before, Access::storageStore, "next frame's");
  graph.output(after);
  const std::vector<GLbitfield> bits = barriersOf(graph);
  // "keep" writes what "use" reads in the next frame, and reads what "use" then overwrites: the bits after
  // the last pass have seen to both.
  EXPECT_THAT(bits, ElementsAre(0u, kStorage));
  EXPECT_EQ(graph.finalBarriers(), GL_UNIFORM_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                                       GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT |
                                       GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

TEST(FrameBarriers, OutputsOfShadersAreMadeVisibleToTheOutside) {
  FrameGraph graph;
  graph.output(graph.addPass("store").write(graph.createTexture("x", kColour), Access::imageStore, ""));
  EXPECT_THAT(barriersOf(graph), ElementsAre(kImage));  // after whatever the outside did with the last one
  EXPECT_EQ(graph.finalBarriers(), GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                                       GL_TEXTURE_UPDATE_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
}

TEST(FrameBarriers, OutputsOfAttachmentsNeedNone) {
  FrameGraph graph;
  graph.output(graph.addPass("draw").write(graph.createTexture("x", kColour), Access::colourAttachment, ""));
  EXPECT_THAT(barriersOf(graph), ElementsAre(0u));
  EXPECT_EQ(graph.finalBarriers(), 0u);
}

TEST(FrameBarriers, LeftOutPassesIssueNone) {
  FrameGraph graph;
  const TextureHandle x =
      graph.addPass("store").write(graph.createTexture("x", kColour), Access::imageStore, "");
  graph.addPass("unused").read(x, Access::sampled, "");
  EXPECT_THAT(barriersOf(graph), ElementsAre(0u, 0u));
  EXPECT_EQ(graph.finalBarriers(), 0u);
}

}  // namespace
}  // namespace limn::frame
