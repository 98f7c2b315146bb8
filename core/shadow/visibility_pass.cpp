#include "core/shadow/visibility_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

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

/// The length of light_layers in glsl/shadow/visibility.glsl.
constexpr size_t kDispatchLights = 8;
constexpr std::array<const char*, kDispatchLights> kLightLayerNames{
    "light_layers[0]", "light_layers[1]", "light_layers[2]", "light_layers[3]",
    "light_layers[4]", "light_layers[5]", "light_layers[6]", "light_layers[7]"};

/// Of a uniform block, on every device with OpenGL 4.5.
constexpr size_t kUniformBlockBytes = 16384;

/// Lights that one dispatch answers for.
struct LightGroup {
  std::optional<LightLayout> layout;  // that all of them share
  std::vector<int> layers;            // none: the program goes through all lights
};

std::vector<LightGroup> lightGroups(std::span<const LightLayout> layouts, const VisibilityPass& pass) {
  if (pass.reflects) {
    const bool alike = std::ranges::adjacent_find(layouts, std::not_equal_to{}) == layouts.end();
    return {{alike && !layouts.empty() ? std::optional(layouts.front()) : std::nullopt, {}}};
  }
  std::vector<LightGroup> groups;
  for (size_t i = 0; i < layouts.size(); ++i) {
    const auto joins = [&](const LightGroup& group) {
      return group.layout == layouts[i] && group.layers.size() < kDispatchLights;
    };
    auto group = std::ranges::find_if(groups, joins);
    if (group == groups.end()) group = groups.insert(groups.end(), {layouts[i], {}});
    group->layers.push_back(static_cast<int>(i));
  }
  return groups;
}

gpu::ProgramDesc programFor(const LightGroup& group, gpu::ProgramDesc program) {
  if (!group.layout) return program;
  program.defines["SHADOW_PROJECTION"] = std::to_string(group.layout->projection);
  program.defines["SHADOW_FACES"] = std::to_string(group.layout->faces);
  program.defines["LIGHT_KIND"] = std::to_string(group.layout->kind);
  return program;
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
          .maps = inputs.service<ShadowMapService>().request(request.lights, shadowMapDesc(p)),
          .bias = p.real("bias"),
          .lightSize = lightSize(p)};
}

frame::TextureHandle addVisibilityPass(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                       frame::TextureHandle target, VisibilityPass pass) {
  const GBuffer& g = inputs.gbuffer;
  const SceneHandles& scene = inputs.handles;
  auto& maps = inputs.service<ShadowMapService>();
  frame::BufferHandle& uncovered = maps.uncoveredCounter();
  const auto layers = static_cast<size_t>(pass.maps.layers);
  const bool fitsBlock = layers * sizeof(glsl::ShadowView) <= kUniformBlockBytes;
  if (fitsBlock) pass.program.defines["SHADOW_VIEW_COUNT"] = std::to_string(layers);
  frame::PassBuilder builder = graph.addPass(pass.name, pass.technique);
  builder.read(scene.frame, Access::uniformBuffer, "FrameBlock", "camera")
      .read(scene.lights, Access::storageLoad, "Lights", "which part of each light counts");
  if (pass.reflects) {
    readSurfaces(builder, g);
  } else {
    builder.read(g.depth, Access::sampled, kGBufferNames.depth, "receivers")
        .read(g.geometricNormal, Access::sampled, kGBufferNames.geometricNormal, "tangent planes");
  }
  builder.read(g.instance, Access::sampled, kGBufferNames.instance, "a light does not see itself")
      .read(pass.maps.depth, Access::sampled, "shadow_depth", "shadow maps")
      .read(pass.maps.views, fitsBlock ? Access::uniformBuffer : Access::storageLoad, "ShadowViews",
            "projections")
      .read(pass.maps.lights, Access::storageLoad, "ShadowLights", "layers of each light");
  for (const SampledTexture& s : pass.sampled) builder.read(s.texture, Access::sampled, s.name, s.why);
  if (pass.declare) pass.declare(builder);
  const frame::TextureHandle result =
      builder.write(target, pass.accumulate ? Access::imageLoadStore : Access::imageStore, pass.image,
                    "visibility, one layer per light");
  uncovered =
      builder.write(uncovered, Access::storageLoadStore, "ShadowCoverage", "receivers that no map covers");
  struct Dispatch {
    frame::ProgramHandle program;
    std::vector<int> layers;
  };
  std::vector<Dispatch> dispatches;
  for (LightGroup& group : lightGroups(maps.layouts(pass.maps), pass))
    dispatches.push_back({builder.program(programFor(group, pass.program)), std::move(group.layers)});
  builder.execute([dispatches = std::move(dispatches), bias = pass.bias, lightSize = pass.lightSize,
                   bind = std::move(pass.bind), size = inputs.size](frame::PassContext& context) {
    for (const Dispatch& dispatch : dispatches) {
      gpu::Program& kernel = context.use(dispatch.program);
      kernel.set("bias", bias);
      if (lightSize) kernel.set("light_size", *lightSize);
      for (size_t i = 0; i < dispatch.layers.size(); ++i) kernel.set(kLightLayerNames[i], dispatch.layers[i]);
      if (bind) bind(context, kernel);
      context.dispatch(size.x, size.y, std::max<int>(1, static_cast<int>(dispatch.layers.size())), 8, 8);
    }
  });
  return result;
}

}  // namespace limn::shadow
