// Paraboloid depth maps of hemispheres whose number the CPU knows and whose place only the GPU: virtual
// lights and clusters of them never come back from it.
//
// A map is a layer of an array and holds radial depth, (r - near) / (far - near) between its view's near and
// far, 1 where nothing is. Projection, views and kernels: glsl/paraboloid.glsl.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/scene/gpu_scene.h"
#include "core/technique/technique.h"
#include "glsl/paraboloid.glsl"

namespace limn::indirect {

struct ParaboloidDesc {
  int count = 0;   ///< maps
  int first = 0;   ///< element of the views that the first map belongs to
  int size = 256;  ///< texels per side
  /// GL_R32F, or GL_R16: half the memory, depths in steps of (far - near) / 65535. At 256 texels a step is a
  /// hundredth of a texel's footprint at a depth of far / 10.
  GLenum format = GL_R32F;
  std::string_view technique = "indirect";  ///< whose pass it is
  /// Keep the maps while nothing changed. False where batches of maps are to share one piece of memory.
  bool cacheable = true;
};

struct ParaboloidMaps {
  frame::TextureHandle depth;  ///< array of `count` layers
  frame::BufferHandle views;
  int count = 0, first = 0, size = 0;
};

/// Memory of one map of `size` texels and of what draws it.
LIMN_API int64_t paraboloidBytes(int size);
/// How many maps of `size` texels fit the layers of one array and 1 GiB together with what draws them.
LIMN_API int paraboloidBatch(const gpu::Device& device, int size);

/// One set of maps. Must outlive the graph.
class LIMN_API ParaboloidMapPass {
 public:
  /// Declares the pass "paraboloid maps", which draws all maps together. `views`: storage buffer of
  /// glsl::ShadowView, as paraboloid_view() makes them; the layer of element first + i is i. Throws
  /// UsageError for more maps than a batch holds.
  ParaboloidMaps add(frame::FrameGraph& graph, scene::GpuScene& scene, const SceneHandles& handles,
                     frame::BufferHandle views, const ParaboloidDesc& desc);

 private:
  std::vector<scene::DepthView> views_;
  scene::DrawList list_;
};

}  // namespace limn::indirect
