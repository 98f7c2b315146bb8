#include "core/indirect/light_maps.h"

#include "core/gpu_scene/gpu_scene.h"

namespace limn::indirect {
namespace {

using frame::Access;

/// What the maps' depths and their distance from the surfaces are shares of, m.
float extentOf(const scene::GpuScene& scene) {
  return 2 * scene.bounds().radius();
}

}  // namespace

frame::BufferHandle addLightViews(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                  const VirtualLights& lights, const LightMapDesc& desc) {
  frame::PassBuilder pass = graph.addPass("views", desc.technique);
  pass.read(inputs.handles.geometry, Access::storageLoad, "extent of the scene")
      .read(lights.lights, Access::storageLoad, "VirtualLights", "virtual lights")
      .cacheable();
  const frame::BufferHandle views = pass.write(
      graph.createBuffer("paraboloid views", {static_cast<size_t>(lights.count) * sizeof(glsl::ShadowView)}),
      Access::storageStore, "Views", "a hemisphere for each virtual light");
  const auto program = pass.program({.files = {"glsl/indirect/light_map_views.comp.glsl"}, .defines = {}});
  pass.execute([=, &scene = inputs.gpuScene](frame::PassContext& context) {
    gpu::Program& kernel = context.use(program);
    kernel.set("count", static_cast<unsigned>(lights.count));
    kernel.set("batch", static_cast<unsigned>(desc.batch));
    kernel.set("texels", static_cast<unsigned>(desc.size));
    kernel.set("extent", extentOf(scene));
    context.dispatch(lights.count, 1, 1, 64, 1);
  });
  return views;
}

ShadePass lightMapShadePass(const TechniqueInputs& inputs, const ParaboloidMaps& maps, float bias) {
  return {.program = {.files = {"glsl/indirect/shade_light_maps.comp.glsl"}, .defines = {}},
          .first = maps.first,
          .count = maps.count,
          .sampled = {{"maps", maps.depth, "what virtual lights see"}},
          .bind = [bias, first = maps.first, &scene = inputs.gpuScene](gpu::Program& kernel) {
            kernel.set("first_map", static_cast<unsigned>(first));
            kernel.set("bias", bias);
            kernel.set("extent", extentOf(scene));
          }};
}

}  // namespace limn::indirect
