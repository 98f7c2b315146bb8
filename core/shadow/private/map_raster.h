// Declares the passes that draw shadow maps. Internal to ShadowMapService.
#pragma once

#include <vector>

#include "core/frame/frame_graph.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/shadow/shadow_map.h"

namespace limn::shadow {

/// Holds the inputs of every pass. The views and the list are read when the pass runs.
struct MapRaster {
  frame::FrameGraph& graph;
  gpu::Device& device;
  scene::GpuScene& scene;
  SceneHandles handles;
  const std::vector<scene::DepthView>& views;
  scene::DrawList& list;
  bool cacheable;
};

/// Declares the pass that draws linear depth; sets maps.depth.
void addDepthPass(const MapRaster& raster, ShadowMaps& maps);

/// Declares the pass that draws reflective maps; sets maps.depth, normal and, as `instances` says, instance
/// or albedo. `ltc` is the table of linearly transformed cosines, empty with instances and when every
/// material of the scene is Lambertian.
void addReflectivePass(const MapRaster& raster, frame::TextureHandle ltc, bool instances, ShadowMaps& maps);

}  // namespace limn::shadow
