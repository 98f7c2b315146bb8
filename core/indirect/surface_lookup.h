// Declares the pass that finds which surface elements lie around each pixel: what is known at the vertices of
// meshes is shown by interpolating between three of them.
#pragma once

#include <string_view>

#include "core/base/export.h"
#include "core/technique/technique.h"

namespace limn::indirect {

/// Declares what a surface lookup draws.
struct SurfaceMesh {
  frame::BufferHandle leaves;   ///< storage buffer of glsl/indirect/surface_leaf.glsl's Leaf
  frame::BufferHandle corners;  ///< storage buffer of three leaf slots per triangle
  size_t cornerCount = 0;
};

/// Draws the triangles between surface elements where they meet the G-buffer's surface. The object must
/// outlive the graph.
class LIMN_API SurfaceLookup {
 public:
  /// Returns which leaves surround each pixel, and with which weights: what around_pixel() of
  /// glsl/indirect/surface_lookup.glsl reads as "surface_lookup". Declares the pass when first asked.
  frame::TextureHandle texture(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                               const SurfaceMesh& mesh, std::string_view technique);

 private:
  frame::TextureHandle lookup_;
  gpu::VertexArray vertexArray_;
};

}  // namespace limn::indirect
