#include "core/shadow/visibility_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/gpu_scene/surface_input.h"
#include "core/shadow/alike_lights.h"
#include "core/technique/bound.h"
#include "glsl/shadow/summed_area_table.glsl"

namespace limn::shadow {

using frame::Access;

namespace {

/// light_size, or that of the scene where there is no such parameter.
float lightSize(const ParameterValues& p) {
  return p.has("light_size") ? p.real("light_size") : -1;
}

/// Lights that one dispatch answers for; without layers the program goes through all lights.
std::vector<AlikeLights> dispatchesOf(std::span<const LightLayout> layouts, const VisibilityPass& pass) {
  if (!pass.reflects) return alikeLights(layouts);
  const bool alike = std::ranges::adjacent_find(layouts, std::not_equal_to{}) == layouts.end();
  return {{.layout = alike && !layouts.empty() ? std::optional(layouts.front()) : std::nullopt}};
}

gpu::ProgramDesc programFor(const AlikeLights& lights, gpu::ProgramDesc program) {
  lights.define(program.defines);
  return program;
}

/// Texels up to which sums over a box are exact.
int64_t largestBox(const SatDesc& table) {
  return glsl::sat_largest_box(
      glsl::sat_format(static_cast<uint32_t>(table.bits), static_cast<uint32_t>(table.words), 1));
}

/// The settings that hold boxes of so many texels in place of those of `table`. Two words hold the largest
/// map at 16 bits.
std::string settingsFor(int64_t box, const SatDesc& table) {
  SatDesc enough{.bits = table.bits, .words = 2};
  while (box > largestBox(enough)) --enough.bits;
  std::string settings = table.words < enough.words ? "sat_words=2" : "";
  if (enough.bits < table.bits)
    settings += fmt::format("{}sat_bits={}", settings.empty() ? "" : " ", enough.bits);
  return settings;
}

constexpr std::string_view kKernelFile = "visibility.comp.glsl";

void runBound(VisibilityPass& pass, std::span<const LightLayout> layouts) {
  constexpr LightLayout rectangleInOneView;
  const bool known =
      std::ranges::all_of(layouts, [&](const LightLayout& layout) { return layout == rectangleInOneView; });
  std::string& file = pass.program.files.front();
  if (!known || !file.ends_with(kKernelFile)) return;
  file.replace(file.size() - kKernelFile.size(), kKernelFile.size(), kBoundFile);
  pass.name = kBoundPass;
}

}  // namespace

ShadowMapDesc shadowMapDesc(const ParameterValues& parameters) {
  ShadowMapDesc desc{.size = parameters.integer("shadow_map_size")};
  if (parameters.has("shadow_map_fit") && parameters.choice("shadow_map_fit") != 0) desc.fit = MapFit::view;
  if (parameters.has("views")) desc.views = parameters.integer("views");
  if (desc.fit == MapFit::view || desc.views != 1) desc.lightSize = lightSize(parameters);
  return desc;
}

SummedAreaTable summedAreaTable(const TechniqueInputs& inputs, const ShadowMaps& maps, int boxSide) {
  const ParameterValues& p = inputs.parameters;
  const SatDesc table{.bits = p.integer("sat_bits"), .words = p.integer("sat_words")};
  const int64_t box = int64_t{boxSide} * boxSide;
  if (box > largestBox(table))
    throw UsageError(fmt::format(
        "sat_bits={} sat_words={}: sums over more than {} texels overflow, and kernels in maps of "
        "{} x {} texels have up to {}; set {} or a smaller shadow_map_size",
        table.bits, table.words, largestBox(table), maps.size, maps.size, box, settingsFor(box, table)));
  return inputs.service<ShadowMapService>().summedAreaTable(maps, table);
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
  if (inputs.bound) runBound(pass, maps.layouts(pass.maps));
  frame::PassBuilder builder = graph.addPass(pass.name, pass.technique);
  builder.read(scene.frame, Access::uniformBuffer, "FrameBlock", "camera")
      .read(scene.lights, Access::storageLoad, "Lights", "which part of each light counts");
  if (pass.reflects) {
    const scene::SurfaceInput surfaces(scene, g);
    surfaces.define(pass.program.defines);
    surfaces.declare(builder);
  } else {
    builder.read(g.depth, Access::sampled, kGBufferNames.depth, "receivers")
        .read(g.geometricNormal, Access::sampled, kGBufferNames.geometricNormal, "tangent planes");
  }
  if (!pass.reflects || !scene.models)
    builder.read(g.instance, Access::sampled, kGBufferNames.instance, "a light does not see itself");
  readMaps(builder, inputs.gpuScene.device(), pass.maps, pass.program.defines);
  for (const SampledTexture& s : pass.sampled) builder.read(s.texture, Access::sampled, s.name, s.why);
  if (pass.declare) pass.declare(builder);
  const frame::TextureHandle result =
      builder.write(target, pass.accumulate ? Access::imageLoadStore : Access::imageStore, pass.image,
                    "visibility, one layer per light");
  uncovered =
      builder.write(uncovered, Access::storageLoadStore, "ShadowCoverage", "receivers that no map covers");
  struct Dispatch {
    frame::ProgramHandle program;
    AlikeLights lights;
  };
  std::vector<Dispatch> dispatches;
  for (AlikeLights& lights : dispatchesOf(maps.layouts(pass.maps), pass))
    dispatches.push_back({builder.program(programFor(lights, pass.program)), std::move(lights)});
  builder.execute([dispatches = std::move(dispatches), bias = pass.bias, lightSize = pass.lightSize,
                   bind = std::move(pass.bind), size = inputs.size](frame::PassContext& context) {
    for (const Dispatch& dispatch : dispatches) {
      gpu::Program& kernel = context.use(dispatch.program);
      kernel.set("bias", bias);
      if (lightSize) kernel.set("light_size", *lightSize);
      dispatch.lights.bind(kernel);
      if (bind) bind(context, kernel);
      context.dispatch(size.x, size.y, std::max<int>(1, static_cast<int>(dispatch.lights.layers.size())), 8,
                       8);
    }
  });
  return result;
}

}  // namespace limn::shadow
