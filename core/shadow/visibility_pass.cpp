#include "core/shadow/visibility_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "glsl/gbuffer.glsl"

namespace limn::shadow {

using frame::Access;

namespace {

bool declares(const ParameterValues& p, std::string_view name) {
  return std::ranges::any_of(p.declared(), [&](const Parameter& known) { return known.name == name; });
}

/// light_size, or that of the scene where there is no such parameter.
float lightSize(const ParameterValues& p) {
  return declares(p, "light_size") ? p.real("light_size") : -1;
}

}  // namespace

ShadowMapDesc shadowMapDesc(const ParameterValues& parameters) {
  ShadowMapDesc desc{.size = parameters.integer("shadow_map_size")};
  if (!declares(parameters, "shadow_map_fit") || parameters.choice("shadow_map_fit") == 0) return desc;
  desc.fit = MapFit::view;
  desc.lightSize = lightSize(parameters);
  return desc;
}

VisibilityPass visibilityPass(const TechniqueInputs& inputs, const TermRequest& request,
                              std::string_view technique, std::map<std::string, std::string> defines) {
  const ParameterValues& p = inputs.parameters;
  return {.name = "visibility",
          .technique = technique,
          .program = {.files = {fmt::format("techniques/{}/visibility.comp.glsl", technique)},
                      .defines = std::move(defines)},
          .maps = inputs.shadowMaps.request(request.lights, shadowMapDesc(p)),
          .bias = p.real("bias"),
          .lightSize = lightSize(p)};
}

void readSurfaces(VisibilityPass& pass, const GBuffer& g) {
  pass.sampled.insert(pass.sampled.end(), {{glsl::gbuffer_unit_normal, g.normal, "shading normals"},
                                           {glsl::gbuffer_unit_albedo, g.albedo, "base colour, metallic"},
                                           {glsl::gbuffer_unit_material, g.material, "roughness, specular"},
                                           {glsl::gbuffer_unit_emission, g.emission, "specular colour"}});
}

frame::TextureHandle addVisibilityPass(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                       frame::TextureHandle target, VisibilityPass pass) {
  const GBuffer& g = inputs.gbuffer;
  const SceneHandles& scene = inputs.handles;
  const int layers = graph.desc(target).layers;
  frame::PassBuilder builder = graph.addPass(pass.name, pass.technique);
  builder.read(scene.frame, Access::uniformBuffer, "camera")
      .read(scene.lights, Access::storageLoad, "which part of each light counts")
      .read(g.depth, Access::sampled, "receivers")
      .read(g.geometricNormal, Access::sampled, "tangent planes")
      .read(g.instance, Access::sampled, "a light does not see itself")
      .read(pass.maps.depth, Access::sampled, "shadow maps")
      .read(pass.maps.views, Access::storageLoad, "projections")
      .read(pass.maps.lights, Access::storageLoad, "layers of each light");
  for (const SampledTexture& s : pass.sampled) builder.read(s.texture, Access::sampled, s.why);
  if (pass.declare) pass.declare(builder);
  const frame::TextureHandle result =
      builder.write(target, pass.accumulate ? Access::imageLoadStore : Access::imageStore,
                    "visibility, one layer per light");
  const frame::ProgramHandle program = builder.program(pass.program);
  builder.execute([=, pass = std::move(pass), size = inputs.size,
                   &service = inputs.shadowMaps](frame::PassContext& context) {
    gpu::Program& kernel = context.program(program);
    kernel.use();
    kernel.set("bias", pass.bias);
    if (pass.lightSize) kernel.set("light_size", *pass.lightSize);
    context.bindUniform(glsl::FrameBlock::binding, scene.frame);
    context.bindSampled(glsl::gbuffer_unit_depth, g.depth);
    context.bindSampled(glsl::gbuffer_unit_geometric_normal, g.geometricNormal);
    context.bindSampled(glsl::gbuffer_unit_instance, g.instance);
    context.bindSampled(8, pass.maps.depth);
    context.bindStorage(0, scene.lights);
    context.bindStorage(1, pass.maps.views);
    context.bindStorage(2, pass.maps.lights);
    service.bindCoverage(3);
    context.bindImage(0, result, pass.accumulate ? GL_READ_WRITE : GL_WRITE_ONLY);
    for (const SampledTexture& s : pass.sampled) context.bindSampled(s.unit, s.texture);
    if (pass.bind) pass.bind(context, kernel);
    context.dispatch(size.x, size.y, layers, 8, 8);
  });
  return result;
}

}  // namespace limn::shadow
