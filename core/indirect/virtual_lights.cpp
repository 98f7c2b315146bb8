#include "core/indirect/virtual_lights.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/light_textures.h"
#include "core/scene/scene.h"

namespace limn::indirect {
namespace {

using frame::Access;
using frame::BufferHandle;

constexpr int kTile = 64;  // texels
constexpr int kThreads = 64;

struct LightBuilder {
  frame::FrameGraph& graph;
  const SceneHandles& handles;
  const shadow::ShadowMaps& maps;
  const VirtualLightDesc& desc;
  size_t lightCount;
  bool medium;  ///< the scene has one

  BufferHandle buffer(const char* name, size_t elements, size_t bytes) const {
    return graph.createBuffer(name, {elements * bytes});
  }
  BufferHandle perLayer(const char* name) const {
    return buffer(name, static_cast<size_t>(maps.layers), sizeof(glm::vec4));
  }
  void readMaps(frame::PassBuilder& pass, bool cacheable) const {
    pass.read(maps.depth, Access::sampled, "reflective_depth", "where light arrives")
        .read(maps.normal, Access::sampled, "reflective_normal", "which way surfaces face")
        .read(maps.albedo, Access::sampled, "reflective_albedo", "what is reflected")
        .read(maps.views, Access::storageLoad, "Views", "projections")
        .read(handles.lights, Access::storageLoad, "Lights", "what lights send");
    if (cacheable) pass.cacheable();
    if (!cacheable)
      pass.read(handles.frame, Access::uniformBuffer, "FrameBlock", "which set it is, medium");
    else if (medium)
      pass.read(handles.medium, Access::uniformBuffer, "FrameBlock", "medium");
    scene::LightTextureInput(handles).declare(pass);
    if (medium) scene::MediumInput(handles).declare(pass);
  }
  /// Of the shaders that read the maps' texels.
  gpu::ProgramDesc texelProgram(const char* file, std::map<std::string, std::string> defines) const {
    scene::LightTextureInput(handles).define(defines);
    defines["MEDIUM"] = medium ? "1" : "0";
    scene::MediumInput(handles).define(defines);
    return {.files = {file}, .defines = std::move(defines)};
  }
  BufferHandle tileFlux() const;
  BufferHandle layerFlux(BufferHandle values, bool sampled, uint32_t count) const;
  BufferHandle sample(BufferHandle reflected) const;
  BufferHandle conserve(BufferHandle lights, BufferHandle reflected, BufferHandle sampled) const;
};

int tilesPerSide(int size) {
  return (size + kTile - 1) / kTile;
}

/// The uniforms of glsl/indirect/map_groups.glsl.
void setGroups(gpu::Program& kernel, int layers, size_t lightCount, int lightSamples) {
  kernel.set("layers", static_cast<unsigned>(layers));
  kernel.set("light_count", static_cast<unsigned>(lightCount));
  kernel.set("points_listed", static_cast<unsigned>(std::max(lightSamples, 1)));
}

BufferHandle LightBuilder::tileFlux() const {
  const int across = tilesPerSide(maps.size);
  frame::PassBuilder pass = graph.addPass("reflected flux", "indirect");
  readMaps(pass, true);
  const BufferHandle tiles = pass.write(
      buffer("flux of tiles", static_cast<size_t>(across) * across * maps.layers, sizeof(glm::vec4)),
      Access::storageStore, "Tiles", "sums of reflected flux");
  const auto program =
      pass.program(texelProgram("glsl/indirect/reflected_flux.comp.glsl", {{"TILE", std::to_string(kTile)}}));
  pass.execute([=, layers = maps.layers, samples = desc.lightSamples](frame::PassContext& context) {
    context.use(program).set("light_samples", samples);
    context.dispatch(across, across, layers, 1, 1);
  });
  return tiles;
}

BufferHandle LightBuilder::layerFlux(BufferHandle values, bool sampled, uint32_t count) const {
  frame::PassBuilder pass = graph.addPass(sampled ? "sampled flux" : "flux of maps", "indirect");
  pass.read(values, Access::storageLoad, sampled ? "VirtualLights" : "Tiles",
            sampled ? "virtual lights" : "tiles")
      .cacheable();
  const BufferHandle flux = pass.write(perLayer(sampled ? "sampled flux" : "flux of maps"),
                                       Access::storageStore, "LayerFlux", "flux of each layer");
  const auto program = pass.program(
      {.files = {"glsl/indirect/layer_flux.comp.glsl"}, .defines = {{"SAMPLED", sampled ? "1" : "0"}}});
  pass.execute([=, layers = maps.layers](frame::PassContext& context) {
    context.use(program).set("count", count);
    context.dispatch(layers, 1, 1, 1, 1);
  });
  return flux;
}

BufferHandle LightBuilder::sample(BufferHandle reflected) const {
  frame::PassBuilder pass = graph.addPass("virtual lights", "indirect");
  readMaps(pass, desc.sets == 1);
  pass.read(reflected, Access::storageLoad, "LayerFlux", "how many samples a map deserves")
      .read(maps.lights, Access::storageLoad, "MapLights", "which maps belong together");
  const BufferHandle lights =
      pass.write(buffer("virtual lights", static_cast<size_t>(desc.count), sizeof(glsl::VirtualPointLight)),
                 Access::storageStore, "VirtualLights", "samples of the maps");
  const auto program = pass.program(
      texelProgram("glsl/indirect/sample_maps.comp.glsl", {{"SETS", std::to_string(desc.sets)}}));
  pass.execute(
      [program, layers = maps.layers, desc = desc, lightCount = lightCount](frame::PassContext& context) {
        gpu::Program& kernel = context.use(program);
        kernel.set("count", static_cast<unsigned>(desc.count));
        kernel.set("light_samples", desc.lightSamples);
        if (desc.sets > 1) kernel.set("block", static_cast<unsigned>(desc.block));
        setGroups(kernel, layers, lightCount, desc.lightSamples);
        context.dispatch(desc.count, 1, 1, kThreads, 1);
      });
  return lights;
}

BufferHandle LightBuilder::conserve(BufferHandle before, BufferHandle reflected, BufferHandle sampled) const {
  frame::PassBuilder pass = graph.addPass("conserve flux", "indirect");
  pass.read(reflected, Access::storageLoad, "Reflected", "what the maps reflect")
      .read(sampled, Access::storageLoad, "Sampled", "what the samples carry")
      .read(maps.lights, Access::storageLoad, "MapLights", "which maps belong together")
      .cacheable();
  const BufferHandle lights =
      pass.write(before, Access::storageLoadStore, "VirtualLights", "scaled so that both sums are the same");
  const auto program = pass.program({.files = {"glsl/indirect/conserve_flux.comp.glsl"}, .defines = {}});
  pass.execute(
      [program, layers = maps.layers, desc = desc, lightCount = lightCount](frame::PassContext& context) {
        gpu::Program& kernel = context.use(program);
        kernel.set("count", static_cast<unsigned>(desc.count));
        setGroups(kernel, layers, lightCount, desc.lightSamples);
        context.dispatch(desc.count, 1, 1, kThreads, 1);
      });
  return lights;
}

}  // namespace

void VirtualLightService::begin() {
  known_.clear();
}

VirtualLights VirtualLightService::request(std::span<const uint32_t> lights, const VirtualLightDesc& desc) {
  for (const Known& known : known_) {
    if (known.desc == desc && std::ranges::equal(known.lights, lights)) return known.made;
  }
  const shadow::ShadowMapDesc mapDesc{
      .size = desc.mapSize, .samples = shadow::pointsOnLights(desc.lightSamples), .reflective = true};
  VirtualLights made;
  made.maps = context().services.get<shadow::ShadowMapService>().request(lights, mapDesc);
  made.count = desc.count;
  const LightBuilder build{context().graph, context().handles,      made.maps, desc,
                           lights.size(),   scene_.medium.present()};
  const int across = tilesPerSide(desc.mapSize);
  made.reflected = build.layerFlux(build.tileFlux(), false, static_cast<uint32_t>(across * across));
  const BufferHandle sampled = build.sample(made.reflected);
  made.lights = build.conserve(sampled, made.reflected,
                               build.layerFlux(sampled, true, static_cast<uint32_t>(desc.count)));
  known_.push_back({{lights.begin(), lights.end()}, desc, made});
  return made;
}

}  // namespace limn::indirect
