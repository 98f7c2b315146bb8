#include "core/gpu_scene/pixel_blocks.h"

#include "core/gpu_scene/gpu_geometry.h"
#include "glsl/surface/pixel_blocks.glsl"

namespace limn::scene {

using frame::Access;

namespace {

constexpr int kBlocksPerSide = 8;

}  // namespace

PixelBlocks::PixelBlocks(frame::FrameGraph& graph, const gpu::Device& device, const SceneHandles& handles,
                         const GBuffer& gbuffer, glm::ivec2 size, const PixelBlockDesc& desc,
                         std::string_view technique)
    : desc_(desc), grid_(size) {
  if (desc.side == 1) return;
  const size_t listBytes = (1 + static_cast<size_t>(size.x) * static_cast<size_t>(size.y)) * sizeof(uint32_t);
  checkStorageBlock(device, "pixels that no block sees", listBytes, "picture");
  const glm::ivec2 blocks = glsl::block_count(size, desc.side);
  grid_ = {size.x, blocks.y + size.y};
  std::map<std::string, std::string> defines;
  define(defines);

  const auto readPixels = [&](frame::PassBuilder& pass) {
    pass.read(handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
        .read(gbuffer.depth, Access::sampled, kGBufferNames.depth, "positions")
        .read(gbuffer.normal, Access::sampled, kGBufferNames.normal, "normals")
        .read(gbuffer.material, Access::sampled, kGBufferNames.material, "what is lit");
  };

  frame::PassBuilder surfaces = graph.addPass("block gbuffer", technique);
  readPixels(surfaces);
  surfaces_ = surfaces.write(
      graph.createTexture("block gbuffer", {.format = GL_RGBA32UI, .width = blocks.x, .height = blocks.y}),
      Access::imageStore, "surfaces", "what each block is shaded at");
  lonePixels_ = surfaces.write(graph.createBuffer("lone pixels", {listBytes}), Access::storageStore,
                               "LonePixels", "none yet");
  const auto surfaceProgram =
      surfaces.program({.files = {"glsl/surface/block_surfaces.comp.glsl"}, .defines = defines});
  surfaces.execute([=](frame::PassContext& context) {
    context.use(surfaceProgram);
    context.dispatch(blocks.x, blocks.y, 1, kBlocksPerSide, kBlocksPerSide);
  });

  frame::PassBuilder alone = graph.addPass("lone pixels", technique);
  readPixels(alone);
  alone.read(surfaces_, Access::sampled, "block_surfaces", "what blocks see");
  lonePixels_ = alone.write(lonePixels_, Access::storageLoadStore, "LonePixels", "what no block sees");
  loneItems_ =
      alone.write(graph.createTexture("lone items", {.format = GL_R32UI, .width = size.x, .height = size.y}),
                  Access::imageStore, "lone_items", "where lone pixels are in the list");
  const auto aloneProgram =
      alone.program({.files = {"glsl/surface/lone_pixels.comp.glsl"}, .defines = std::move(defines)});
  alone.execute([aloneProgram, size, blocks = *this](frame::PassContext& context) {
    blocks.bind(context.use(aloneProgram));
    context.dispatch(size.x, size.y, 1, kBlocksPerSide, kBlocksPerSide);
  });
}

void PixelBlocks::define(std::map<std::string, std::string>& defines) const {
  defines["BLOCK_SIDE"] = std::to_string(desc_.side);
}

void PixelBlocks::readItems(frame::PassBuilder& pass) const {
  if (lonePixels_) pass.read(lonePixels_, Access::storageLoad, "LonePixels", "pixels shaded themselves");
}

void PixelBlocks::readUpsampling(frame::PassBuilder& pass) const {
  pass.read(surfaces_, Access::sampled, "block_surfaces", "what blocks see")
      .read(loneItems_, Access::sampled, "lone_items", "pixels shaded themselves");
}

void PixelBlocks::bind(gpu::Program& program) const {
  program.set("block_position_width", desc_.positionWidth);
  program.set("block_normal_width", desc_.normalWidth);
}

}  // namespace limn::scene
