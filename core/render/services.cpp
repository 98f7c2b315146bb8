#include "core/render/services.h"

#include "core/caustics/caustic_rays.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/history/frame_history.h"
#include "core/indirect/virtual_lights.h"
#include "core/rays/ray_geometry.h"
#include "core/relief_maps/relief_maps.h"
#include "core/shading_maps/shading_maps.h"
#include "core/shadow/shadow_map.h"
#include "core/technique/frame_budget.h"

namespace limn::render {

/// In the order in which they begin: a service may ask those above it.
FrameServices makeServices(gpu::Device& device, scene::GpuScene& scene) {
  FrameServices services;
  services.add<shadow::ShadowMapService>(device, scene);
  services.add<history::FrameHistoryService>(scene);
  services.add<indirect::VirtualLightService>(scene.scene());
  services.add<caustics::CausticRayService>(device, scene);
  services.add<rays::RayGeometryService>(device, scene.scene());
  services.add<relief_maps::ReliefMapService>(device, scene.scene());
  services.add<shading_maps::ShadingMapService>(device, scene.scene());
  services.add<FrameBudgetService>();
  return services;
}

}  // namespace limn::render
