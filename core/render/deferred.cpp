#include "core/render/deferred.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "core/scene/gpu_medium.h"
#include "core/scene/light_textures.h"
#include "core/shading/environment.h"
#include "core/shading/ltc_table.h"
#include "glsl/blocks.glsl"
#include "glsl/environment.glsl"
#include "glsl/gbuffer.glsl"

namespace limn::render {
namespace {

using frame::Access;
using frame::TextureHandle;

constexpr int group_size = 8;
constexpr unsigned visibility_unit = 7;
constexpr unsigned environment_unit = 7;

constexpr std::array<const char*, light_batch> light_index_names{
    "light_indices[0]", "light_indices[1]", "light_indices[2]", "light_indices[3]",
    "light_indices[4]", "light_indices[5]", "light_indices[6]", "light_indices[7]"};

struct GBufferInput {
  unsigned unit;
  TextureHandle texture;
  const char* why;
};

/// What glsl/gbuffer_input.glsl samples.
std::array<GBufferInput, 6> gbufferInputs(const GBuffer& g) {
  return {{{glsl::gbuffer_unit_depth, g.depth, "position"},
           {glsl::gbuffer_unit_normal, g.normal, "shading normal"},
           {glsl::gbuffer_unit_geometric_normal, g.geometricNormal, "horizon"},
           {glsl::gbuffer_unit_albedo, g.albedo, "base colour, metallic"},
           {glsl::gbuffer_unit_material, g.material, "roughness, specular"},
           {glsl::gbuffer_unit_emission, g.emission, "emission"}}};
}

bool hasSpecularSurface(const scene::Scene& scene) {
  return std::ranges::any_of(scene.materials, &scene::Material::specularSurface);
}

}  // namespace

struct Deferred::Implementation {
  gpu::Device& device;
  const scene::Scene& scene;
  gpu::Texture environmentMap, ltcTable, irradianceMap, filteredMap;
  // Imports of the graph that start() was last called for.
  TextureHandle environmentHandle, ltcHandle;

  /// The equirectangular map with bilinear filtering, repeated around the horizon.
  TextureHandle environment(frame::FrameGraph& graph) {
    if (!environmentMap) {
      const scene::Environment& e = scene.environment;
      environmentMap = gpu::Texture(device, "environment map",
                                    {.format = GL_RGB32F, .width = e.width, .height = e.height});
      environmentMap.setSampling(GL_LINEAR, GL_LINEAR, GL_REPEAT, GL_CLAMP_TO_EDGE);
      environmentMap.upload(0, 0, GL_RGB, GL_FLOAT, e.texels.data());
    }
    if (!environmentHandle) environmentHandle = graph.importTexture("environment map", environmentMap);
    return environmentHandle;
  }

  TextureHandle ltc(frame::FrameGraph& graph) {
    if (!ltcTable) ltcTable = shading::makeLtcTexture(device);
    if (!ltcHandle) ltcHandle = graph.importTexture("table of linearly transformed cosines", ltcTable);
    return ltcHandle;
  }

  /// Irradiance and radiance filtered by roughness, black without an environment; made at the first call.
  std::array<TextureHandle, 2> environmentLight(frame::FrameGraph& graph) {
    if (!irradianceMap) {
      scene::Environment black;
      black.width = black.height = 2;
      black.texels.assign(4, glm::vec3(0));
      const shading::FilteredEnvironment filtered =
          shading::filterEnvironment(scene.environment ? scene.environment : black);
      irradianceMap = shading::makeIrradianceTexture(device, filtered);
      filteredMap = shading::makeFilteredTexture(device, filtered);
    }
    return {graph.importTexture("environment irradiance", irradianceMap),
            graph.importTexture("filtered environment", filteredMap)};
  }
};

Deferred::Deferred(gpu::Device& device, const scene::Scene& scene)
    : implementation_(new Implementation{device, scene, {}, {}, {}, {}, {}, {}}) {}
Deferred::~Deferred() = default;

TextureHandle Deferred::start(const Frame& frame, Start with) {
  frame::FrameGraph& graph = frame.graph;
  implementation_->environmentHandle = implementation_->ltcHandle = {};
  const TextureHandle target =
      graph.createTexture("radiance", {.format = GL_RGBA32F, .width = frame.size.x, .height = frame.size.y});
  const bool geometry = static_cast<bool>(frame.gbuffer.depth);
  const bool environment = static_cast<bool>(implementation_->scene.environment);
  if (with == Start::black || (!geometry && !environment)) {
    frame::PassBuilder clear = graph.addPass("clear radiance");
    const TextureHandle cleared = clear.write(target, Access::copyTarget, "no light yet");
    clear.execute([cleared](frame::PassContext& context) {
      constexpr float black[4] = {0, 0, 0, 1};
      context.gl().ClearTexImage(context.texture(cleared).id(), 0, GL_RGBA, GL_FLOAT, black);
    });
    return cleared;
  }

  frame::PassBuilder builder = graph.addPass("emission and background");
  builder.read(frame.handles.frame, Access::uniformBuffer, "camera");
  TextureHandle map;
  if (environment) {
    map = implementation_->environment(graph);
    builder.read(map, Access::sampled, "background");
  }
  const bool specular = with == Start::emissionAndSpecular && geometry && environment &&
                        hasSpecularSurface(implementation_->scene);
  if (specular) {
    for (const GBufferInput& input : gbufferInputs(frame.gbuffer))
      builder.read(input.texture, Access::sampled, input.why);
    builder.read(frame.gbuffer.instance, Access::sampled, "material of specular surfaces");
    builder.read(frame.handles.instances, Access::storageLoad, "material of specular surfaces");
    builder.read(frame.handles.materials, Access::storageLoad, "transmission");
  } else if (geometry) {
    builder.read(frame.gbuffer.depth, Access::sampled, "coverage");
    builder.read(frame.gbuffer.emission, Access::sampled, "emitted radiance");
  }
  const TextureHandle radiance =
      builder.write(target, Access::imageStore, "light the camera sees without reflection");
  const auto program = builder.program({.files = {"glsl/deferred/background.comp.glsl"},
                                        .defines = {{"GEOMETRY", geometry ? "1" : "0"},
                                                    {"ENVIRONMENT", environment ? "1" : "0"},
                                                    {"SPECULAR", specular ? "1" : "0"}}});
  builder.execute(
      [=, handles = frame.handles, g = frame.gbuffer, size = frame.size](frame::PassContext& context) {
        context.program(program).use();
        context.bindUniform(glsl::FrameBlock::binding, handles.frame);
        if (specular) {
          for (const GBufferInput& input : gbufferInputs(g)) context.bindSampled(input.unit, input.texture);
          context.bindSampled(glsl::gbuffer_unit_instance, g.instance);
          context.bindStorage(0, handles.instances);
          context.bindStorage(1, handles.materials);
        } else if (geometry) {
          context.bindSampled(glsl::gbuffer_unit_depth, g.depth);
          context.bindSampled(glsl::gbuffer_unit_emission, g.emission);
        }
        if (environment) context.bindSampled(environment_unit, map);
        context.bindImage(0, radiance, GL_WRITE_ONLY);
        context.dispatch(size.x, size.y, 1, group_size, group_size);
      });
  return radiance;
}

TextureHandle Deferred::addLights(const Frame& frame, TextureHandle before, std::span<const uint32_t> lights,
                                  TextureHandle visibility) {
  frame::PassBuilder builder = frame.graph.addPass("accumulate lights");
  builder.read(frame.handles.frame, Access::uniformBuffer, "camera");
  builder.read(frame.handles.lights, Access::storageLoad, "lights");
  for (const GBufferInput& input : gbufferInputs(frame.gbuffer))
    builder.read(input.texture, Access::sampled, input.why);
  if (visibility) builder.read(visibility, Access::sampled, "V of each light");
  const TextureHandle ltc = implementation_->ltc(frame.graph);
  builder.read(ltc, Access::sampled, "glossy light of rectangles");
  const TextureHandle radiance = builder.write(before, Access::imageLoadStore, "sum of L_u V");
  gpu::ProgramDesc desc{.files = {"glsl/deferred/light_accumulate.comp.glsl"},
                        .defines = {{"VISIBILITY", visibility ? "1" : "0"},
                                    {"MEDIUM", implementation_->scene.medium.present() ? "1" : "0"},
                                    {"LIGHT_COUNT", std::to_string(lights.size())}}};
  const scene::MediumInput medium(frame.handles);
  medium.define(desc.defines);
  medium.declare(builder);
  const scene::LightTextureInput textures(frame.handles);
  textures.define(desc.defines);
  textures.declare(builder);
  const auto program = builder.program(std::move(desc));
  builder.execute(
      [=, handles = frame.handles, g = frame.gbuffer, size = frame.size,
       indices = std::vector<uint32_t>(lights.begin(), lights.end())](frame::PassContext& context) {
        gpu::Program& accumulate = context.program(program);
        accumulate.use();
        for (size_t i = 0; i < indices.size(); ++i) accumulate.set(light_index_names[i], indices[i]);
        context.bindUniform(glsl::FrameBlock::binding, handles.frame);
        context.bindStorage(0, handles.lights);
        for (const GBufferInput& input : gbufferInputs(g)) context.bindSampled(input.unit, input.texture);
        if (visibility) context.bindSampled(visibility_unit, visibility);
        context.bindSampled(glsl::ltc_unit, ltc);
        medium.bind(context);
        textures.bind(context);
        context.bindImage(0, radiance, GL_READ_WRITE);
        context.dispatch(size.x, size.y, 1, group_size, group_size);
      });
  return radiance;
}

TextureHandle Deferred::addEnvironment(const Frame& frame, TextureHandle before) {
  if (!frame.gbuffer.depth) {
    frame.graph.leaveOut("environment light", "core", "no geometry");
    return before;
  }
  const std::array<TextureHandle, 2> maps = implementation_->environmentLight(frame.graph);
  const TextureHandle ltc = implementation_->ltc(frame.graph);
  frame::PassBuilder builder = frame.graph.addPass("environment light");
  builder.read(frame.handles.frame, Access::uniformBuffer, "camera, rotation, scale");
  for (const GBufferInput& input : gbufferInputs(frame.gbuffer))
    builder.read(input.texture, Access::sampled, input.why);
  builder.read(maps[0], Access::sampled, "diffuse light");
  builder.read(maps[1], Access::sampled, "glossy light");
  builder.read(ltc, Access::sampled, "glossy reflectance");
  const TextureHandle radiance =
      builder.write(before, Access::imageLoadStore, "light of the environment, V = 1");
  gpu::ProgramDesc desc{.files = {"glsl/deferred/environment.comp.glsl"},
                        .defines = {{"MEDIUM", implementation_->scene.medium.present() ? "1" : "0"}}};
  const scene::MediumInput medium(frame.handles);
  medium.define(desc.defines);
  medium.declare(builder);
  const auto program = builder.program(std::move(desc));
  builder.execute(
      [=, handles = frame.handles, g = frame.gbuffer, size = frame.size](frame::PassContext& context) {
        context.program(program).use();
        context.bindUniform(glsl::FrameBlock::binding, handles.frame);
        for (const GBufferInput& input : gbufferInputs(g)) context.bindSampled(input.unit, input.texture);
        context.bindSampled(glsl::environment_unit_irradiance, maps[0]);
        context.bindSampled(glsl::environment_unit_filtered, maps[1]);
        context.bindSampled(glsl::ltc_unit, ltc);
        medium.bind(context);
        context.bindImage(0, radiance, GL_READ_WRITE);
        context.dispatch(size.x, size.y, 1, group_size, group_size);
      });
  return radiance;
}

TextureHandle Deferred::addTransmittance(const Frame& frame, TextureHandle before) {
  frame::PassBuilder builder = frame.graph.addPass("transmittance");
  builder.read(frame.handles.frame, Access::uniformBuffer, "camera, medium")
      .read(frame.gbuffer.depth, Access::sampled, "length of the path through the medium");
  const TextureHandle radiance =
      builder.write(before, Access::imageLoadStore, "what the medium leaves of it on the way to the camera");
  gpu::ProgramDesc desc{.files = {"glsl/deferred/transmittance.comp.glsl"}, .defines = {}};
  const scene::MediumInput medium(frame.handles);
  medium.define(desc.defines);
  medium.declare(builder);
  const auto program = builder.program(std::move(desc));
  builder.execute([=, handles = frame.handles, depth = frame.gbuffer.depth,
                   size = frame.size](frame::PassContext& context) {
    context.program(program).use();
    context.bindUniform(glsl::FrameBlock::binding, handles.frame);
    context.bindSampled(glsl::gbuffer_unit_depth, depth);
    medium.bind(context);
    context.bindImage(0, radiance, GL_READ_WRITE);
    context.dispatch(size.x, size.y, 1, group_size, group_size);
  });
  return radiance;
}

TextureHandle Deferred::environmentMap(frame::FrameGraph& graph) {
  return implementation_->scene.environment ? implementation_->environment(graph) : TextureHandle{};
}

TextureHandle Deferred::addSpecular(const Frame& frame, TextureHandle before, TextureHandle seen) {
  frame::PassBuilder builder = frame.graph.addPass("specular surfaces");
  builder.read(frame.gbuffer.material, Access::sampled, "which surfaces are specular")
      .read(frame.gbuffer.emission, Access::sampled, "their emission")
      .read(before, Access::sampled, "what is seen beside them")
      .read(seen, Access::sampled, "what is seen in them");
  const TextureHandle radiance = builder.write(
      frame.graph.createTexture("radiance with specular surfaces",
                                {.format = GL_RGBA32F, .width = frame.size.x, .height = frame.size.y}),
      Access::imageStore, "both");
  const auto program = builder.program({.files = {"glsl/deferred/specular.comp.glsl"}, .defines = {}});
  builder.execute([=, g = frame.gbuffer, size = frame.size](frame::PassContext& context) {
    context.program(program).use();
    context.bindSampled(0, g.material);
    context.bindSampled(1, g.emission);
    context.bindSampled(2, before);
    context.bindSampled(3, seen);
    context.bindImage(0, radiance, GL_WRITE_ONLY);
    context.dispatch(size.x, size.y, 1, group_size, group_size);
  });
  return radiance;
}

TextureHandle Deferred::addToneMapping(const Frame& frame, TextureHandle picture, bool layered,
                                       float exposureEv) {
  frame::PassBuilder builder = frame.graph.addPass("tone mapping");
  builder.read(picture, Access::sampled, "linear picture");
  const TextureHandle display =
      builder.write(frame.graph.createTexture(
                        "display", {.format = GL_RGBA8, .width = frame.size.x, .height = frame.size.y}),
                    Access::imageStore, "what the window shows");
  const auto program = builder.program(
      {.files = {"glsl/deferred/tone_map.comp.glsl"}, .defines = {{"VISIBILITY", layered ? "1" : "0"}}});
  builder.execute([=, size = frame.size](frame::PassContext& context) {
    gpu::Program& kernel = context.program(program);
    kernel.use();
    kernel.set("exposure_ev", exposureEv);
    context.bindSampled(0, picture);
    context.bindImage(0, display, GL_WRITE_ONLY);
    context.dispatch(size.x, size.y, 1, group_size, group_size);
  });
  return display;
}

}  // namespace limn::render
