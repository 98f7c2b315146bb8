// Declares blocks of pixels, for passes that shade one pixel of each block and upsample what comes of it
// (glsl/surface/pixel_blocks.glsl).
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <string>
#include <string_view>

#include "core/frame/frame_graph.h"
#include "core/gpu_scene/scene_handles.h"

namespace limn::scene {

/// Describes blocks and how like a pixel's surface that of a block has to be.
struct PixelBlockDesc {
  int side = 4;                ///< of a block, pixels; 1: every pixel is shaded, and no pass is declared
  float positionWidth = 2.2f;  ///< standard deviation of positions, widths of a block at the pixel's depth
  float normalWidth = 0.3f;    ///< standard deviation of the difference of unit normals
};

/// Holds the blocks of a picture. Items of the grid are shaded in place of pixels: blocks first, then rows of
/// lone pixels, those whose surface no block around them sees.
class LIMN_API PixelBlocks {
 public:
  /// Declares the passes, owned by `technique`, that find the blocks' surfaces and the lone pixels of a
  /// picture of `size` pixels. Throws UsageError where these are too many for a list of them in a storage
  /// buffer.
  PixelBlocks(frame::FrameGraph& graph, const gpu::Device& device, const SceneHandles& handles,
              const GBuffer& gbuffer, glm::ivec2 size, const PixelBlockDesc& desc,
              std::string_view technique);

  int side() const { return desc_.side; }
  /// Returns the size of the grid, and of textures with a texel for each item: there is room for every pixel,
  /// should it be a lone one.
  glm::ivec2 grid() const { return grid_; }
  /// Adds BLOCK_SIDE.
  void define(std::map<std::string, std::string>& defines) const;
  /// Declares what glsl/surface/block_items.glsl reads, besides the frame block.
  void readItems(frame::PassBuilder& pass) const;
  /// Declares what glsl/surface/block_upsampling.glsl reads, besides the frame block and surfaces
  /// (readSurfaces()).
  void readUpsampling(frame::PassBuilder& pass) const;
  /// Sets the uniforms of glsl/surface/block_surfaces.glsl.
  void bind(gpu::Program& program) const;

 private:
  PixelBlockDesc desc_;
  glm::ivec2 grid_;
  frame::TextureHandle surfaces_, loneItems_;
  frame::BufferHandle lonePixels_;
};

}  // namespace limn::scene
