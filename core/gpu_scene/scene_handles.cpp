#include "core/gpu_scene/scene_handles.h"

namespace limn {

void readSurfaces(frame::PassBuilder& pass, const GBuffer& gbuffer) {
  using frame::Access;
  pass.read(gbuffer.depth, Access::sampled, kGBufferNames.depth, "positions")
      .read(gbuffer.normal, Access::sampled, kGBufferNames.normal, "shading normals")
      .read(gbuffer.geometricNormal, Access::sampled, kGBufferNames.geometricNormal, "horizons")
      .read(gbuffer.albedo, Access::sampled, kGBufferNames.albedo, "base colour, metallic")
      .read(gbuffer.material, Access::sampled, kGBufferNames.material, "roughness, specular")
      .read(gbuffer.emission, Access::sampled, kGBufferNames.emission, "specular colour, emission");
}

}  // namespace limn
