// Declares virtual area lights: clusters of virtual point lights that share one shadow computation (thesis,
// sections 6.4 and 6.5; Dong et al. 2009, Interactive Global Illumination Using Clustered Visibility). All of
// the work is done on the GPU.
#pragma once

#include <string_view>

#include "core/frame/frame_graph.h"
#include "core/gpu_scene/gpu_scene.h"
#include "glsl/indirect/virtual_area_light.glsl"

namespace limn::indirect {

struct VirtualAreaDesc {
  int count = 30;      ///< M, clusters; at most as many as virtual point lights are used
  int iterations = 5;  ///< of k-means, each an assignment and an average
  /// Holds w_x and w_a, the weights of the distance in scene extents and of the angle between normals in
  /// units of pi.
  float weightPosition = 0.7f, weightAngle = 0.3f;
  float near = 0.01f;  ///< scene extents: nearer geometry is not in a cluster's map
  int mapSize = 256;   ///< texels per side
  int block = 1;       ///< side of the pattern of sub-buffers within which lights are sorted
  std::string_view technique = "indirect";  ///< owner of the passes
};

struct VirtualAreas {
  frame::BufferHandle areas;   ///< storage buffer of glsl::VirtualAreaLight
  frame::BufferHandle views;   ///< storage buffer of glsl::ShadowView, for ParaboloidMapPass
  frame::BufferHandle lights;  ///< the virtual point lights sorted by cluster within each sub-buffer of
                               ///< block x block; `cluster` is C(i)
  int count = 0;               ///< M
};

/// Declares k-means clustering by position and normal of `count` virtual point lights. It starts from light
/// floor(k N / M) in every frame, so that lights that move a little give clusters that move a little. Lights
/// without flux have no weight. A cluster may end up empty; then it has no light, and its view looks out of
/// the scene, so that nothing is drawn into its map.
LIMN_API VirtualAreas addVirtualAreas(frame::FrameGraph& graph, const scene::GpuScene& scene,
                                      frame::BufferHandle lights, int count, const VirtualAreaDesc& desc);

}  // namespace limn::indirect
