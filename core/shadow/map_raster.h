// Internal to ShadowMapService: the passes that draw maps.
#pragma once

#include <vector>

#include "core/frame/frame_graph.h"
#include "core/scene/gpu_scene.h"
#include "core/shadow/shadow_map.h"

namespace limn::shadow {

/// What every pass draws from. The views and the list are read when the pass runs.
struct MapRaster {
  frame::FrameGraph& graph;
  gpu::Device& device;
  scene::GpuScene& scene;
  const SceneHandles& handles;
  const std::vector<scene::DepthView>& views;
  scene::DrawList& list;
  bool cacheable;
};

/// Linear depth: sets maps.depth.
void addDepthPass(const MapRaster& raster, bool paraboloid, ShadowMaps& maps);

/// Sets maps.depth, normal and albedo. `ltc`: the table of linearly transformed cosines, empty where every
/// material of the scene is Lambertian.
void addReflectivePass(const MapRaster& raster, frame::TextureHandle ltc, ShadowMaps& maps);

}  // namespace limn::shadow
