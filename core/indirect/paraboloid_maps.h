// Declares paraboloid depth maps of hemispheres whose number the CPU knows and whose positions only the GPU
// knows: virtual lights and clusters of them are never read back.
//
// A map is a layer of an array and holds radial depth, (r - near) / (far - near) between its view's near and
// far, and 1 where there is nothing. Projection, views and kernels are in glsl/shadow/paraboloid.glsl.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/technique/technique.h"
#include "glsl/shadow/paraboloid.glsl"

namespace limn::indirect {

struct ParaboloidDesc {
  int count = 0;                            ///< maps
  int first = 0;                            ///< element of the views that the first map belongs to
  int size = 256;                           ///< texels per side
  std::string_view technique = "indirect";  ///< owner of the pass
  /// Says whether the maps are kept while nothing changes. False when batches of maps share one piece of
  /// memory.
  bool cacheable = true;
};

struct ParaboloidMaps {
  frame::TextureHandle depth;  ///< array of `count` layers
  frame::BufferHandle views;
  int count = 0, first = 0, size = 0;
};

/// Returns the memory, in bytes, of one map of `size` texels per side and of what draws it.
LIMN_API int64_t paraboloidBytes(int size);
/// Returns how many maps of `size` texels per side fit the layers of one array and, together with what draws
/// them, 1 GiB.
LIMN_API int paraboloidBatch(const gpu::Device& device, int size);

/// Draws one set of maps. Must outlive the graph.
class LIMN_API ParaboloidMapPass {
 public:
  /// Declares the pass "paraboloid maps", which draws all maps together. `views` is a storage buffer of
  /// glsl::ShadowView, as paraboloid_view() makes them; the view of element first + i is drawn into layer i.
  /// Throws UsageError for more maps than a batch holds.
  ParaboloidMaps add(frame::FrameGraph& graph, scene::GpuScene& scene, const SceneHandles& handles,
                     frame::BufferHandle views, const ParaboloidDesc& desc);

 private:
  std::vector<scene::DepthView> views_;
  scene::DrawList list_;
};

}  // namespace limn::indirect
