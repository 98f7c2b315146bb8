// Shows a texture that a pass reads or writes: a copy that is a reader of the frame graph like any other, so
// that it holds what the pass saw or left behind, whatever shares the texture's memory later in the frame.
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <string>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/gpu/format.h"

namespace limn::render {

/// Names a texture: the pass as frame::PassReport names it, and the index among its accesses.
struct Inspection {
  std::string technique, pass;
  size_t access = 0;
  bool operator==(const Inspection&) const = default;
};

/// Declares which part of the texture is shown, and how.
struct InspectionView {
  int level = 0, layer = 0;  ///< clamped to what there is; layer: array layer, face or slice
  int channel = 0;           ///< 0 to 3; 4: red, green and blue as colours
  float low = 0, high = 1;   ///< values shown black and white
  bool operator==(const InspectionView&) const = default;
};

/// Holds one level of one layer, on the CPU: rows from the bottom, `components` values per texel. Integers
/// are in `integers`, everything else in `reals`.
struct InspectedValues {
  glm::ivec2 size{0};
  int components = 0;  ///< of the format
  gpu::FormatClass kind = gpu::FormatClass::colour;
  std::vector<float> reals;
  std::vector<uint32_t> integers;  ///< signed ones: two's complement

  /// Returns a component of a texel; 0 for components that the format lacks.
  LIMN_API double at(int x, int y, int component) const;
  struct Range {
    double low = 0, high = 0, mean = 0;
    size_t notFinite = 0;  ///< left out of the others
  };
  /// Returns the range of one component; {} where there are no finite values.
  LIMN_API Range range(int component) const;
};

class LIMN_API TextureInspector {
 public:
  /// Names the owner of the inspector's passes.
  static constexpr const char* passOwner = "inspector";

  /// Adds the passes that copy and show `texture`, as outputs of the graph. `view` is read in every frame and
  /// must outlive the graph.
  TextureInspector(frame::FrameGraph& graph, frame::TextureHandle texture, const InspectionView& view);

  const gpu::TextureDesc& desc() const { return desc_; }
  /// Returns the size of a level in texels.
  glm::ivec2 sizeOf(int level) const;
  int layersOf(int level) const;
  /// Returns the shown picture: RGBA8, row 0 at the bottom; the size of level 0, of which the last frame's
  /// level fills the lower left corner.
  const gpu::Texture& display() const;
  /// Returns the values of the last frame. Waits for the GPU.
  InspectedValues read() const;

 private:
  struct Copy {
    frame::TextureHandle source, copy;
  };
  void copy(const frame::PassContext& context, const Copy& handles) const;

  frame::FrameGraph& graph_;
  gpu::TextureDesc desc_;
  const InspectionView& view_;
  frame::TextureHandle copy_, display_;
};

}  // namespace limn::render
